#include "simulator/measurement_source.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "dataset/dataset.hpp"
#include "sim/device_encoder.hpp"

namespace fathom::simulator {
namespace {

class Simulated final : public MeasurementSource {
 public:
  Simulated(const sim::Scenario& scenario, const sim::Simulation::Options& options, double truth_rate_hz)
      : simulation_(scenario, options), truth_period_ns_(from_seconds(1.0 / truth_rate_hz)) {
    next_truth_ns_ = options.epoch_ns;
    next_interval_ns_ = options.epoch_ns;
    interval_ns_ = 1e9 / scenario.sensors.of<ImuSample>().rate_hz;
    epoch_ns_ = options.epoch_ns;
  }

  bool advance(TimeNs until_ns, std::vector<sim::Measurement>& measurements,
               std::vector<Truth>& truths) override {
    while (next_interval_ns_ <= until_ns) {
      if (next_interval_ns_ >= next_truth_ns_) {
        truths.push_back(simulation_.truth());
        next_truth_ns_ += truth_period_ns_;
      }
      simulation_.advance(measurements);
      ++intervals_;
      next_interval_ns_ = epoch_ns_ + std::llround(interval_ns_ * static_cast<double>(intervals_));
    }
    return true;
  }

 private:
  sim::Simulation simulation_;
  DurationNs truth_period_ns_;
  TimeNs next_truth_ns_ = 0;
  TimeNs next_interval_ns_ = 0;
  TimeNs epoch_ns_ = 0;
  double interval_ns_ = 0.0;
  std::uint64_t intervals_ = 0;
};

class Recorded final : public MeasurementSource {
 public:
  Recorded(const std::string& directory, const sim::Scenario& devices,
           const sim::Simulation::Options& options) {
    dataset::ReadOptions read;
    read.epoch_ns = options.epoch_ns;
    read.vehicle = options.vehicle;
    dataset::Dataset data = dataset::read(directory, read);
    for (auto& dvl : data.of<DvlSample>()) complete(dvl, devices.sensors.of<DvlSample>());
    for (const auto& arrival : dataset::arrivals(data)) {
      dataset::visit(data, arrival, [&](const auto& sample) {
        const auto* device = sim::find_sensor(devices.sensors, sample.header.sensor.view());
        auto copy = sample;
        if (copy.header.received_ns == copy.header.stamp_ns && device != nullptr) {
          copy.header.received_ns += from_seconds(device->latency_s);
        }
        measurements_.emplace_back(copy);
      });
    }
    std::stable_sort(measurements_.begin(), measurements_.end(), [](const auto& a, const auto& b) {
      return header_of(a).stamp_ns < header_of(b).stamp_ns;
    });
    truths_ = std::move(data.reference);
  }

  bool advance(TimeNs until_ns, std::vector<sim::Measurement>& measurements,
               std::vector<Truth>& truths) override {
    while (next_ < measurements_.size() && header_of(measurements_[next_]).stamp_ns <= until_ns) {
      measurements.push_back(measurements_[next_++]);
    }
    while (next_truth_ < truths_.size() && truths_[next_truth_].header.stamp_ns <= until_ns) {
      truths.push_back(truths_[next_truth_++]);
    }
    return next_ < measurements_.size() || next_truth_ < truths_.size();
  }

 private:
  // A recorded velocity without beams goes out as the instrument's four-beam solution.
  static void complete(DvlSample& sample, const sim::DvlConfig& device) {
    using Frame = sim::DvlConfig::Frame;
    if (!known(sample.beam_angle_rad)) sample.beam_angle_rad = device.beam_angle_rad;
    if (!known(sample.sound_speed_m_s)) sample.sound_speed_m_s = device.sound_speed_m_s;
    const bool whole =
        known(sample.velocity_D_m_s[0]) && known(sample.velocity_D_m_s[1]) && known(sample.velocity_D_m_s[2]);
    if (whole && !known(sample.error_velocity_m_s)) sample.error_velocity_m_s = 0.0;
    sample.recorded_frame = device.frame == Frame::ship ? DvlFrame::ship : DvlFrame::instrument;
  }

  std::vector<sim::Measurement> measurements_;
  std::vector<Truth> truths_;
  std::size_t next_ = 0;
  std::size_t next_truth_ = 0;
};

}  // namespace

std::unique_ptr<MeasurementSource> simulate(const sim::Scenario& scenario,
                                            const sim::Simulation::Options& options, double truth_rate_hz) {
  return std::make_unique<Simulated>(scenario, options, truth_rate_hz);
}

std::unique_ptr<MeasurementSource> play(const std::string& directory, const sim::Scenario& devices,
                                        const sim::Simulation::Options& options) {
  return std::make_unique<Recorded>(directory, devices, options);
}

}  // namespace fathom::simulator
