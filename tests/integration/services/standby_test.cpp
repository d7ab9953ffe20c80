// Two fusion services of one vehicle.

#include <cmath>

#include <gtest/gtest.h>

#include "fusion_fixture.hpp"
#include "samples/status/replication.hpp"

namespace fathom::test {
namespace {

constexpr double kPatienceS = 60.0;

class Standby : public FusionTest {
 protected:
  /// The one that leads where both are well.
  void start_first(std::uint32_t domain, std::vector<std::string> sets = {}) {
    // Long enough that a busy machine is not taken for one on which nobody leads.
    sets.insert(sets.begin(), {"standby.enabled=true", "standby.listen_s=6", "ownership_strength=10"});
    start(domain, sets);
    accounts = std::make_unique<bus::Reader<ReplicaStatus>>(
        vehicle->participant(), [this](const ReplicaStatus& status, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex);
          heard[status.header.sensor.str()] = status;
        });
  }
  void start_second(const std::vector<std::string>& sets = {}) {
    second_arguments = arguments;
    std::vector<std::string> own{"instance=fusion_b", "ownership_strength=5"};
    own.insert(own.end(), sets.begin(), sets.end());
    for (const std::string& set : own) {
      second_arguments.insert(second_arguments.end(), {"--set", set});
    }
    second = std::make_unique<Process>("fathom-fusion", second_arguments);
  }
  void TearDown() override {
    FusionTest::TearDown();
    if (!second || !second->running()) return;
    second->kill(SIGTERM);
    EXPECT_EQ(second->wait(), 0) << second->err();
  }
  /// Instruments speak until it holds.
  bool under_way_until(const std::function<bool()>& condition) {
    return wait_until(
        [&] {
          if (condition()) return true;
          vehicle->run(4);
          return false;
        },
        kPatienceS);
  }
  [[nodiscard]] std::optional<ReplicaStatus> account(const std::string& instance) const {
    const std::lock_guard lock(mutex);
    const auto found = heard.find(instance);
    return found == heard.end() ? std::nullopt : std::optional(found->second);
  }
  [[nodiscard]] bool is(const std::string& instance, ReplicaPhase phase, bool leads) const {
    const auto status = account(instance);
    return status && status->phase == phase && status->leads == leads;
  }
  [[nodiscard]] bool hears(const char* instance) const {
    return ear->state_count() > 0 && ear->last_state().header.sensor == Name(instance);
  }
  /// One leads that has been under way for a while, the other one has caught up with it.
  void both_in_step(std::uint32_t domain) {
    start_first(domain);
    ASSERT_TRUE(under_way_until([&] {
      return ear->state_count() > 300 && is("fusion", ReplicaPhase::in_step, true);
    })) << fusion->err();
    start_second();
    ASSERT_TRUE(under_way_until([&] {
      return is("fusion_b", ReplicaPhase::in_step, false) && account("fusion_b")->caught_up > 0;
    })) << second->err();
  }

