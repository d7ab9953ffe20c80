#pragma once

#include <cstddef>
#include <deque>

#include "samples/kinds.hpp"
#include "samples/command.hpp"

namespace fathom::fusion {

/// The samples of the last seconds in the order of their arrival: what an engine that takes up the state of
/// another one has to be told again, and the orders: those that are in the state already it knows by their
/// stamps. Bounded: the oldest makes room.
class ArrivalLog {
 public:
  struct Arrival {
    AnySample sample;
    Name writer;
  };

  /// Forgets everything; note() keeps samples only while it is on.
  void keep(bool on) {
    if (on == on_) return;
    on_ = on;
    arrivals_.clear();
    arrivals_.shrink_to_fit();
    orders_.clear();
  }
  /// `writer`: who published it.
  template <class T>
  void note(const T& sample, const Name& writer = {}) {
    if (!on_) return;
    if (arrivals_.size() == kMost) arrivals_.pop_front();
    arrivals_.push_back({sample, writer});
  }
  void note(const Command& order) {
    if (!on_) return;
    if (orders_.size() == kMostOrders) orders_.pop_front();
    orders_.push_back(order);
  }
  [[nodiscard]] const std::deque<Arrival>& arrivals() const { return arrivals_; }
  [[nodiscard]] const std::deque<Command>& orders() const { return orders_; }

 private:
  static constexpr std::size_t kMost = 8192;  // ten seconds of the busiest vehicle
  static constexpr std::size_t kMostOrders = 64;
  bool on_ = false;
  std::deque<Arrival> arrivals_;
  std::deque<Command> orders_;
};

}  // namespace fathom::fusion
