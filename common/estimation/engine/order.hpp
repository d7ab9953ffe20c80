#pragma once

#include <cstdint>
#include <string>

#include "base/unknown.hpp"
#include "estimation/engine_config.hpp"
#include "estimation/navigator/measurement.hpp"
#include "samples/command.hpp"

namespace fathom::estimation {

/// Why an order is none that an engine can follow, in words: what is wrong with it and what was expected;
/// empty when it is one. Whether its target is there is not looked at.
[[nodiscard]] std::string objection_to(const Command& order);
/// Likewise, with its target and its stamp.
[[nodiscard]] std::string objection_to(const Command& order, const EngineConfig& config);

/// Tells orders of one instant apart and puts them in one sequence, whoever hears them when: made of who gave
/// it and of the number that he gave it.
[[nodiscard]] std::uint64_t order_number(const Command& order);

enum class OrderFate : std::uint8_t {
  done = 0,
  held = 1,      ///< a position far from where navigation is: until it is ordered once more, confirmed
  not_done = 2,  ///< navigation began anew before its instant came, or its instant never came
};

/// What became of an order at its instant.
struct OrderOutcome {
  Command order;
  OrderFate fate = OrderFate::done;
  bool again = false;           ///< it was judged otherwise before a late measurement came
  double apart_m = kUnknown;    ///< of a position under way: horizontally, from where navigation was
  double allowed_m = kUnknown;  ///< without confirmation
};

/// That the order's stamp lies too far from the newest inertial sample, in words.
[[nodiscard]] std::string too_far(const Command& command, TimeNs newest_ns, double horizon_s);
/// `again`: it acted before, and a late event has let it act once more.
[[nodiscard]] OrderOutcome outcome_of(const Command& order, const Judgement& judgement, bool again);

}  // namespace fathom::estimation
