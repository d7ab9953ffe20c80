#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "support/orders.hpp"
#include "support/vehicles/survey_run.hpp"

namespace {
std::atomic<long> g_allocations{0};
}  // namespace

// Every way to the heap of this executable is counted. Not inlined: the compiler would see one half of a pair
// and warn.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
// The library's own ends in the above; AddressSanitizer's does not, and would miss its other half
// (stable_sort).
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++g_allocations;
  return std::malloc(size);
}
[[gnu::noinline]] void* operator new[](std::size_t size) {
  return operator new(size);
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  ++g_allocations;
  const auto step = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace fathom::estimation {
namespace {

TEST(Allocation, NoneAfterConstruction) {
  const test::SurveyRun run({.duration_s = 60.0, .dive_s = 40.0});
  FusionEngine engine(test::SurveyRun::config());
  NavDetail detail;
  AlignmentStatus alignment;
  Forecast forecast;
  Verdict verdict;
  const long before = g_allocations.load();
  std::size_t count = 0;
  for (const test::Sample& sample : run.samples) {
    test::feed(engine, sample);
    while (engine.next_verdict(verdict)) ++count;
    if (count % 500 == 0) {
      engine.fill(detail);
      engine.fill(alignment);
      engine.fill(forecast);
    }
  }
  Command command;
  command.kind = CommandKind::realign;
  EXPECT_EQ(test::order_now(engine, command), "");
  EXPECT_EQ(g_allocations.load() - before, 0);
  EXPECT_GT(count, 300U);
  // The counter counts.
  const auto* one = new int(1);
  EXPECT_EQ(g_allocations.load() - before, 1);
  delete one;
}

TEST(Allocation, NoneWithTheFullConfigurationAndEveryAiding) {
  const test::SurveyRun run({.duration_s = 50.0, .dive_s = 35.0});
  EngineConfig config = test::SurveyRun::config();
  ASSERT_TRUE(named_state_groups("full", config.groups));
  config.groups.log_scale = config.groups.airspeed_bias = true;
  SensorConfig log = default_sensor(SourceKind::propulsion, "propulsion0");
  log.scale_m_s_per_rpm = 0.002;
  config.sensors.push_back(log);
  config.sensors.push_back(default_sensor(SourceKind::airspeed, "air0"));
  config.sensors.push_back(default_sensor(SourceKind::dvl, "beams0"));
  config.sensors.push_back(default_sensor(SourceKind::fins, "fins0"));
  FusionEngine engine(config);
  const auto named = [](const char* sensor, TimeNs stamp_ns) {
    SampleHeader header;
    header.sensor = sensor;
    header.stamp_ns = stamp_ns;
    header.sequence = static_cast<std::uint64_t>(stamp_ns);
    return header;
  };
  NavDetail detail;
  Forecast forecast;
  Verdict verdict;
  std::array<std::size_t, kVerdictKinds> kinds{};
  std::array<bool, 16> sources{};
  std::size_t samples = 0;
  const long before = g_allocations.load();
  for (const test::Sample& sample : run.samples) {
    test::feed(engine, sample);
    if (std::holds_alternative<ImuSample>(sample) && ++samples % 100 == 0) {
      const NavState& nav = engine.nav_state();
      // Half a second late.
      const TimeNs stamp = nav.header.stamp_ns - kNsPerSecond / 2;
      const double speed =
          known(nav.velocity_N_m_s[0]) ? std::hypot(nav.velocity_N_m_s[0], nav.velocity_N_m_s[1]) : 0.0;
      PropulsionSample propulsion;
      propulsion.header = named("propulsion0", stamp);
      propulsion.rpm = speed / 0.002;
      engine.add(propulsion);
      AirspeedSample air;
      air.header = named("air0", stamp);
      air.airspeed_m_s = speed;
      engine.add(air);
      DvlSample beams;
      beams.header = named("beams0", stamp);
      beams.beam_velocity_m_s = {0.5 * speed, -0.5 * speed, 0.0, kUnknown};
      beams.beam_angle_rad = 0.5236;
      engine.add(beams);
      FinsSample fins;
      fins.header = named("fins0", stamp);
      fins.rudder_rad = fins.stern_rad = 0.0;
      engine.add(fins);
      engine.fill(detail);
      engine.fill(forecast);
    }
    while (engine.next_verdict(verdict)) {
      ++kinds[static_cast<std::size_t>(verdict.kind)];
      sources[static_cast<std::size_t>(verdict.source)] = true;
    }
  }
  engine.finish();
  EXPECT_EQ(g_allocations.load() - before, 0);
  EXPECT_GT(kinds[static_cast<std::size_t>(VerdictKind::used)], 500U);
  for (const SensorConfig& one : config.sensors)
    EXPECT_TRUE(sources[static_cast<std::size_t>(one.kind)]) << one.sensor;
}

}  // namespace
}  // namespace fathom::estimation
