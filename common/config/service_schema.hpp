#pragma once

// For *_config.cpp of services: the sections that all of them share, and the loader behind
// load_service_config(). A service's describe() says `s.include(&T::common);`.

#include "config/common_config.hpp"
#include "config/schema.hpp"
#include "config/service_config.hpp"
#include "runtime/build_info.hpp"

namespace fathom::config {

void describe(Schema<BusConfig>& s);
void describe(Schema<LogConfig>& s);
void describe(Schema<ClockConfig>& s);
void describe(Schema<CommonConfig>& s);

template <class T>
LoadedConfig<T> load_service_config(const LoadRequest& request) {
  LoadedConfig<T> out;
  out.value = load<T>(request);
  out.hash = runtime::hex_hash(canonical(out.value));
  return out;
}

}  // namespace fathom::config
