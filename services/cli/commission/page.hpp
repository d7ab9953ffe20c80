#pragma once

#include <string>

#include "commission/commission.hpp"

namespace fathom::cli {

/// One page of HTML, complete in itself: findings in sentences and a table, the Allan deviation as a plot.
[[nodiscard]] std::string page_of(const commission::Commissioning& found, const std::string& log);

}  // namespace fathom::cli
