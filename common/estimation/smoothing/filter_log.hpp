#pragma once

#include <cstddef>
#include <variant>
#include <vector>

#include "estimation/filter/adjoint.hpp"

namespace fathom::estimation {

/// Writes down what a filter of `states` states does, so that an Adjoint can go back along it.
class FilterLog final : public FilterTape {
 public:
  explicit FilterLog(int states) : states_(states) {}

  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  void clear() { entries_.clear(); }
  /// From after entry `end` - 1 to before entry `begin`.
  void back_through(std::size_t end, std::size_t begin, Adjoint& adjoint) const;

  void propagated(const NavTransition& step, const ProcessNoise& noise) override {
    entries_.emplace_back(transition(step, noise));
  }
  void updated(const Observation& observation, const InnovationStatistics& statistics) override {
    entries_.emplace_back(UpdateRecord(observation, statistics, states_));
  }
  void forgot(int state) override { entries_.emplace_back(Forgotten{state}); }
  void drifted(const ErrorFilter& widened, const std::array<double, kNavStates>& variance) override {
    entries_.emplace_back(DriftRecord(widened, variance));
  }
  void shifted(const ErrorFilter& filter, const std::array<double, kMaxStates>& column, double mean,
               double variance) override {
    entries_.emplace_back(ShiftRecord(filter, column, mean, variance));
  }
  void carried(const Carry& carry) override { entries_.emplace_back(carry); }
  void restarted() override { entries_.emplace_back(Restart{}); }

 private:
  struct Forgotten {
    int state;
  };
  struct Restart {};

  int states_;
  std::vector<std::variant<Transition, UpdateRecord, DriftRecord, ShiftRecord, Carry, Forgotten, Restart>>
      entries_;
};

}  // namespace fathom::estimation
