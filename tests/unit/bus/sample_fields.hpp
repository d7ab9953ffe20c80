#pragma once

// Every field of every sample, for tests that fill samples and compare them. The structured bindings do not
// compile any more when a sample gains or loses a field, so that no field is forgotten.

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "base/name.hpp"
#include "samples/actuator.hpp"
#include "samples/airspeed.hpp"
#include "samples/alignment_status.hpp"
#include "samples/command.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/forecast.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"
#include "samples/imu.hpp"
#include "samples/nav_detail.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/status/intake.hpp"
#include "samples/status/replication.hpp"
#include "samples/status/route.hpp"
#include "samples/truth.hpp"
#include "samples/usbl.hpp"
#include "samples/verdict.hpp"

namespace fathom::test {

template <class T, class U>
concept Is = std::is_same_v<std::remove_const_t<T>, U>;

void fields(Is<SampleHeader> auto& s, auto visit) {
  auto& [vehicle, sensor, stamp, received, sequence] = s;
  visit(vehicle, sensor, stamp, received, sequence);
}
void fields(Is<ImuSample> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f] = s;
  visit(header, a, b, c, d, e, f);
}
void fields(Is<DvlSample> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f, g, h, i, j, k, l, m] = s;
  visit(header, a, b, c, d, e, f, g, h, i, j, k, l, m);
}
void fields(Is<GpsSample> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f, g, h, i, j, k, l, m] = s;
  visit(header, a, b, c, d, e, f, g, h, i, j, k, l, m);
}
void fields(Is<DepthSample> auto& s, auto visit) {
  auto& [header, a, b, c, d] = s;
  visit(header, a, b, c, d);
}
void fields(Is<FixSample> auto& s, auto visit) {
  auto& [header, a, b, c, d, e] = s;
  visit(header, a, b, c, d, e);
}
void fields(Is<RangeSample> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f, g] = s;
  visit(header, a, b, c, d, e, f, g);
}
void fields(Is<AltimeterSample> auto& s, auto visit) {
  auto& [header, a, b, c, d] = s;
  visit(header, a, b, c, d);
}
void fields(Is<HeadingSample> auto& s, auto visit) {
  auto& [header, a, b, c, d, e] = s;
  visit(header, a, b, c, d, e);
}
void fields(Is<UsblSample> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = s;
  visit(header, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p);
}
void fields(Is<AirspeedSample> auto& s, auto visit) {
  auto& [header, a, b, c, d] = s;
  visit(header, a, b, c, d);
}
void fields(Is<PropulsionSample> auto& s, auto visit) {
  auto& [header, a] = s;
  visit(header, a);
}
void fields(Is<FinsSample> auto& s, auto visit) {
  auto& [header, a, b] = s;
  visit(header, a, b);
}
void fields(Is<NavState> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t] = s;
  visit(header, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, t);
}
void fields(Is<StateEstimate> auto& s, auto visit) {
  auto& [a, b, c] = s;
  visit(a, b, c);
}
void fields(Is<NavDetail> auto& s, auto visit) {
  auto& [header, a, count, states] = s;
  visit(header, a, count, states);
}
void fields(Is<Verdict> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f, g, h, i, j, k, l] = s;
  visit(header, a, b, c, d, e, f, g, h, i, j, k, l);
}
void fields(Is<AlignmentCondition> auto& s, auto visit) {
  auto& [a, b, c, d, e, f] = s;
  visit(a, b, c, d, e, f);
}
void fields(Is<AlignmentStatus> auto& s, auto visit) {
  auto& [header, a, b, count, conditions, c, d, advice] = s;
  visit(header, a, b, count, conditions, c, d, advice);
}
void fields(Is<ForecastLimit> auto& s, auto visit) {
  auto& [a, b, c, d, e, f] = s;
  visit(a, b, c, d, e, f);
}
void fields(Is<Forecast> auto& s, auto visit) {
  auto& [header, a, b, c, d, count, limits] = s;
  visit(header, a, b, c, d, count, limits);
}
void fields(Is<Truth> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f] = s;
  visit(header, a, b, c, d, e, f);
}
void fields(Is<Alarm> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f, g, h, i] = s;
  visit(header, a, b, c, d, e, f, g, h, i);
}
void fields(Is<WatchedItem> auto& s, auto visit) {
  auto& [a, b, c, d] = s;
  visit(a, b, c, d);
}
void fields(Is<MonitorStatus> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f, g, h, i, j, k, l, m, n, sensors, services, receivers] = s;
  visit(header, a, b, c, d, e, f, g, h, i, j, k, l, m, n, sensors, services, receivers);
}
void fields(Is<ReceiverOutage> auto& s, auto visit) {
  auto& [a, b, c, d, e, f, g, h] = s;
  visit(a, b, c, d, e, f, g, h);
}
void fields(Is<RouteWaypoint> auto& s, auto visit) {
  auto& [a, b, c, d, e] = s;
  visit(a, b, c, d, e);
}
void fields(Is<Route> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f, waypoints] = s;
  visit(header, a, b, c, d, e, f, waypoints);
}
void fields(Is<ServiceRate> auto& s, auto visit) {
  auto& [a, b] = s;
  visit(a, b);
}
void fields(Is<ServiceCounter> auto& s, auto visit) {
  auto& [a, b] = s;
  visit(a, b);
}
void fields(Is<ServiceStatus> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f, g, h, rates, counters] = s;
  visit(header, a, b, c, d, e, f, g, h, rates, counters);
}
void fields(Is<Command> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f, g, h] = s;
  visit(header, a, b, c, d, e, f, g, h);
}
void fields(Is<ReplicaStatus> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f, g] = s;
  visit(header, a, b, c, d, e, f, g);
}
void fields(Is<EngineStatePart> auto& s, auto visit) {
  auto& [header, a, b, c, d, e, f] = s;
  visit(header, a, b, c, d, e, f);
}

