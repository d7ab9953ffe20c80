#pragma once

#include <string>

#include "estimation/engine/fusion_engine.hpp"

namespace fathom::test {

/// Gives an order right behind the newest inertial sample; why it is refused, or empty.
inline std::string order_now(estimation::FusionEngine& engine, Command order, int after = 1) {
  order.header.sensor = "operator";
  order.header.stamp_ns = engine.nav_state().header.stamp_ns + after;
  return engine.apply(order);
}

/// Gives it once more, confirmed, as a position far from where navigation is has to be.
inline std::string order_twice(estimation::FusionEngine& engine, Command order) {
  std::string why = order_now(engine, order, 1);
  order.confirmed = true;
  return why + order_now(engine, order, 2);
}

}  // namespace fathom::test
