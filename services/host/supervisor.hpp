#pragma once

#include <string_view>

/// What a service tells systemd when it runs under it (Type=notify), and nobody elsewhere.
namespace fathom::host::supervisor {

/// It has joined the bus and listens.
void ready();

/// It lives; `text` is shown by `systemctl status`. Called with each life sign, after the service has filled
/// it in: that takes the service's own locks, so that one whose work hangs is not fed, and is started again.
void alive(std::string_view text);

void stopping();

}  // namespace fathom::host::supervisor
