#include "client/order_giver.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fathom/client.hpp>

#include "samples/position/limits.hpp"

namespace fathom {
namespace {

// Whoever was found has found us as well by then.
constexpr std::chrono::milliseconds kToBeMet{200};
constexpr std::chrono::milliseconds kLook{20};

void expect(bool holds, const char* what, double is, const char* expected) {
  if (!holds) {
    throw std::invalid_argument(std::string(what) + " is " + std::to_string(is) + ", expected " + expected);
  }
}

void expect_within(const char* what, double is, double least, double most) {
  if (is >= least && is <= most) return;
  std::array<char, 64> expected{};
  std::snprintf(expected.data(), expected.size(), "from %g to %.8g m", least, most);
  expect(false, what, is, expected.data());
}

void expect_place(double latitude_rad, double longitude_rad, double sigma_m, const PositionLimits& limits) {
  constexpr double kHalfTurn = std::numbers::pi;
  expect(std::abs(latitude_rad) <= 0.5 * kHalfTurn, "latitude_rad", latitude_rad, "from -pi/2 to pi/2");
  expect(std::abs(longitude_rad) <= kHalfTurn, "longitude_rad", longitude_rad, "from -pi to pi");
  expect_within("sigma_m", sigma_m, limits.least_sigma_m, limits.most_sigma_m);
}

void check(const Command& command) {
  switch (command.kind) {
    case CommandKind::set_position:
      expect_place(command.latitude_rad, command.longitude_rad, command.sigma_m, kOrderedPosition);
      expect_within("depth_m", command.depth_m, kOrderedPosition.least_depth_m,
                    kOrderedPosition.most_depth_m);
      return;
    case CommandKind::enable_source:
    case CommandKind::disable_source:
    case CommandKind::acknowledge_alarm:
      if (command.target.empty())
        throw std::invalid_argument("target is empty, expected the name of a sensor or an alarm");
      return;
    case CommandKind::mark_at_rest:
      expect(command.value_s > 0.0 && command.value_s <= 3600.0, "value_s", command.value_s,
             "from 0 to 3600 s");
      return;
    case CommandKind::realign:
      return;
  }
}

}  // namespace

template <class Sample>
SampleHeader OrderGiver::meet(std::optional<bus::Writer<Sample>>& writer, const char* what,
                              double timeout_s) {
  if (!(timeout_s >= 0.0)) throw std::invalid_argument("timeout_s is below 0, expected seconds");
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                             std::chrono::duration<double>(std::min(timeout_s, 86'400.0)));
  const bool is_new = !writer;
  if (is_new) writer.emplace(participant_);
  bool waited = is_new;
  while (writer->matched_readers() == 0 || !now_()) {
    if (std::chrono::steady_clock::now() >= end) {
      throw NobodyListens(writer->matched_readers() == 0
                              ? std::string("nobody takes ") + what + ", expected a fusion service"
                              : std::string("no vehicle is known, expected its name or its navigation"));
    }
    waited = true;
    std::this_thread::sleep_for(kLook);
  }
  if (waited) std::this_thread::sleep_for(kToBeMet);
  SampleHeader header = *now_();
  header.sensor = std::string_view(name_);
  return header;
}

void OrderGiver::order(Command command, double timeout_s) {
  check(command);
  const std::lock_guard lock(mutex_);
  command.header = meet(commands_, "orders", timeout_s);
  command.header.sequence = ++sequence_;
  if (!commands_->write(command)) throw std::runtime_error("the vehicle network did not take the order");
}

void OrderGiver::tell(FixSample fix, double timeout_s) {
  expect_place(fix.latitude_rad, fix.longitude_rad, fix.sigma_m, kToldPosition);
  if (known(fix.depth_m))
    expect_within("depth_m", fix.depth_m, kToldPosition.least_depth_m, kToldPosition.most_depth_m);
  const std::lock_guard lock(mutex_);
  SampleHeader header = meet(fixes_, "positions", timeout_s);
  if (!fix.header.sensor.empty()) header.sensor = fix.header.sensor;
  if (fix.header.stamp_ns != 0) {
    const DurationNs ago_ns = header.received_ns - fix.header.stamp_ns;
    expect(ago_ns >= 0 && ago_ns <= kOldestTold_ns, "header.stamp_ns: the vehicle was there",
           to_seconds(ago_ns), "0 to 7200 s ago");
    header.stamp_ns = fix.header.stamp_ns;
  }
  // Nobody else in this name has the same number.
  header.sequence = static_cast<std::uint64_t>(header.received_ns);
  fix.header = header;
  if (!fixes_->write(fix)) throw std::runtime_error("the vehicle network did not take the position");
}

}  // namespace fathom
