#pragma once

#include <cstddef>
#include <deque>

#include "fusion/intake/arrival.hpp"
#include "samples/command.hpp"

namespace fathom::fusion {

/// Log of the arrivals and orders of the last seconds, in the order of their arrival. An engine that takes
/// over the state of another one is given them again. (Orders that the state holds already are known to the
/// engine by their stamps.) The log is bounded: the oldest entry makes room for a new one.
class ArrivalLog {
 public:
  /// Forgets everything. add() keeps something only while `on`.
  void keep(bool on) {
    if (on == on_) return;
    on_ = on;
    arrivals_.clear();
    arrivals_.shrink_to_fit();
    orders_.clear();
  }
  void add(const Arrival& arrival) {
    if (!on_) return;
    if (arrivals_.size() == kMost) arrivals_.pop_front();
    arrivals_.push_back(arrival);
  }
  void add(const Command& order) {
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
