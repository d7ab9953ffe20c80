#include "bridge/bridge.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <utility>

#include "bus/writer.hpp"

namespace fathom::bridge {
namespace {

// A promise that survives one lost sample and a late one.
constexpr double kDeadlinePeriods = 3.0;
constexpr DurationNs kShortestDeadline = 20 * kNsPerMillisecond;

bus::WriterOptions writer_options(const host::ServiceHost& host, const config::SensorPlan& plan) {
  bus::WriterOptions out;
  if (plan.intermittent) return out;
  const DurationNs vehicle_ns = from_seconds(kDeadlinePeriods / plan.sensor.rate_hz);
  out.deadline_ns = std::max(kShortestDeadline, host.host_duration(vehicle_ns));
  return out;
}

class BusOutlet : public Outlet {
 public:
  BusOutlet(host::ServiceHost& host, const config::SensorPlan& plan, std::string_view role) {
    for_each_kind([&](auto kind) {
      using Sample = typename decltype(kind)::Sample;
      if (kind.kRole != role) return;
      std::get<Writer<Sample>>(writers_) =
          std::make_unique<bus::Writer<Sample>>(host.participant(), writer_options(host, plan));
      takes_[static_cast<std::size_t>(kind.kSource)] = true;
    });
  }

  [[nodiscard]] bool takes(std::size_t kind) const override { return takes_[kind]; }
  bool publish(const AnySample& sample) override {
    return std::visit(
        [&]<class Sample>(const Sample& value) {
          const Writer<Sample>& writer = std::get<Writer<Sample>>(writers_);
          return writer != nullptr && writer->write(value);
        },
        sample);
  }

 private:
  template <class Sample>
  using Writer = std::unique_ptr<bus::Writer<Sample>>;
  template <class... Samples>
  using Writers = std::tuple<Writer<Samples>...>;

  Kinds::Samples<Writers> writers_;
  std::array<bool, kSourceKinds> takes_{};
};

void add(ServiceStatus& status, const std::string& name, std::uint64_t value) {
  status.counters.push_back({Name(std::string_view(name)), value});
}

// Reasons that never occurred would only crowd out the instruments.
void add_if(ServiceStatus& status, const std::string& name, std::uint64_t value) {
  if (value > 0) add(status, name, value);
}

}  // namespace

struct Bridge::Impl {
  explicit Impl(host::ServiceHost& host_in) : host(host_in) {}

  void fill(ServiceStatus& status);
  void count(ServiceStatus& status) const;

  host::ServiceHost& host;
  std::vector<std::unique_ptr<Outlet>> outlets;
  std::vector<std::unique_ptr<SensorChannel>> channels;  ///< after the outlets: they go first
};

void Bridge::Impl::fill(ServiceStatus& status) {
  std::string problems;
  bool all_delivered = true;
  for (const auto& channel : channels) {
    if (const auto problem = channel->judge()) {
      problems += (problems.empty() ? "" : "; ") + channel->sensor().name.str() + ": " + *problem;
    }
    all_delivered = all_delivered && channel->has_started();
    status.rates.push_back({channel->sensor().name, channel->rate_hz()});
  }
  status.state = all_delivered ? ServiceState::healthy : ServiceState::starting;
  if (!problems.empty()) {
    status.state = ServiceState::degraded;
    status.text = problems;
  }
  count(status);
}

void Bridge::Impl::count(ServiceStatus& status) const {
  ChannelCounters sum;
  for (const auto& channel : channels) {
    const ChannelCounters one = channel->counters();
    sum.bytes += one.bytes;
    sum.frames += one.frames;
    sum.skipped_bytes += one.skipped_bytes;
    sum.samples += one.samples;
    sum.ignored += one.ignored;
    sum.write_failed += one.write_failed;
    sum.connects += one.connects;
    sum.source_errors += one.source_errors;
    sum.time_implausible += one.time_implausible;
    sum.time_steps += one.time_steps;
    sum.time_backwards += one.time_backwards;
    for (std::size_t i = 0; i < kRejectReasons; ++i) sum.rejected[i] += one.rejected[i];
    for (std::size_t i = 0; i < kRefusals; ++i) sum.refused[i] += one.refused[i];
  }
  add(status, "bytes", sum.bytes);
  add(status, "frames_good", sum.frames);
  add(status, "skipped_bytes", sum.skipped_bytes);
  add(status, "samples", sum.samples);
  add(status, "ignored_kinds", sum.ignored);
  add(status, "connects", sum.connects);
  add(status, "source_errors", sum.source_errors);
  add_if(status, "write_failed", sum.write_failed);
  add_if(status, "time_implausible", sum.time_implausible);
  add_if(status, "time_steps", sum.time_steps);
  add_if(status, "time_backwards", sum.time_backwards);
  for (std::size_t i = 0; i < kRejectReasons; ++i) {
    add_if(status, "rejected_" + std::string(codec::to_string(static_cast<codec::RejectReason>(i))),
           sum.rejected[i]);
  }
  for (std::size_t i = 0; i < kRefusals; ++i) {
    add_if(status, "refused_" + std::string(to_string(static_cast<Refusal>(i))), sum.refused[i]);
  }
  if (channels.size() < 2) return;
  for (const auto& channel : channels)
    add(status, "samples:" + channel->sensor().name.str(), channel->counters().samples);
}

Bridge::Bridge(host::ServiceHost& host, const std::vector<config::SensorPlan>& plans, std::string_view role)
    : impl_(std::make_unique<Impl>(host)) {
  for (const config::SensorPlan& plan : plans) {
    impl_->outlets.push_back(std::make_unique<BusOutlet>(host, plan, role));
    impl_->channels.push_back(std::make_unique<SensorChannel>(plan, host.common().vehicle, host.clock(),
                                                              host.log(), *impl_->outlets.back()));
  }
}

Bridge::~Bridge() {
  impl_->host.on_status(nullptr);
}

ExitCode Bridge::run() {
  impl_->host.on_status([this](ServiceStatus& status) { impl_->fill(status); });
  for (const auto& channel : impl_->channels) channel->start();
  return impl_->host.run();
}

}  // namespace fathom::bridge
