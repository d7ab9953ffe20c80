#pragma once

#include <memory>

#include "study/study.hpp"

namespace fathom::study {

/// Whether the uncertainty of a start in motion is true from the first published state on, over instrument
/// grades and motions.
[[nodiscard]] std::unique_ptr<const Study> make_starts_study();

}  // namespace fathom::study
