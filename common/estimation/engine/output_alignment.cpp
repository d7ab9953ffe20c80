// The state of the alignment as it is published: its conditions, what it waits for and what would help.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <string_view>

#include "base/units.hpp"
#include "estimation/engine/output.hpp"
#include "samples/alignment/help.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using Text = std::array<char, 128>;

/// A fault is told until all timers may have run and a window may be full again.
constexpr double kFaultTold_s = 4.0;

void write(Text& target, const char* format, ...) __attribute__((format(printf, 2, 3)));
void write(Text& target, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  target.fill('\0');
  // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is just above, the analyser misses it
  std::vsnprintf(target.data(), target.size(), format, arguments);
  va_end(arguments);
}

const char* advice(const StartConditions& c, const Navigator& navigator, const AlignmentConfig& config,
                   const Vector3d& sigma) {
  switch (navigator.alignment().phase) {
    case AlignmentPhase::aligned:
    case AlignmentPhase::none:
      return "";
    case AlignmentPhase::fine:
      if (sigma.z() > config.aligned_heading_sigma_rad)
        return "Turn by 90 degrees or more and change speed: the heading is not yet known well enough.";
      return "Hold on: roll and pitch are settling.";
    default:
      break;
  }
  if (navigator.waits_for_state()) return "Waiting for the state that it is to start from.";
  if (config.mode == StartMode::air_drop && !known(navigator.starter().gps_speed_m_s()))
    return "The heading was lost too: surface and run straight with GPS, or give a state to start from.";
  if (heads_by_acceleration(config) && (!c.slow || !c.quiet))
    return "Speed up, brake and turn with GPS velocity, or give a compass, or stop the vehicle.";
  if (config.mode == StartMode::in_motion || config.mode == StartMode::air_drop)
    return "Move straight with a GPS fix until the course is steady.";
  if (!c.slow) return "Run faster and straight with GPS, or give a compass or a DVL, or stop the vehicle.";
  if (!c.quiet) return "Keep the vehicle quiet: it moves too much to be levelled.";
  if (!c.window_full) return "Keep the vehicle quiet.";
  if (!c.position) return "A position is missing: wait for a GPS fix or set one.";
  if (!c.heading)
    return "A heading is missing: run straight with GPS (and DVL), check the compass or give one.";
  return "The gyro is not good enough to find north: give a heading.";
}

/// What set timers and window back, as a part of a sentence; nullptr for nothing worth telling.
const char* fault_text(StabilityReset fault) {
  switch (fault) {
    case StabilityReset::not_finite:
      return "an inertial reading was no number";
    case StabilityReset::gap:
      return "inertial samples were missing";
    case StabilityReset::stale:
      return "an inertial sample was stale";
    case StabilityReset::repeated:
      return "an inertial reading was repeated";
    case StabilityReset::no_depth:
      return "the depth was missing";
    case StabilityReset::no_speed:
      return "the propulsor speed was missing";
    default:
      return nullptr;
  }
}

/// The manoeuvre that brings the first missing condition about; nullptr when all hold.
const char* manoeuvre(const DropAlignment& drop, Text& text) {
  using C = StabilityCondition;
  const StabilityGate& gate = drop.gate();
  const auto met = [&gate](C condition) { return gate.watched(condition).met(); };
  const auto limit = [&gate](C condition) { return gate.watched(condition).limit; };
  if (!met(C::depth)) {
    write(text, "hold depth within %.0f m of the set %.0f m", limit(C::depth), drop.config().set_depth_m);
  } else if (!met(C::roll)) {
    write(text, "hold roll within %.0f deg", limit(C::roll) / kRadPerDeg);
  } else if (!met(C::pitch)) {
    write(text, "level off: pitch within %.0f deg", limit(C::pitch) / kRadPerDeg);
  } else if (!met(C::force_x)) {
    write(text, "hold the speed: forward force within %.1f m/s2", limit(C::force_x));
  } else if (!met(C::rate_z)) {
    write(text, "run straight: turn slower than %.0f deg/s", limit(C::rate_z) / kRadPerDeg);
  } else if (!met(C::rate_y)) {
    write(text, "hold the pitch steady: within %.0f deg/s", limit(C::rate_y) / kRadPerDeg);
  } else if (!met(C::gravity)) {
    write(text, "hold the depth rate steady: heave force within %.2f m/s2", limit(C::gravity));
  } else if (!met(C::speed_slope)) {
    write(text, "hold the speed steady: within %.2f m/s2", limit(C::speed_slope));
  } else {
    return nullptr;
  }
  return text.data();
}

