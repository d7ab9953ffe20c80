#include "bridge/sensor_channel.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "bridge/babble.hpp"
#include "bridge/backlog.hpp"
#include "bridge/frame_text.hpp"
#include "runtime/change_log.hpp"
#include "runtime/device_time.hpp"

namespace fathom::bridge {
namespace {

using runtime::Arrival;
using runtime::ChangeLog;
using runtime::LogLevel;
using runtime::SourceEvent;
using runtime::SourceState;

// A reason that was logged is logged again when it had not occurred for this long.
constexpr DurationNs kQuiet = 60 * kNsPerSecond;

// So long bytes have to belong to no frame before that is said, of a slow instrument longer: at 4800 baud a
// frame of 2400 bytes takes as long, and what was connected to in the middle of a frame is over by then.
constexpr DurationNs kBabble = 5 * kNsPerSecond;

SampleHeader& header_of(AnySample& sample) {
  return std::visit([](auto& value) -> SampleHeader& { return value.header; }, sample);
}

// Samples that are decoded from one read and wait for each other; a read has room for some hundred.
constexpr std::size_t kMostAtOnce = 256;

/// The source of a sensor, with what its protocol wants to be told first.
runtime::ByteSourceConfig greeting_from(const config::SensorConfig& sensor) {
  runtime::ByteSourceConfig out = sensor.source;
  out.greeting = codec::find_protocol(sensor.protocol)->greeting;
  return out;
}

std::string sentence(const config::SensorConfig& sensor, const Babble::Report& report) {
  std::array<char, 96> seen{};
  std::snprintf(seen.data(), seen.size(), "%llu bytes in %.0f s, and no good frame of ",
                static_cast<unsigned long long>(report.bytes), report.seconds);
  std::string out = sensor.name.str() + ": " + seen.data() + sensor.protocol + " among them; they begin " +
                    report.first_bytes + "; expected " + sensor.protocol;
  const bool is_serial = sensor.source.type == runtime::SourceType::serial;
  if (is_serial)
    out += " at " + std::to_string(sensor.source.baud) + " baud " +
           std::string(to_string(sensor.source.framing));
  return out + " from " + runtime::describe_source(sensor.source) +
         (is_serial ? ": compare the instrument's baud rate and output"
                    : ": compare the instrument's output");
}

// Lets the first of a burst through.
class Burst {
 public:
  bool first(TimeNs now_ns) {
    const bool out = !last_ns_ || now_ns - *last_ns_ > kQuiet;
    last_ns_ = now_ns;
    return out;
  }
  void forget() { last_ns_.reset(); }

 private:
  std::optional<TimeNs> last_ns_;
};

}  // namespace

struct SensorChannel::Impl : codec::Sink {
  Impl(config::SensorPlan plan_in, std::string_view vehicle_in, const Clock& clock_in, runtime::Log& log_in,
       Outlet& outlet_in)
      : plan(std::move(plan_in)),
        vehicle(vehicle_in),
        clock(clock_in),
        log(log_in),
        outlet(outlet_in),
        tracker(plan.sensor.time),
        read_by_read(plan.sensor.time.mode != runtime::TimeMode::device_utc && !paced()),
        backlogs(kSampleKinds, Backlog(plan.intermittent ? 0.0 : plan.sensor.rate_hz)),
        babble(std::max(kBabble, from_seconds(config::stale_after_s(plan.sensor)))),
        health(plan.intermittent ? 0.0 : plan.sensor.rate_hz, config::stale_after_s(plan.sensor),
               plan.sensor.first_sample_s, clock.monotonic_ns()),
        source(
            greeting_from(plan.sensor), clock,
            [this](std::span<const std::uint8_t> bytes, const Arrival& at) { on_bytes(bytes, at); },
            [this](const SourceEvent& event) { on_event(event); }) {
    plan.options.ascii_prefix = plan.ascii_prefix;
    waiting.reserve(kMostAtOnce);
    new_codec();
  }

  void new_codec() { codec = codec::find_protocol(plan.sensor.protocol)->make(plan.options); }
  void on_bytes(std::span<const std::uint8_t> bytes, const Arrival& at);
  void on_event(const SourceEvent& event);
  /// True when there was one.
  bool write(const std::optional<ChangeLog::Line>& line);
  void on_sample(const codec::Decoded& decoded) override;
  void on_rejected(const codec::Rejected& rejected) override;

