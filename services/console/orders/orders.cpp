#include "console/orders/orders.hpp"

#include <utility>

namespace fathom::console {

OrderJudgement judge_order(std::string_view body, const Identity& who, bool orders_enabled) {
  if (!orders_enabled) return {403, "Orders are switched off in this console's configuration.", {}};
  if (who.role == Role::nobody) return {401, "An order needs the token of an operator.", {}};
  if (who.role != Role::operator_)
    return {403, "The role " + std::string(to_string(who.role)) + " may not give orders.", {}};
  auto order = orders::order_of(body);
  if (!order) return {400, order.error().message, {}};
  const bool told = std::holds_alternative<orders::ToldFix>(order.value());
  const std::string words = describe(order.value());
  return {200,
          told ? "Told: " + words + ". What navigation says to it stands among the sensors."
               : "Sent: " + words + ".",
          std::move(order.value())};
}

}  // namespace fathom::console