void drop_advice(const DropAlignment& drop, Text& out) {
  const StabilityGate& gate = drop.gate();
  switch (drop.phase()) {
    case AlignmentPhase::aligned:
      return write(out, "%s", "");
    case AlignmentPhase::coarse:
    case AlignmentPhase::fine:
      return write(out, "%s",
                   drop.consistent() ? "Hold on: roll and pitch are being refined."
                                     : "Log, depth and inertial unit contradict each other: run straight.");
    case AlignmentPhase::averaging:
      return write(out, "%s", "Hold course, depth and speed.");
    default:
      break;
  }
  if (!drop.wet()) return write(out, "%s", "Waiting for the water: the depth sensor reports none yet.");
  if (const char* missing = fault_text(drop.missing()))
    return write(out, "Timers stand still: %s; all begins anew when it is back.", missing);
  Text helpful;
  const char* wanted = manoeuvre(drop, helpful);
  const char* fault = gate.since_fault_s() < kFaultTold_s ? fault_text(gate.last_fault()) : nullptr;
  if (fault != nullptr)
    return write(out, "Began anew, %s: %s.", fault, wanted != nullptr ? wanted : "hold on");
  if (drop.phase() == AlignmentPhase::lost)
    return write(out, "%s",
                 "The attitude was lost in a gap: it is found again while the vehicle runs straight.");
  if (wanted != nullptr) {
    write(out, "%s.", wanted);
    out[0] = static_cast<char>(out[0] - 'a' + 'A');
    return;
  }
  switch (gate.last_reset()) {
    case StabilityReset::spread:
      return write(out, "%s", "Hold on: the last window was too restless.");
    case StabilityReset::disagreement:
      return write(out, "%s", "Hold on: the last window contradicted the fine solution.");
    default:
      return write(out, "%s", "Hold on.");
  }
}

void add_condition(AlignmentStatus& out, const char* name, double value, double limit, bool met,
                   double held_s = 0.0, double needed_s = 0.0) {
  if (out.condition_count >= AlignmentStatus::kMaxConditions) return;
  AlignmentCondition& one = out.conditions[out.condition_count++];
  one.name = name;
  one.value = value;
  one.limit = limit;
  one.met = met;
  one.held_s = held_s;
  one.needed_s = needed_s;
}

/// The name of a condition of which there is one for each kind of finding, sensor or axis.
std::array<char, 32> name_of(std::string_view prefix, std::string_view which) {
  std::array<char, 32> out{};
  std::snprintf(out.data(), out.size(), "%.*s%.*s", static_cast<int>(prefix.size()), prefix.data(),
                static_cast<int>(which.size()), which.data());
  return out;
}

/// Each condition of the run, then how far the averages and the fine solution are.
void fill_drop(const DropAlignment& drop, AlignmentStatus& out) {
  for (std::size_t i = 0; i < kStabilityConditions; ++i) {
    const auto condition = static_cast<StabilityCondition>(i);
    const StabilityGate::Watched& one = drop.gate().watched(condition);
    add_condition(out, to_string(condition).data(), one.value, one.limit, one.met(), one.held_s,
                  one.needed_s);
  }
  const Vector3d sigma = drop.rpy_sigma_rad();
  const double limit = drop.config().aligned_tilt_sigma_rad;
  const double hold = drop.config().aligned_hold_s;
  add_condition(out, "roll_sigma_rad", sigma.x(), limit, sigma.x() <= limit, drop.held_s(), hold);
  add_condition(out, "pitch_sigma_rad", sigma.y(), limit, sigma.y() <= limit, drop.held_s(), hold);
  out.time_to_aligned_s = drop.time_to_aligned_s();
  drop_advice(drop, out.advice);
}

