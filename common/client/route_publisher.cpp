#include "client/route_publisher.hpp"

#include <chrono>
#include <stdexcept>
#include <utility>

#include "bus/writer.hpp"

namespace fathom {
namespace {

// Host time: the deadline that readers hold us to is DDS's, which knows no accelerated vehicle.
constexpr std::chrono::seconds kRepeat{1};
// However often a program changes its mind: people see no more, and the network has other things to carry.
constexpr std::chrono::milliseconds kShortest{100};

}  // namespace

RoutePublisher::~RoutePublisher() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void RoutePublisher::publish(Route route) {
  route.header.sensor = std::string_view(name_);
  if (const RouteFault fault = fault_of(route); fault != RouteFault::none) {
    throw std::invalid_argument("route of " + name_ + ": its " + std::string(to_string(fault)) +
                                " is not usable, expected " + std::string(expectation(fault)));
  }
  if (route.mission_count == 0) route.mission_count = static_cast<std::uint32_t>(route.waypoints.size());
  std::string trouble;
  {
    const std::lock_guard lock(mutex_);
    fresh_ = fresh_ || !route_ || !same_intent(*route_, route);
    route_ = std::move(route);
    trouble = std::exchange(trouble_, {});
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  }
  changed_.notify_all();
  if (!trouble.empty()) throw std::runtime_error("route of " + name_ + ": " + trouble);
}

void RoutePublisher::run() {
  // Created here and not in publish(), which may be called from a reader's handler, where DDS creates
  // nothing.
  std::optional<bus::Writer<Route>> writer;
  std::uint64_t sequence = 0;
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    const auto began = std::chrono::steady_clock::now();
    fresh_ = false;
    const Name vehicle = vehicle_();
    if (!vehicle.empty()) {
      Route route = *route_;
      lock.unlock();
      std::string trouble;
      try {
        if (!writer) writer.emplace(participant_);
        route.header.vehicle = vehicle;
        route.header.stamp_ns = route.header.received_ns = clock_.utc_ns();
        route.header.sequence = ++sequence;
        if (!writer->write(route)) trouble = "the vehicle network did not take it";
      } catch (const std::exception& error) {
        trouble = error.what();
      }
      lock.lock();
      trouble_ = trouble;
    }
    changed_.wait_until(lock, began + kShortest, [this] { return stopping_; });
    changed_.wait_until(lock, began + kRepeat, [this] { return stopping_ || (fresh_ && trouble_.empty()); });
  }
}

}  // namespace fathom
