#pragma once

#include <memory>

#include "study/study.hpp"

namespace fathom::study {

/// An underwater vehicle: five minutes on the surface with GPS, then an hour at 2 m/s under water on DVL,
/// IMU, compass and depth; on a straight transit, where nothing cancels, or a lawn-mower pattern. The
/// position error at the end in per cent of the distance travelled under water.
[[nodiscard]] std::unique_ptr<const Study> make_survey_study();

}  // namespace fathom::study
