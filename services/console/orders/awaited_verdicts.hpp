#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <list>
#include <mutex>
#include <optional>

#include "samples/verdict.hpp"

namespace fathom::console {

/// What navigation says to positions that were told by this console, for whoever waits for it. Thread-safe.
class AwaitedVerdicts {
 public:
  /// One position: made before it is told, so that its verdict cannot come too early.
  class Wait {
   public:
    Wait(AwaitedVerdicts& all, const SampleHeader& told);
    ~Wait();
    Wait(const Wait&) = delete;
    Wait& operator=(const Wait&) = delete;
    /// Nothing when none came for so long.
    [[nodiscard]] std::optional<Verdict> verdict(std::chrono::milliseconds patience);

   private:
    friend class AwaitedVerdicts;
    AwaitedVerdicts& all_;
    SampleHeader told_;
    std::optional<Verdict> verdict_;
    std::list<Wait*>::iterator place_;
  };

  /// Any verdict of the vehicle.
  void heard(const Verdict& verdict);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::list<Wait*> waits_;
};

}  // namespace fathom::console
