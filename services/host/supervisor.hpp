#pragma once

#include <string_view>

/// Messages to systemd (Type=notify) or to `fathom run`, for a service that runs under it. Elsewhere they do
/// nothing.
namespace fathom::host::supervisor {

/// The service has joined the bus and listens.
void ready();

/// The service lives. `systemctl status` shows `text`. It is called with each life sign, after the service
/// has filled it in, which takes the service's own locks. So a service whose work hangs is restarted. It
/// waits for nobody.
void alive(std::string_view text);

void stopping();

}  // namespace fathom::host::supervisor