void fields(Is<IntakeEntry> auto& s, auto visit) {
  auto& [a, b, c, d, e, f, g] = s;
  visit(a, b, c, d, e, f, g);
}
void fields(Is<IntakeRecord> auto& s, auto visit) {
  auto& [header, a, b] = s;
  visit(header, a, b);
}

/// The last enumerator of each enumeration.
template <class E>
constexpr unsigned last_of();
template <>
constexpr unsigned last_of<DvlMode>() {
  return static_cast<unsigned>(DvlMode::water);
}
template <>
constexpr unsigned last_of<DvlFrame>() {
  return static_cast<unsigned>(DvlFrame::earth);
}
template <>
constexpr unsigned last_of<GpsFix>() {
  return static_cast<unsigned>(GpsFix::rtk_fixed);
}
template <>
constexpr unsigned last_of<GpsJamming>() {
  return static_cast<unsigned>(GpsJamming::critical);
}
template <>
constexpr unsigned last_of<GpsSpoofing>() {
  return static_cast<unsigned>(GpsSpoofing::affirmed);
}
template <>
constexpr unsigned last_of<North>() {
  return static_cast<unsigned>(North::magnetic);
}
template <>
constexpr unsigned last_of<UsblFrame>() {
  return static_cast<unsigned>(UsblFrame::vehicle_frd);
}
template <>
constexpr unsigned last_of<NavMode>() {
  return static_cast<unsigned>(NavMode::inertial);
}
template <>
constexpr unsigned last_of<AlignmentPhase>() {
  return static_cast<unsigned>(AlignmentPhase::lost);
}
template <>
constexpr unsigned last_of<VerdictKind>() {
  return static_cast<unsigned>(VerdictKind::disputed);
}
template <>
constexpr unsigned last_of<SourceKind>() {
  return static_cast<unsigned>(kLastKind);
}
template <>
constexpr unsigned last_of<Severity>() {
  return static_cast<unsigned>(Severity::critical);
}
template <>
constexpr unsigned last_of<Presence>() {
  return static_cast<unsigned>(Presence::missing);
}
template <>
constexpr unsigned last_of<ServiceState>() {
  return static_cast<unsigned>(ServiceState::stopping);
}
template <>
constexpr unsigned last_of<CommandKind>() {
  return static_cast<unsigned>(CommandKind::mark_at_rest);
}
template <>
constexpr unsigned last_of<IntakeKind>() {
  return static_cast<unsigned>(IntakeKind::end);
}
template <>
constexpr unsigned last_of<ReplicaPhase>() {
  return static_cast<unsigned>(ReplicaPhase::in_step);
}

/// How many entries a sample's lists get.
enum class Lists { empty, one, full };

