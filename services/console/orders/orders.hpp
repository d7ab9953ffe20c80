#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "console/orders/roles.hpp"
#include "orders/order.hpp"

namespace fathom::console {

/// What becomes of an order that came in by HTTP.
struct OrderJudgement {
  int status = 400;                    ///< of the HTTP answer: 200 only when there is an order
  std::string text;                    ///< one sentence for the operator and the log
  std::optional<orders::Order> order;  ///< absent when refused
  bool confirm = false;                ///< it was passed on, and waits until it is given once more, confirmed
};

/// Judges who orders, and what.
[[nodiscard]] OrderJudgement judge_order(std::string_view body, const Identity& who, bool orders_enabled);

}  // namespace fathom::console