  mutable std::mutex mutex;
  std::map<std::string, ReplicaStatus> heard;
  std::unique_ptr<bus::Reader<ReplicaStatus>> accounts;
  std::vector<std::string> second_arguments;
  std::unique_ptr<Process> second;
};

TEST_F(Standby, TakesOverWithTheStateOfTheOneThatDied) {
  both_in_step(169);
  EXPECT_TRUE(hears("fusion"));
  vehicle->run(50);
  const int died = vehicle->ticks() / 20 * 20;
  fusion->kill(SIGKILL);
  EXPECT_EQ(fusion->wait(), 128 + SIGKILL);
  ASSERT_TRUE(under_way_until([&] { return hears("fusion_b"); })) << second->err();
  ASSERT_TRUE(under_way_until([&] { return is("fusion_b", ReplicaPhase::in_step, true); }));

  const auto states = ear->all_states();
  std::size_t first = 0;
  while (states[first].header.sensor != Name("fusion_b")) ++first;
  const NavState& before = states[first - 1];
  const NavState& after = states[first];
  EXPECT_GT(after.header.stamp_ns, before.header.stamp_ns);
  EXPECT_EQ(after.reset_counter, before.reset_counter);
  EXPECT_EQ(after.mode, before.mode);
  EXPECT_EQ(after.alignment, before.alignment);
  // The same numbering: of each inertial sample one state.
  EXPECT_EQ(static_cast<TimeNs>(after.header.sequence - before.header.sequence),
            (after.header.stamp_ns - before.header.stamp_ns) / kPeriod_ns);
  // It lies still: what one states and the other one goes on with is the same place.
  EXPECT_NEAR((after.latitude_rad - before.latitude_rad) * 6.371e6, 0.0, 0.01);

  // Each measurement is judged for good once, by the one or by the other. One may have been under way.
  vehicle->run(700);
  const auto finals = [&](int tick) {
    const TimeNs stamp_ns = kStart_ns + tick * kPeriod_ns;
    return std::pair(ear->finals(SourceKind::gps, stamp_ns), ear->finals(SourceKind::dvl, stamp_ns));
  };
  ASSERT_TRUE(wait_until([&] { return finals(died + 160).second > 0; }));
  int missing = 0;
  for (int tick = died - 700; tick <= died + 160; tick += 20) {
    const auto [gps, dvl] = finals(tick);
    EXPECT_LE(std::max(gps, dvl), 1) << tick - died << ear->told(kStart_ns + tick * kPeriod_ns);
    missing += (gps == 0 ? 1 : 0) + (dvl == 0 ? 1 : 0);
  }
  EXPECT_LE(missing, 1);
  EXPECT_EQ(finals(died + 20), std::pair(1, 1));

  // And back: the first one, started again, leads only when it knows what the other one knows.
  const std::size_t from = states.size();
  launch();
  ASSERT_TRUE(under_way_until([&] { return hears("fusion") && is("fusion", ReplicaPhase::in_step, true); }))
      << fusion->err();
  const auto later = ear->all_states();
  for (std::size_t i = from; i < later.size(); ++i) {
    EXPECT_GE(later[i].alignment, before.alignment) << "nobody heard it begin";
    EXPECT_GT(later[i].header.sequence, before.header.sequence) << "nor count anew";
  }
  EXPECT_TRUE(under_way_until([&] { return is("fusion_b", ReplicaPhase::in_step, false); }));
}

TEST_F(Standby, AForgedStateIsRefusedCountedAndInNobodysWay) {
  start_first(187);
  ASSERT_TRUE(under_way_until([&] {
    return ear->state_count() > 300 && is("fusion", ReplicaPhase::in_step, true);
  })) << fusion->err();
  // Somebody else on the network bears the leader's name and sends what is no state, all the time.
  bus::Participant stranger(presence(187, "stranger"));
  bus::Writer<EngineStatePart> forger(stranger);
  std::uint64_t refused = 0;
  bus::Reader<ServiceStatus> lives(vehicle->participant(),
                                   [&](const ServiceStatus& status, const bus::SampleInfo&) {
                                     if (status.header.sensor != Name("fusion_b")) return;
                                     const std::lock_guard lock(mutex);
                                     refused = std::max(refused, status.counter("state_refused"));
                                   });
  start_second();
  EngineStatePart part;
  part.header = vehicle->header("fusion");
  part.parts = 1;
  part.size = 5000;
  part.bytes.fill(0x7f);
  ASSERT_TRUE(under_way_until([&] {
    ++part.transfer;
    ++part.header.sequence;
    forger.write(part);
    const std::lock_guard lock(mutex);
    return refused > 0;
  })) << second->err();
  EXPECT_TRUE(under_way_until([&] {
    ++part.transfer;
    forger.write(part);
    return is("fusion_b", ReplicaPhase::in_step, false) && account("fusion_b")->caught_up > 0;
  })) << second->err();
  EXPECT_TRUE(second->says("another participant")) << second->err();
  EXPECT_TRUE(hears("fusion"));
}

TEST_F(Standby, SaysNothingWhileItsConfigurationIsAnother) {
  start_first(170);
  ASSERT_TRUE(under_way_until([&] { return ear->state_count() > 300; })) << fusion->err();
  start_second({"engine.imu.mounting_rpy_deg=[0,0,90]"});
  ASSERT_TRUE(under_way_until([&] {
    return second->err().find("the state of fusion is of configuration") != std::string::npos;
  })) << second->err();
  EXPECT_TRUE(under_way_until([&] { return is("fusion_b", ReplicaPhase::behind, false); }));
  EXPECT_TRUE(hears("fusion"));
  // Alone it navigates as well as it can: that is better than nothing.
  fusion->kill(SIGKILL);
  EXPECT_EQ(fusion->wait(), 128 + SIGKILL);
  EXPECT_TRUE(under_way_until([&] { return hears("fusion_b"); })) << second->err();
  EXPECT_TRUE(under_way_until([&] {
    const auto status = account("fusion_b");
    return status && status->unprepared > 0;
  }));
  fusion = std::move(second);
}

}  // namespace
}  // namespace fathom::test
