#pragma once

#include <array>

namespace fathom::dataset {

/// Those that decimals are read and written with. A double holds each of them exactly.
inline constexpr std::array<double, 19> kPowersOfTen{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8, 1e9,
                                                     1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18};

}  // namespace fathom::dataset
