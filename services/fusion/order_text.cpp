#include "fusion/order_text.hpp"

#include <array>
#include <cstdio>

namespace fathom::fusion {

std::string in_words(const Command& order) {
  const std::string target = order.target.empty() ? "" : " " + order.target.str();
  return "order " + std::string(to_string(order.kind)) + target + " of " + order.header.sensor.str();
}

std::string in_words(const estimation::OrderOutcome& outcome) {
  std::array<char, 160> text{};
  switch (outcome.fate) {
    case estimation::OrderFate::done:
      return "done";
    case estimation::OrderFate::not_done:
      return "not done: navigation began anew before its instant came";
    case estimation::OrderFate::held:
      break;
  }
  std::snprintf(text.data(), text.size(),
                "held: it lies %.0f m from where navigation is, expected %.0f m at most; the same position, "
                "ordered and confirmed within 60 s, is set",
                outcome.apart_m, outcome.allowed_m);
  return text.data();
}

}  // namespace fathom::fusion
