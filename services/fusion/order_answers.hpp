#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "estimation/engine/order.hpp"
#include "runtime/log.hpp"
#include "samples/command.hpp"

namespace fathom::fusion {

/// What fusion says of orders: in its log at once, and in its life sign, which counts those that were not
/// done and says for a minute why the last one was not. Thread-safe.
class OrderAnswers {
 public:
  struct Figures {
    std::uint64_t refused = 0;
    std::uint64_t held = 0;      ///< positions that waited for a confirmation
    std::uint64_t not_done = 0;  ///< refused, or taken and then not done
    std::string note;            ///< on the last one that was not done; empty after a minute
  };

  OrderAnswers(runtime::Log& log, const Clock& clock) : log_(log), clock_(clock) {}

  void refuse(const Command& order, const std::string& why);
  void tell(const std::vector<estimation::OrderOutcome>& outcomes);
  [[nodiscard]] Figures figures() const;

 private:
  void note(std::string text);

  runtime::Log& log_;
  const Clock& clock_;
  mutable std::mutex mutex_;
  Figures figures_;
  TimeNs noted_ns_ = 0;  ///< monotonic
};

}  // namespace fathom::fusion
