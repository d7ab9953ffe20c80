#include "console/orders/orders.hpp"

#include "orders/telling.hpp"

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
  return {200, std::string(told ? "Told" : "Sent") + " by " + who.name + ": " + words + ".", order.value()};
}

OrderJudgement judged(OrderJudgement told, const FixSample& fix, const std::optional<Verdict>& verdict) {
  if (!verdict) {
    told.status = 202;
    told.text += " Navigation has not judged it yet.";
    return told;
  }
  told.verdict = to_string(verdict->kind);
  told.text +=
      verdict->kind == VerdictKind::used ? " Navigation has taken it: " : " Navigation has refused it: ";
  told.text += orders::in_words(fix, *verdict) + ".";
  if (verdict->kind == VerdictKind::source_disabled) told.status = 409;
  return told;
}

}  // namespace fathom::console
