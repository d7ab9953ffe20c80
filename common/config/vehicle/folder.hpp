#pragma once

#include <string>
#include <string_view>

#include "config/json/error.hpp"

namespace fathom::config {

/// What a folder such as /etc/fathom says of `service`: vehicle.json there, and SERVICE.json over it. Either
/// may be missing. The request's overrides stay. Throws ConfigError where there is neither.
[[nodiscard]] LoadRequest from_folder(LoadRequest request, const std::string& folder,
                                      std::string_view service);

/// The files that a request is made of, the later over the earlier: "vehicle.json, over it fusion.json".
[[nodiscard]] std::string files_of(const LoadRequest& request);

}  // namespace fathom::config