  [[nodiscard]] bool is_ours(const AnySample& sample) const;
  [[nodiscard]] bool paced() const;
  void stamp_and_publish(const codec::Decoded& decoded, const Arrival& at);
  void publish_waiting();
  void keep_pace(const DeviceTime& time);
  [[nodiscard]] Refused no_instant(const runtime::Stamp& stamp) const;
  void note_time(const runtime::Stamp& stamp);
  void add_totals();
  void judge_line(std::span<const std::uint8_t> bytes);

  config::SensorPlan plan;
  const Name vehicle;
  const Clock& clock;
  runtime::Log& log;
  Outlet& outlet;

  // Of the source's thread alone.
  std::unique_ptr<codec::Codec> codec;
  codec::Totals before;              ///< of the codec, as already counted
  std::uint64_t rejected_bytes = 0;  ///< inside frames that were refused, of the present read
  runtime::DeviceTimeTracker tracker;
  Arrival arrival;
  const bool read_by_read;              ///< what arrived together is stamped together
  std::vector<codec::Decoded> waiting;  ///< until all of one read are decoded
  bool is_new = true;                   ///< nothing was connected yet, or no more
  std::vector<Backlog> backlogs;        ///< of each kind of sample
  std::array<std::uint64_t, kSampleKinds> sequence{};
  std::array<Burst, kRejectReasons> said_rejected;
  std::array<Burst, kRefusals> said_refused;
  ChangeLog changes;
  Burst said_implausible;
  Burst said_step;
  Babble babble;
  std::optional<TimeNs> pace_device_ns;  ///< file: what the last frame's clock said ...
  TimeNs pace_clock_ns = 0;              ///< ... and when it was due

  mutable std::mutex mutex;  ///< guards the next three
  ChannelCounters counters;
  std::uint64_t waste_bytes = 0;
  std::optional<TimeNs> last_sample_ns;

