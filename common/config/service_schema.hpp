#pragma once

// For *_config.cpp of services: the sections that all of them share, and the loader behind
// load_service_config(). A service's describe() says `s.include(&T::common);`.

#include "config/common_config.hpp"
#include "config/json/schema.hpp"
#include "config/service_config.hpp"
#include "runtime/build_info.hpp"

namespace fathom::config {

/// Whether `text` is an IPv4 address and a port, as in 192.168.2.1:11811.
[[nodiscard]] bool is_address_and_port(const std::string& text);
/// What the first of these that is no IPv4 address should be, with what it is; empty: all are.
[[nodiscard]] std::string address_wanted(const std::vector<std::string>& texts);
inline constexpr const char* kAddressAndPort = "an IPv4 address and a port such as 192.168.2.1:11811";

void describe(Schema<BusConfig>& s);
void describe(Schema<LogConfig>& s);
void describe(Schema<ClockConfig>& s);
void describe(Schema<RealtimeConfig>& s);
void describe(Schema<CommonConfig>& s);

template <class T>
LoadedConfig<T> load_service_config(const LoadRequest& request) {
  LoadedConfig<T> out;
  out.value = load<T>(request);
  out.hash = runtime::hex_hash(canonical(out.value));
  return out;
}

template <class T>
std::string explain_service_config() {
  return explain_text(rows_of<T>());
}

}  // namespace fathom::config
