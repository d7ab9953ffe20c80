#pragma once

#include <memory>

#include "study/study.hpp"

namespace fathom::study {

/// Instruments at the end of a rotating arm of 8 m: 10 s at rest, then 600 s of circles without any position
/// fix. What is left of the position after that, by inertial navigation alone, by DVL and compass dead
/// reckoning, by the published filter of 25 states and by the full one (equations STUDY-1 and STUDY-2).
[[nodiscard]] std::unique_ptr<const Study> make_rotating_arm_study();

}  // namespace fathom::study
