#include "health/navigation/order_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/wgs84.hpp"
#include "health/text.hpp"
#include "samples/departure.hpp"

namespace fathom::health {
namespace {

std::string length_text(double length_m) {
  return length_m < 1e4 ? sentence("%.0f m", length_m) : sentence("%.0f km", 1e-3 * length_m);
}

}  // namespace

std::optional<Departure> departure(const Command& order, const NavState& state) {
  if (order.kind != CommandKind::set_position || std::isnan(state.latitude_rad) ||
      std::isnan(state.longitude_rad))
    return std::nullopt;
  const geo::Geodetic known{state.latitude_rad, state.longitude_rad, 0.0};
  const geo::Geodetic ordered{order.latitude_rad, order.longitude_rad, 0.0};
  const auto& covariance = state.position_covariance_N_m2;
  return Departure{geo::difference_N(known, ordered).head<2>().norm(),
                   allowed_departure_m(covariance[0], covariance[4], order.sigma_m)};
}

void OrderWatch::add(const NavState& state) {
  if (!states_.empty()) {
    const DurationNs since_ns = state.header.stamp_ns - states_.back().header.stamp_ns;
    if (since_ns < 0) states_.clear();  // another time axis
    if (since_ns >= 0 && since_ns < kApart_ns) return;
  }
  if (states_.size() == kKept) states_.pop_front();
  states_.push_back(state);
}

void OrderWatch::add(const ServiceStatus& status, AlarmBook& book, const Instant& now) {
  const std::uint64_t orders = status.counter("orders_not_done");
  const auto known = undone_.find(status.header.sensor);
  std::uint64_t before = orders;  // what was left undone when nobody listened is no news
  if (known != undone_.end()) {
    const bool same = known->second.pid == status.pid && known->second.started_ns == status.started_ns;
    before = same ? known->second.orders : 0;
    known->second = {status.pid, status.started_ns, orders};
  } else if (undone_.size() < kMostServices) {
    undone_.emplace(status.header.sensor, Undone{status.pid, status.started_ns, orders});
  }
  if (orders <= before) return;
  const std::string last = last_.empty() ? "" : " The last one that was heard is " + last_ + ".";
  book.event({.key = "order_refused",
              .severity = Severity::warning,
              .text = sentence("%s has not done an order; its life sign and its log say why.%s",
                               status.header.sensor.c_str(), last.c_str()),
              .value = static_cast<double>(orders)},
             now);
}

void OrderWatch::apply(const Command& order, AlarmBook& book, const Instant& now) {
  if (order.kind == CommandKind::acknowledge_alarm) return;
  last_ = std::string(to_string(order.kind)) + (order.target.empty() ? "" : " " + order.target.str()) +
          " of " + order.header.sensor.str();
  const auto before = std::find_if(states_.rbegin(), states_.rend(), [&](const NavState& state) {
    return state.header.stamp_ns <= order.header.stamp_ns;
  });
  if (before == states_.rend()) return;
  const auto found = departure(order, *before);
  if (!found || !found->far()) return;
  const std::string who = order.header.sensor.str();
  const std::string apart = length_text(found->apart_m);
  const std::string allowed = length_text(found->allowed_m);
  book.event(
      {.key = order.confirmed ? "position_order_far" : "position_order_held",
       .severity = order.confirmed ? Severity::critical : Severity::warning,
       .text = order.confirmed
                   ? sentence("%s has ordered and confirmed a position %s from where navigation had it "
                              "(expected within %s).",
                              who.c_str(), apart.c_str(), allowed.c_str())
                   : sentence("%s has ordered a position %s from where navigation has it (expected "
                              "within %s): it waits 60 s for its confirmation.",
                              who.c_str(), apart.c_str(), allowed.c_str()),
       .value = found->apart_m,
       .limit = found->allowed_m},
      now);
}

}  // namespace fathom::health
