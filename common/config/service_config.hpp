#pragma once

#include <string>

#include "config/json/error.hpp"

namespace fathom::config {

/// A service's configuration as loaded, and what tells it from another.
template <class T>
struct LoadedConfig {
  T value;
  std::string hash;  ///< of the effective configuration, overrides and defaults included
};

/// Loads and checks a service's file. Throws ConfigError. For each service's struct instantiated in its
/// *_config.cpp, which includes config/service_schema.hpp and says
///
///   template LoadedConfig<FusionConfig> load_service_config(const LoadRequest& request);
template <class T>
[[nodiscard]] LoadedConfig<T> load_service_config(const LoadRequest& request);

/// Every key of a service's file with its unit, range, default and sentence, for people. Instantiated
/// likewise.
template <class T>
[[nodiscard]] std::string explain_service_config();

}  // namespace fathom::config
