#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "console/orders/roles.hpp"
#include "orders/order.hpp"
#include "samples/verdict.hpp"

namespace fathom::console {

/// What becomes of an order that came in by HTTP.
struct OrderJudgement {
  int status = 400;  ///< of the HTTP answer: below 300 only when there is an order and it was passed on
  std::string text;  ///< one sentence for the operator and the log
  std::optional<orders::Order> order;  ///< absent when refused
  bool confirm = false;                ///< it was passed on, and waits until it is given once more, confirmed
  std::string verdict{};               ///< of navigation on a position that was told, in one word
};

/// Judges who orders, and what.
[[nodiscard]] OrderJudgement judge_order(std::string_view body, const Identity& who, bool orders_enabled);

/// The answer to who told a position, when navigation has judged it or has not yet. 409 where the vehicle
/// takes no positions from the source that it was told of, 202 where navigation says nothing.
[[nodiscard]] OrderJudgement judged(OrderJudgement told, const FixSample& fix,
                                    const std::optional<Verdict>& verdict);

}  // namespace fathom::console
