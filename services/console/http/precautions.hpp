#pragma once

#include <optional>
#include <string>

#include "config/console_config.hpp"
#include "console/http/tls.hpp"
#include "console/orders/roles.hpp"

namespace fathom::console {

/// The tokens that the configuration names; an empty book where it names none. Throws config::ConfigError.
[[nodiscard]] TokenBook tokens_of(const config::ConsoleConfig& config, const std::string& file);
/// The certificate and key that it names; nothing where there is no TLS. Throws config::ConfigError.
[[nodiscard]] std::optional<TlsIdentity> identity_of(const config::ConsoleConfig& config,
                                                     const std::string& file);

/// Looks at every file that the configuration names before anything starts. With `check` a certificate that
/// is not valid now is refused as well: a console that starts shows one all the same, and says so, because
/// at sea an expired certificate or a wrong clock is no reason to see nothing. Throws config::ConfigError.
void verify(const config::ConsoleConfig& config, const std::string& file, bool check);

/// What a person who starts the console in this way has to know about who may listen; empty: nothing.
[[nodiscard]] std::string exposure_warning(const config::ConsoleConfig& config);

}  // namespace fathom::console
