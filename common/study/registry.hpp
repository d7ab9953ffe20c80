#pragma once

#include <memory>
#include <vector>

#include "study/study.hpp"

namespace fathom::study {

/// All studies, in the order in which help lists them.
[[nodiscard]] const std::vector<std::unique_ptr<const Study>>& study_registry();

/// Null when there is none of this name.
[[nodiscard]] const Study* find_study(std::string_view name);

}  // namespace fathom::study
