#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "status/view.hpp"

namespace fathom::status {

enum class Condition { healthy = 0, degraded = 1, no_navigation = 2 };

struct Judgement {
  Condition condition = Condition::no_navigation;
  std::vector<std::string> reasons;  ///< sentences; none when healthy
};
/// The judgement of a vehicle: the exit code of `fathom status`, and the reasons.
[[nodiscard]] Judgement judge(const StatusView& view);
[[nodiscard]] std::string_view to_string(Condition condition);

}  // namespace fathom::status