/// The bounds that the contract sets for lists held in vectors.
template <class T>
constexpr std::size_t bound_of() {
  if (std::is_same_v<T, RouteWaypoint>) return Route::kMostWaypoints;
  if (std::is_same_v<T, IntakeEntry>) return IntakeRecord::kMostEntries;
  return std::is_same_v<T, ServiceRate> || std::is_same_v<T, ReceiverOutage> ? 16 : 32;
}

/// Gives every field a value that no other field of the sample has.
class Filler {
 public:
  Filler(unsigned seed, Lists lists) : next_(seed), lists_(lists) {}

  void fill(auto& sample) {
    fields(sample, [this](auto&... field) { (value(field), ...); });
    set_count(sample);
  }

 private:
  void value(double& field) { field = ++next_ * 0.123456789e-3 - 1e6; }
  void value(bool& field) { field = (++next_ % 2) != 0; }
  void value(std::int64_t& field) { field = 1'700'000'000'000'000'000 + ++next_; }
  void value(std::uint64_t& field) { field = 0xF000'0000'0000'0000U + ++next_; }
  void value(std::uint32_t& field) { field = 0xF000'0000U + ++next_; }
  void value(std::int32_t& field) { field = -static_cast<std::int32_t>(++next_); }
  void value(Name& field) {
    field = Name("name-of-31-bytes-with-number-" + std::to_string(++next_ % 90 + 10));
  }
  void value(std::string& field) { field = "text with \xc3\xa4 " + std::to_string(++next_); }
  template <class E>
  requires std::is_enum_v<E>
  void value(E& field) { field = static_cast<E>(++next_ % (last_of<E>() + 1)); }
  template <std::size_t N>
  void value(std::array<double, N>& field) {
    for (double& element : field) value(element);
  }
  template <std::size_t N>
  void value(std::array<char, N>& field) {
    field.fill('\0');
    for (std::size_t i = 0; i + 1 < N; ++i) field[i] = static_cast<char>('a' + (++next_ % 26));
  }
  template <std::size_t N>
  void value(std::array<std::uint8_t, N>& field) {
    for (std::uint8_t& element : field) element = static_cast<std::uint8_t>(++next_ * 37U);
  }
  template <class T, std::size_t N>
  void value(std::array<T, N>& field) {
    count_ = lists_ == Lists::empty ? 0 : lists_ == Lists::one ? 1 : N;
    for (std::size_t i = 0; i < count_; ++i) fill(field[i]);
  }
  template <class T>
  void value(std::vector<T>& field) {
    field.resize(lists_ == Lists::empty ? 0 : lists_ == Lists::one ? 1 : bound_of<T>());
    for (T& element : field) fill(element);
  }
  void value(SampleHeader& field) { fill(field); }

  void set_count(auto& /*sample*/) {}
  void set_count(NavDetail& sample) { sample.count = static_cast<std::uint32_t>(count_); }
  void set_count(AlignmentStatus& sample) { sample.condition_count = static_cast<std::uint32_t>(count_); }
  void set_count(Forecast& sample) { sample.limit_count = static_cast<std::uint32_t>(count_); }

  unsigned next_;
  Lists lists_;
  std::size_t count_ = 0;
};

/// The sample as text, bit by bit: equal texts are equal samples, and NaN equals NaN.
class Dump {
 public:
  static std::string of(const auto& sample) {
    Dump dump;
    dump.value(sample);
    return dump.text_;
  }

 private:
  void value(double field) {
    text_ += field != field ? "nan " : std::to_string(std::bit_cast<std::uint64_t>(field)) + " ";
  }
  void value(const Name& field) { text_ += field.str() + " "; }
  void value(const std::string& field) { text_ += "'" + field + "' "; }
  template <class I>
  requires std::is_integral_v<I>
  void value(I field) { text_ += std::to_string(field) + " "; }
  template <class E>
  requires std::is_enum_v<E>
  void value(E field) { text_ += "e" + std::to_string(static_cast<unsigned>(field)) + " "; }
  template <class T, std::size_t N>
  void value(const std::array<T, N>& field) {
    for (const T& element : field) value(element);
  }
  template <class T>
  void value(const std::vector<T>& field) {
    text_ += "[";
    for (const T& element : field) value(element);
    text_ += "] ";
  }
  template <class S>
  requires std::is_class_v<S>
  void value(const S& sample) {
    fields(sample, [this](const auto&... field) { (value(field), ...); });
  }

  std::string text_;
};

}  // namespace fathom::test