/// Once it navigates: what is still missing from aligned.
void fill_navigating(const Navigator& navigator, const EngineConfig& engine, const Vector3d& sigma,
                     AlignmentStatus& out) {
  const AlignmentConfig& config = engine.alignment;
  const double held = navigator.alignment().hold_since_ns == 0
                          ? 0.0
                          : to_seconds(navigator.now_ns() - navigator.alignment().hold_since_ns);
  const auto sigma_condition = [&](const char* name, double value, double limit) {
    add_condition(out, name, value, limit, value <= limit, held, config.aligned_hold_s);
  };
  sigma_condition("roll_sigma_rad", sigma.x(), engine.aligned_tilt_sigma_rad());
  sigma_condition("pitch_sigma_rad", sigma.y(), engine.aligned_tilt_sigma_rad());
  sigma_condition("yaw_sigma_rad", sigma.z(), config.aligned_heading_sigma_rad);
  const double unheard = navigator.unheard_s();
  if (unheard > 0.0) add_condition(out, "imu_unjudged_s", unheard, 0.0, false);
  const bool doubted = navigator.is_doubted();
  if (doubted) add_condition(out, "instruments_contradict", 1.0, 0.0, false);
  if (navigator.alignment().phase == AlignmentPhase::aligned) {
    out.time_to_aligned_s = 0.0;
  } else if (!doubted && navigator.alignment().hold_since_ns != 0) {
    out.time_to_aligned_s = std::max(unheard, config.aligned_hold_s - held);
  }
}

/// Before that: what is missing from a start.
void fill_waiting(const Navigator& navigator, const AlignmentConfig& config, const StartConditions& c,
                  AlignmentStatus& out) {
  const RestWindow& window = navigator.starter().window();
  const double held = window.duration_s();
  const auto rest_condition = [&](const char* name, double value, double limit, bool met) {
    add_condition(out, name, value, limit, met, held, config.averaging_s);
  };
  rest_condition("rate_spread_rad_s", window.rate_spread_rad_s(), config.rate_spread_rad_s,
                 window.rate_spread_rad_s() <= config.rate_spread_rad_s);
  rest_condition("force_spread_m_s2", window.force_spread_m_s2(), config.force_spread_m_s2,
                 window.force_spread_m_s2() <= config.force_spread_m_s2);
  rest_condition("gps_speed_m_s", navigator.starter().gps_speed_m_s(), config.max_speed_m_s, c.slow);
  add_condition(out, "heading_known", c.heading ? 1.0 : 0.0, 1.0, c.heading);
  // Either serves.
  if (heads_by_acceleration(config)) {
    const double sigma_rad = navigator.acceleration_heading_sigma_rad();
    add_condition(out, "acceleration_heading_sigma_rad", sigma_rad, kCoarsestByAcceleration_rad,
                  c.heading || sigma_rad <= kCoarsestByAcceleration_rad);
  } else {
    const double course = navigator.course_sigma_rad();
    add_condition(out, "course_sigma_rad", course, kCoarsestHeading_rad,
                  c.heading || course <= kCoarsestHeading_rad);
  }
  add_condition(out, "position_known", c.position ? 1.0 : 0.0, 1.0, c.position);
  if (c.quiet && c.slow && c.heading && c.position)
    out.time_to_aligned_s =
        std::max(navigator.unheard_s(), std::max(0.0, config.averaging_s - held) + config.aligned_hold_s);
}

/// Returns whose noise is the largest multiple of what is said of it; a factor of 1: all do as is said.
NoiseFactor add_noise_factors(const EngineConfig& config, const Navigator& navigator, AlignmentStatus& out) {
  NoiseFactor worst;
  const auto add = [&](std::string_view whose, double factor, double most) {
    if (!(factor > 1.0)) return;
    add_condition(out, name_of(kNoiseFactorPrefix, whose).data(), factor, most, true);
    if (factor > worst.factor) worst = {whose, factor};
  };
  for (int i = 0; i < static_cast<int>(config.sensors.size()); ++i) {
    const SensorConfig& sensor = config.sensors[static_cast<std::size_t>(i)];
    add(sensor.sensor, navigator.noise_factor(i), sensor.max_noise_factor);
  }
  static_assert(kInertialNoise.size() == MotionNoise::kKinds);  // in the order of these
  for (std::size_t kind = 0; kind < MotionNoise::kKinds; ++kind)
    add(kInertialNoise[kind], navigator.estimate().motion_noise.factor(kind), config.imu.max_noise_factor);
  return worst;
}

