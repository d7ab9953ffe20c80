#include "simulator/player.hpp"

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <utility>

namespace fathom::simulator {
namespace {

// The source is asked this far ahead of the clock, so that computing does not delay sending; host time.
constexpr double kAhead_s = 0.03;
// Longest sleep: how long stopping and new connections may have to wait, host time.
constexpr DurationNs kNap = 50 * kNsPerMillisecond;

bool later(const auto& a, const auto& b) {
  return a.due_ns != b.due_ns ? a.due_ns > b.due_ns : a.order > b.order;
}

}  // namespace

Player::Player(std::unique_ptr<MeasurementSource> source, const sim::Scenario& scenario, TimeNs epoch_ns,
               const std::string& link_dir, int port_offset, const Clock& clock, TruthHandler on_truth)
    : clock_(clock),
      epoch_ns_(epoch_ns),
      monotonic_to_utc_ns_(clock.utc_ns() - clock.monotonic_ns()),
      source_(std::move(source)),
      // Instruments have been on for a while when the run starts.
      encoder_(scenario, epoch_ns - 30 * kNsPerSecond),
      on_truth_(std::move(on_truth)) {
  for (const auto& [kind, sensor] : sim::sensors_of(scenario.sensors)) {
    const std::string name(to_string(kind));
    if (!sensor->enabled || sensor->protocol.empty()) continue;
    if (!sim::can_encode(kind, sensor->protocol)) {
      throw LinkError(name + ": the simulator does not speak protocol " + sensor->protocol);
    }
    const auto& link = sensor->link;
    const std::string key =
        std::to_string(static_cast<int>(link.type)) + link.path + link.address + std::to_string(link.port);
    auto& slot = links_[key];  // sensors may share a link, like rpm and fins of one controller
    if (!slot) slot = make_link(link, link_dir, port_offset, clock);
    kinds_.push_back({name, slot.get()});
    devices_.push_back(name + ": " + sensor->protocol + " on " + slot->where());
  }
  thread_ = std::thread([this] { run(); });
}

Player::~Player() {
  stop_ = true;
  thread_.join();
}

TimeNs Player::vehicle_now() const {
  return clock_.monotonic_ns() + monotonic_to_utc_ns_;
}

bool Player::wait_until(TimeNs vehicle_ns) const {
  while (!stop_) {
    const double left_ns = static_cast<double>(vehicle_ns - vehicle_now()) / clock_.rate();
    if (left_ns <= 0.0) return true;
    const auto nap_ns = std::min(static_cast<DurationNs>(left_ns), kNap);
    timespec nap{};
    nap.tv_sec = nap_ns / kNsPerSecond;
    nap.tv_nsec = nap_ns % kNsPerSecond;
    ::clock_nanosleep(CLOCK_MONOTONIC, 0, &nap, nullptr);
    for (const auto& [key, link] : links_) link->poll();
  }
  return false;
}

void Player::fetch(TimeNs until_ns) {
  if (exhausted_) return;
  std::vector<sim::Measurement> measurements;
  std::vector<Truth> truths;
  exhausted_ = !source_->advance(until_ns, measurements, truths);
  for (auto& measurement : measurements) {
    const auto& header = header_of(measurement);
    const auto kind = std::find_if(kinds_.begin(), kinds_.end(),
                                   [&](const Kind& each) { return each.name == header.sensor.view(); });
    auto bytes = encoder_.encode(measurement);
    if (kind == kinds_.end() || bytes.empty()) continue;
    queue_.push_back(
        {header.received_ns, order_++, static_cast<int>(kind - kinds_.begin()), std::move(bytes), {}});
    std::push_heap(queue_.begin(), queue_.end(), later<Outgoing, Outgoing>);
  }
  for (const auto& truth : truths) {
    queue_.push_back({truth.header.stamp_ns, order_++, -1, {}, truth});
    std::push_heap(queue_.begin(), queue_.end(), later<Outgoing, Outgoing>);
  }
}

void Player::send(const Outgoing& outgoing, TimeNs now_ns) {
  if (outgoing.kind < 0) {
    on_truth_(outgoing.truth);
    return;
  }
  const Kind& kind = kinds_[static_cast<std::size_t>(outgoing.kind)];
  kind.link->send(outgoing.bytes);
  const std::lock_guard lock(mutex_);
  ++status_.messages;
  ++status_.messages_of[kind.name];
  status_.links[kind.link->where()] = kind.link->counters();
  worst_s_ = std::max(worst_s_, to_seconds(now_ns - outgoing.due_ns));
  if (now_ns - worst_since_ns_ >= kNsPerSecond) {
    status_.latest_s = worst_s_;
    worst_s_ = 0.0;
    worst_since_ns_ = now_ns;
  }
}

void Player::run() {
  const DurationNs ahead_ns = from_seconds(kAhead_s * clock_.rate());
  TimeNs fetched_ns = epoch_ns_;
  while (!stop_) {
    const TimeNs now = vehicle_now();
    if (!exhausted_ && now + ahead_ns >= fetched_ns) {
      fetched_ns = std::max(now, epoch_ns_) + ahead_ns;
      fetch(fetched_ns);
    }
    while (!queue_.empty() && queue_.front().due_ns <= vehicle_now()) {
      std::pop_heap(queue_.begin(), queue_.end(), later<Outgoing, Outgoing>);
      const Outgoing next = std::move(queue_.back());
      queue_.pop_back();
      send(next, vehicle_now());
    }
    if (exhausted_ && queue_.empty()) {
      const std::lock_guard lock(mutex_);
      status_.finished = true;
    }
    // The next message, or the time to fetch again.
    TimeNs until = exhausted_ ? vehicle_now() + from_seconds(clock_.rate() * to_seconds(kNap))
                              : fetched_ns - ahead_ns / 2;
    if (!queue_.empty()) until = std::min(until, queue_.front().due_ns);
    if (!wait_until(until)) return;
  }
}

PlayerStatus Player::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

}  // namespace fathom::simulator
