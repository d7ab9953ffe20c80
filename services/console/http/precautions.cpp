#include "console/http/precautions.hpp"

#include "base/clock.hpp"
#include "config/json/error.hpp"

namespace fathom::console {

TokenBook tokens_of(const config::ConsoleConfig& config, const std::string& file) {
  if (config.access.token_file.empty()) return {};
  try {
    return TokenBook::load(config.access.token_file);
  } catch (const TokenError& error) {
    throw config::ConfigError(file, std::string("access.token_file: ") + error.what());
  }
}

std::optional<TlsIdentity> identity_of(const config::ConsoleConfig& config, const std::string& file) {
  if (config.tls.certificate_file.empty()) return std::nullopt;
  try {
    return TlsIdentity::load(config.tls.certificate_file, config.tls.key_file);
  } catch (const TlsError& error) {
    const bool key = error.file() == TlsError::File::key;
    throw config::ConfigError(file,
                              std::string(key ? "tls.key_file: " : "tls.certificate_file: ") + error.what());
  }
}

void verify(const config::ConsoleConfig& config, const std::string& file, bool check) {
  (void)tokens_of(config, file);
  const std::optional<TlsIdentity> identity = identity_of(config, file);
  if (!identity || !check) return;
  // Real time: browsers do not know of an accelerated vehicle's.
  const auto note =
      validity_note(identity->valid_from_ns(), identity->valid_until_ns(), SystemClock().utc_ns());
  if (note && !note->usable) {
    throw config::ConfigError(file, "tls.certificate_file: " + config.tls.certificate_file + ": " +
                                        note->text + " Expected one that is valid now");
  }
}

std::string exposure_warning(const config::ConsoleConfig& config) {
  const bool tokens = config.access.orders || config.access.view_needs_token;
  const bool loopback = config.http.address.starts_with("127.");
  if (!tokens || loopback || !config.tls.certificate_file.empty()) return {};
  return "tokens pass over the network in clear: the console listens at " + config.http.address +
         " without TLS, so whoever sees the traffic can read them and " +
         (config.access.orders ? "give orders" : "look") +
         " in another's name. Set tls.certificate_file and tls.key_file, or listen at 127.0.0.1 behind an "
         "ssh "
         "tunnel or a proxy with TLS.";
}

}  // namespace fathom::console
