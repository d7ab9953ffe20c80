#pragma once

#include <string_view>

#include "geo/wgs84.hpp"
#include "samples/kinds.hpp"

namespace fathom::cli {

/// A sample with which the aiding model of this name can do something; of each kind in samples/.
template <Aiding Sample>
[[nodiscard]] Sample bench_sample(std::string_view model, const geo::Geodetic& at);

}  // namespace fathom::cli