/// Returns the bias that is the largest multiple of what is said of it; without an axis: none is larger.
FoundBias add_found_biases(const Setup& setup, const Estimate& estimate, AlignmentStatus& out) {
  const ImuConfig& imu = setup.config.imu;
  FoundBias worst;
  for (std::size_t i = 0; i < kBiasAxes.size(); ++i) {
    if (!estimate.bias_prior.is_found(i)) continue;
    const bool gyro = i < 3;
    const auto state = static_cast<std::size_t>(estimate.bias_prior.state_of(i));
    const FoundBias one{kBiasAxes[i], estimate.state.x[state],
                        gyro ? imu.gyro_bias_sigma_rad_s : imu.accel_bias_sigma_m_s2};
    add_condition(out, name_of(kBiasPrefix, one.axis).data(), one.value, one.said_sigma, true);
    if (worst.axis.empty() || std::abs(one.value) * worst.said_sigma > std::abs(worst.value) * one.said_sigma)
      worst = one;
  }
  return worst;
}

void add_slow_errors(const Estimate& estimate, AlignmentStatus& out) {
  const auto add = [&](SourceKind kind, const SlowError& slow) {
    if (const auto grown = slow.grown())
      add_condition(out, name_of(kSlowErrorPrefix, to_string(kind)).data(), grown->sigma, grown->configured,
                    true);
  };
  add(SourceKind::gps, estimate.slow_gps);
  add(SourceKind::usbl, estimate.slow_usbl);
}

}  // namespace

void fill(const Setup& setup, const Navigator& navigator, AlignmentStatus& out) {
  const AlignmentConfig& config = setup.config.alignment;
  out.phase = navigator.alignment().phase;
  out.in_phase_s = to_seconds(navigator.now_ns() - navigator.alignment().phase_since_ns);
  out.condition_count = 0;
  const Vector3d sigma = navigator.rpy_sigma_rad();
  out.rpy_sigma_rad = geo::arr(sigma);
  out.time_to_aligned_s = kUnknown;
  if (navigator.descent().aligning()) {
    fill_drop(navigator.descent().alignment(), out);
    return;
  }
  const StartConditions c = navigator.conditions();
  if (navigator.navigating()) {
    fill_navigating(navigator, setup.config, sigma, out);
  } else if (!navigator.waits_for_state()) {
    fill_waiting(navigator, config, c, out);
  }
  const double start_rad = navigator.navigating() ? navigator.estimate().start_heading.found_rad() : 0.0;
  if (start_rad != 0.0) add_condition(out, kStartHeadingError.data(), start_rad, kUnknown, true);
  const PlausibilityFinding& implausible = navigator.implausible();
  if (implausible)
    add_condition(out, name_of(kImplausiblePrefix, to_string(implausible.kind)).data(), implausible.value,
                  kUnknown, false);
  const FoundBias biased =
      navigator.navigating() ? add_found_biases(setup, navigator.estimate(), out) : FoundBias{};
  const NoiseFactor noisy =
      navigator.navigating() ? add_noise_factors(setup.config, navigator, out) : NoiseFactor{};
  if (navigator.navigating()) add_slow_errors(navigator.estimate(), out);
  if (implausible) return write_sentence(implausible, setup.config.imu.nominal_rate_hz, out.advice);
  write(out.advice, "%s", advice(c, navigator, config, sigma));
  if (out.advice[0] == '\0' && start_rad != 0.0)
    write(out.advice,
          "The heading of the start was wrong by %.0f deg and was corrected: check the compass, or what was "
          "given.",
          start_rad * kDegPerRad);
  if (out.advice[0] == '\0' && !biased.axis.empty())
    write(out.advice, "The %s: check the unit or its sigma.", biased.text().data());
  if (out.advice[0] != '\0' || !(noisy.factor > 1.0)) return;
  const int length = static_cast<int>(noisy.sensor.size());
  if (is_inertial(noisy.sensor))
    write(out.advice,
          "The motion strays as if the noise of the %.*s were %.1f times what is configured, and counts as "
          "that: check the unit, how it is mounted, and the times of what aids it.",
          length, noisy.sensor.data(), noisy.factor);
  else
    write(out.advice,
          "The noise of %.*s is %.1f times what is configured and counts as that: check it or its sigma.",
          std::min(length, 31), noisy.sensor.data(), noisy.factor);
}

}  // namespace fathom::estimation
