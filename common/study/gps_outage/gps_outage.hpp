#pragma once

#include <memory>

#include "study/study.hpp"

namespace fathom::study {

/// A light aircraft with a coarse inertial unit of 20 Hz loses GPS in a climb, a steep turn or a Dutch roll:
/// how far it is off after 10 and 20 s, when 100 m are passed, and whether that was predicted. The published
/// fixed-gain estimator against filters of 15, 24 and 36 states (equations STUDY-7 and STUDY-8).
[[nodiscard]] std::unique_ptr<const Study> make_gps_outage_study();

}  // namespace fathom::study