  ChannelHealth health;        ///< of the thread that asks
  runtime::ByteSource source;  ///< last: its thread ends before what it uses goes
};

bool SensorChannel::Impl::is_ours(const AnySample& sample) const {
  if (!outlet.takes(sample.index())) return false;
  const auto* usbl = std::get_if<UsblSample>(&sample);
  return usbl == nullptr || plan.transponder.empty() ||
         usbl->transponder == Name(std::string_view(plan.transponder));
}

void SensorChannel::Impl::on_bytes(std::span<const std::uint8_t> bytes, const Arrival& at) {
  arrival = at;
  codec->feed(bytes, *this);
  publish_waiting();
  judge_line(bytes);
}

void SensorChannel::Impl::judge_line(std::span<const std::uint8_t> bytes) {
  const codec::Totals last = before;
  const std::uint64_t refused_bytes = std::exchange(rejected_bytes, 0);
  add_totals();
  if (before.samples + before.frames_ignored > last.samples + last.frames_ignored) {
    if (babble.understood()) log.info(plan.sensor.name.str() + ": understood now");
    return;
  }
  const std::uint64_t waste = before.skipped_bytes - last.skipped_bytes + refused_bytes;
  if (const auto report = babble.not_understood(bytes, waste, arrival.monotonic_ns))
    log.warning(sentence(plan.sensor, *report));
}

bool SensorChannel::Impl::paced() const {
  const auto& from = plan.sensor.source;
  return from.type == runtime::SourceType::file && from.pace == runtime::Pace::original;
}

void SensorChannel::Impl::publish_waiting() {
  std::array<std::size_t, kSampleKinds> left{};
  for (const codec::Decoded& decoded : waiting) ++left[decoded.sample.index()];
  std::array<DurationNs, kSampleKinds> spacing_ns{};
  for (std::size_t kind = 0; kind < kSampleKinds; ++kind) {
    if (left[kind] > 0 && plan.sensor.time.mode == runtime::TimeMode::arrival) {
      spacing_ns[kind] = backlogs[kind].spacing(left[kind], arrival.monotonic_ns);
    }
  }
  for (const codec::Decoded& decoded : waiting) tracker.foresee(decoded.time, arrival);
  for (const codec::Decoded& decoded : waiting) {
    const std::size_t kind = decoded.sample.index();
    const DurationNs ago_ns = static_cast<DurationNs>(--left[kind]) * spacing_ns[kind];
    stamp_and_publish(decoded, {arrival.utc_ns - ago_ns, arrival.monotonic_ns - ago_ns});
  }
  waiting.clear();
}

void SensorChannel::Impl::add_totals() {
  const codec::Totals now = codec->totals();
  const std::lock_guard lock(mutex);
  counters.bytes += now.bytes - before.bytes;
  counters.frames += (now.samples - before.samples) + (now.frames_ignored - before.frames_ignored);
  counters.skipped_bytes += now.skipped_bytes - before.skipped_bytes;
  waste_bytes += now.skipped_bytes - before.skipped_bytes;
  before = now;
}

bool SensorChannel::Impl::write(const std::optional<ChangeLog::Line>& line) {
  if (line) log.write(line->level, line->text);
  return line.has_value();
}

void SensorChannel::Impl::on_event(const SourceEvent& event) {
  const std::string text = plan.sensor.name.str() + ": " + event.detail;
  const bool well = event.state == SourceState::connected || event.state == SourceState::finished;
  const bool said =
      write(changes.add({well ? LogLevel::info : LogLevel::warning, text}, clock.monotonic_ns()));
  if (event.state == SourceState::lost || event.state == SourceState::finished) {
    // Half a frame of the old connection must not meet half a frame of the new one.
    codec->finish(*this);
    publish_waiting();
    add_totals();
    new_codec();
    before = {};
    tracker.reset();
    if (said) {
      for (auto& burst : said_rejected) burst.forget();
      for (auto& burst : said_refused) burst.forget();
    }
    babble.forget();
    rejected_bytes = 0;
    is_new = true;
  } else if (event.state == SourceState::connected && std::exchange(is_new, false)) {
    for (Backlog& backlog : backlogs) backlog.begin(clock.monotonic_ns());
  }
}

void SensorChannel::Impl::keep_pace(const DeviceTime& time) {
  const auto device = time.clock_ns ? time.clock_ns : time.utc_ns ? time.utc_ns : time.time_of_day_ns;
  if (!device) return;
  constexpr DurationNs kLongestGap = 10 * kNsPerSecond;
  const TimeNs now = clock.monotonic_ns();
  const DurationNs step = pace_device_ns ? *device - *pace_device_ns : 0;
  // Time that jumps (a new day in a recording without dates, a damaged field) starts a new count.
  pace_clock_ns = pace_device_ns && step >= 0 && step <= kLongestGap ? pace_clock_ns + step : now;
  pace_device_ns = device;
  if (pace_clock_ns > now) source.hold(pace_clock_ns - now);
  arrival = {clock.utc_ns(), clock.monotonic_ns()};
}

Refused SensorChannel::Impl::no_instant(const runtime::Stamp& stamp) const {
  return {.why = Refusal::no_instant,
          .field = "the device's UTC less the vehicle's (s)",
          .value = stamp.implausible_by_s,
          .least = -plan.sensor.time.max_age_s,
          .most = plan.sensor.time.tolerance_s};
}

void SensorChannel::Impl::note_time(const runtime::Stamp& stamp) {
  if (stamp.implausible && !plan.dated && said_implausible.first(arrival.monotonic_ns)) {
    log.warning(plan.sensor.name.str() + ": stamped by arrival: " + sentence(no_instant(stamp)));
  }
  if (stamp.clock_step && said_step.first(arrival.monotonic_ns)) {
    log.warning(plan.sensor.name.str() + ": the device's clock was stepped; its offset was found anew");
  }
  const std::lock_guard lock(mutex);
  counters.time_implausible += stamp.implausible ? 1 : 0;
  counters.time_steps += stamp.clock_step ? 1 : 0;
  counters.time_backwards += stamp.backwards ? 1 : 0;
}

void SensorChannel::Impl::on_sample(const codec::Decoded& decoded) {
  if (!is_ours(decoded.sample)) {
    const std::lock_guard lock(mutex);
    ++counters.ignored;
    return;
  }
  if (read_by_read) {
    waiting.push_back(decoded);
    return;
  }
  if (paced()) keep_pace(decoded.time);
  stamp_and_publish(decoded, arrival);
}

void SensorChannel::Impl::stamp_and_publish(const codec::Decoded& decoded, const Arrival& at) {
  const runtime::Stamp stamp = tracker.stamp(decoded.time, at);
  note_time(stamp);

  AnySample sample = decoded.sample;
  if (auto* imu = std::get_if<ImuSample>(&sample)) rotate_into_body(*imu, plan.R_BS);
  std::optional<Refused> refused = refuse(sample, plan.limits);
  if (plan.dated && stamp.implausible) refused = no_instant(stamp);
  if (refused) {
    const auto index = static_cast<std::size_t>(refused->why);
    if (said_refused[index].first(arrival.monotonic_ns))
      log.warning(plan.sensor.name.str() + ": sample refused: " + sentence(*refused));
    const std::lock_guard lock(mutex);
    ++counters.refused[index];
    return;
  }
  SampleHeader& header = header_of(sample);
  header.vehicle = vehicle;
  header.sensor = plan.sensor.name;
  header.stamp_ns = stamp.utc_ns;
  header.received_ns = arrival.utc_ns;
  header.sequence = ++sequence[sample.index()];
  const bool written = outlet.publish(sample);
  const std::lock_guard lock(mutex);
  if (written) {
    ++counters.samples;
    last_sample_ns = arrival.monotonic_ns;
  } else {
    ++counters.write_failed;
  }
}

void SensorChannel::Impl::on_rejected(const codec::Rejected& rejected) {
  const auto index = static_cast<std::size_t>(rejected.reason);
  if (index >= kRejectReasons) return;
  if (said_rejected[index].first(arrival.monotonic_ns)) {
    log.warning(plan.sensor.name.str() + ": " + sentence(rejected));
  }
  rejected_bytes += rejected.length;
  const std::lock_guard lock(mutex);
  ++counters.rejected[index];
  waste_bytes += rejected.length;
}

SensorChannel::SensorChannel(config::SensorPlan plan, std::string_view vehicle, const Clock& clock,
                             runtime::Log& log, Outlet& outlet)
    : impl_(std::make_unique<Impl>(std::move(plan), vehicle, clock, log, outlet)) {}

SensorChannel::~SensorChannel() = default;

void SensorChannel::start() {
  impl_->source.start();
}

const config::SensorConfig& SensorChannel::sensor() const {
  return impl_->plan.sensor;
}

ChannelCounters SensorChannel::counters() const {
  const runtime::SourceStatus source = impl_->source.status();
  const std::lock_guard lock(impl_->mutex);
  ChannelCounters out = impl_->counters;
  out.connects = source.connects;
  out.source_errors = source.errors;
  return out;
}

std::optional<std::string> SensorChannel::judge() {
  impl_->write(impl_->changes.due(impl_->clock.monotonic_ns()));
  const runtime::SourceStatus source = impl_->source.status();
  ChannelTotals totals;
  totals.state = source.state;
  totals.detail = source.detail.empty()
                      ? runtime::describe_source(impl_->plan.sensor.source) + ": not open yet"
                      : source.detail;
  {
    const std::lock_guard lock(impl_->mutex);
    totals.bytes = impl_->counters.bytes;
    totals.waste_bytes = impl_->waste_bytes;
    totals.samples = impl_->counters.samples;
    totals.last_sample_ns = impl_->last_sample_ns;
  }
  return impl_->health.judge(totals, impl_->clock.monotonic_ns());
}

bool SensorChannel::has_started() const {
  const bool may_wait = impl_->plan.intermittent || impl_->plan.sensor.first_sample_s > 0.0;
  const SourceState state = impl_->source.status().state;
  if (may_wait && (state == SourceState::connected || state == SourceState::silent)) return true;
  const std::lock_guard lock(impl_->mutex);
  return impl_->counters.samples > 0;
}

double SensorChannel::rate_hz() const {
  return impl_->health.rate_hz();
}

}  // namespace fathom::bridge
