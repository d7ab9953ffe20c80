#pragma once

#include <memory>

#include "study/study.hpp"

namespace fathom::study {

/// Whether the published uncertainty is true: NEES and coverage of every named configuration over vehicles,
/// motions, grades of instruments, starts and latitudes, against a truth that shares no code with the
/// estimator.
[[nodiscard]] std::unique_ptr<const Study> make_consistency_study();

}  // namespace fathom::study
