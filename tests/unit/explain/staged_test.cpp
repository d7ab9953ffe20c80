// Vehicles to which one thing is done, by seeds: the recording has to tell which.

#include <cmath>
#include <cstdlib>
#include <functional>

#include <gtest/gtest.h>

#include "cli/explain/read.hpp"
#include "config/scenario/scenario_config.hpp"
#include "explain/account.hpp"
#include "explain/explain.hpp"
#include "explain/sentence.hpp"
#include "geo/wgs84.hpp"
#include "sim/random.hpp"
#include "support/paths.hpp"
#include "support/sanitized.hpp"
#include "support/temporary_folder.hpp"
#include "unit/explain/stage.hpp"

namespace fathom::test {
namespace {

using explain::Finding;
using explain::Findings;
using explain::Kind;

sim::Scenario scenario(const std::string& name) {
  return config::load_scenario({source_dir() + "/deploy/config/scenarios/" + name + ".json", {}});
}

/// Nothing wrong with any instrument.
void cure(sim::Scenario& one) {
  one.sensors.of<GpsSample>().dropouts.clear();
  one.sensors.of<DvlSample>().dropouts.clear();
  one.sensors.of<DvlSample>().bottom_lost.clear();
  one.sensors.of<DvlSample>().outlier_probability = 0.0;
  one.sensors.of<UsblSample>().outlier_probability = 0.0;
  one.sensors.of<GpsSample>().outlier_probability = 0.0;
}

sim::Scenario survey() {
  sim::Scenario out = scenario("survey");
  cure(out);
  return out;
}

/// At the surface with GPS, turning every half minute.
sim::Scenario surface() {
  sim::Scenario out = survey();
  out.mission.resize(2);
  for (int i = 1; i < 12; ++i) {
    sim::MissionStep step;
    step.at_s = 28.0 + 30.0 * i;
    step.heading_rad = std::remainder(1.0472 + i * 1.5708, 6.28318530718);
    out.mission.push_back(step);
  }
  return out;
}

constexpr double kFault_s = 120.0;
constexpr std::uint64_t kSeeds = kSanitized ? 1 : 5;

struct Case {
  friend void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

  std::string name;
  Kind kind = Kind::lost;
  std::string subject;
  double duration_s = 240.0;
  std::function<sim::Scenario()> scenario;
  std::function<void(Stage&)> set_up;
  /// What the services are told of the vehicle, where that is another one.
  std::function<sim::Scenario()> configured = {};
  [[nodiscard]] bool at_fault() const {
    return kind != Kind::wrong_lever && kind != Kind::not_aligned && kind != Kind::outliers &&
           !name.ends_with("always");
  }
};

template <class T>
auto spoil(std::function<bool(T&, double)> what) {
  return [what](AnySample& sample, double t_s) {
    T* one = std::get_if<T>(&sample);
    return one == nullptr || what(*one, t_s);
  };
}

void aside(GpsSample& fix, double north_m, double east_m) {
  fix.latitude_rad += north_m / geo::kSemiMajorAxis_m;
  fix.longitude_rad += east_m / (geo::kSemiMajorAxis_m * std::cos(fix.latitude_rad));
}

const std::string kGone = "serial /dev/ttyS0: No such file or directory";

/// The port of the inertial unit goes, for good; its bridge stays and says so.
void unplug_imu(Stage& stage) {
  stage.spoil = spoil<ImuSample>([](ImuSample&, double t) { return t < kFault_s; });
  stage.at(kFault_s + 1.0, [&stage] { stage.let_say("imu_bridge", "imu: " + kGone); });
}

std::vector<Case> cases() {
  std::vector<Case> out;
  out.push_back({"frozen_gps", Kind::frozen, "gps", 240, surface, [](Stage& stage) {
                   stage.spoil = spoil<GpsSample>([held = GpsSample{}](GpsSample& fix, double t) mutable {
                     if (t < kFault_s) held = fix;
                     if (t >= kFault_s && t < kFault_s + 40.0) {
                       const SampleHeader header = fix.header;
                       fix = held;
                       fix.header = header;
                     }
                     return true;
                   });
                 }});
  out.push_back({"gps_jump", Kind::jump, "gps", 240, surface, [](Stage& stage) {
                   stage.spoil = spoil<GpsSample>([](GpsSample& fix, double t) {
                     if (t >= kFault_s && t < kFault_s + 60.0) aside(fix, 120.0, 90.0);
                     return true;
                   });
                 }});
  out.push_back({"gps_drag", Kind::drag, "gps", 240, surface, [](Stage& stage) {
                   stage.spoil = spoil<GpsSample>([](GpsSample& fix, double t) {
                     if (t >= kFault_s) {
                       aside(fix, 1.0 * (t - kFault_s), 0.0);
                       fix.velocity_N_m_s[0] += 1.0;
                     }
                     return true;
                   });
                 }});
  out.push_back({"dvl_lost", Kind::lost, "dvl", 240,
                 [] {
                   sim::Scenario one = surface();
                   one.sensors.of<DvlSample>().dropouts = {{kFault_s, kFault_s + 40.0}};
                   return one;
                 },
                 [](Stage&) {}});
  out.push_back({"wrong_compass", Kind::wrong_heading, "heading", 240, surface, [](Stage& stage) {
                   stage.spoil = spoil<HeadingSample>([](HeadingSample& one, double t) {
                     if (t >= kFault_s) one.heading_rad = std::fmod(one.heading_rad + 0.44, 6.28318530718);
                     return true;
                   });
                 }});
  out.push_back({"wrong_compass_always", Kind::wrong_heading, "heading", 240, surface, [](Stage& stage) {
                   stage.spoil = spoil<HeadingSample>([](HeadingSample& one, double) {
                     one.heading_rad = std::fmod(one.heading_rad + 0.44, 6.28318530718);
                     return true;
                   });
                 }});
  out.push_back({"usbl_multipath", Kind::outliers, "usbl", 480,
                 [] {
                   sim::Scenario one = survey();
                   one.sensors.of<UsblSample>().outlier_probability = 0.3;
                   return one;
                 },
                 [](Stage&) {}});
  out.push_back({"noisy_dvl", Kind::noisy, "dvl", 200, surface, [](Stage& stage) {
                   stage.spoil = spoil<DvlSample>(
                       [random = sim::Random(1, "spoilt")](DvlSample& one, double t) mutable {
                         // Beams go with the velocity: without them it is what is left.
                         if (t < kFault_s) return true;
                         one.beam_velocity_m_s.fill(kUnknown);
                         for (double& v : one.velocity_D_m_s) v += random.normal(0.1);
                         return true;
                       });
                 }});
  out.push_back({"biased_gyro_always", Kind::biased, "gyro y", 200, surface, [](Stage& stage) {
                   stage.spoil = spoil<ImuSample>([](ImuSample& one, double) {
                     constexpr double kBias_rad_s = 5e-4;
                     one.angular_rate_B_rad_s[1] += kBias_rad_s;
                     one.delta_angle_B_rad[1] += kBias_rad_s * one.delta_time_s;
                     return true;
                   });
                 }});
  out.push_back({"noisy_gyros_always", Kind::noisy, "gyros", 400, surface, [](Stage& stage) {
                   stage.spoil =
                       spoil<ImuSample>([random = sim::Random(1, "spoilt")](ImuSample& one, double) mutable {
                         constexpr double kNoise_rad_sqrt_s = 3e-4;  // 1 deg/sqrt(h)
                         for (std::size_t i = 0; i < 3; ++i) {
                           const double angle_rad =
                               random.normal(kNoise_rad_sqrt_s * std::sqrt(one.delta_time_s));
                           one.delta_angle_B_rad[i] += angle_rad;
                           one.angular_rate_B_rad_s[i] += angle_rad / one.delta_time_s;
                         }
                         return true;
                       });
                 }});
  out.push_back({"late_imu", Kind::imu_late, "imu", 240, surface, [](Stage& stage) {
                   stage.spoil = spoil<ImuSample>([last_ns = TimeNs{0}](ImuSample& one, double t) mutable {
                     // A queue: nothing overtakes.
                     if (t >= kFault_s && t < kFault_s + 30.0) one.header.received_ns += kNsPerSecond / 2;
                     last_ns = one.header.received_ns = std::max(one.header.received_ns, last_ns);
                     return true;
                   });
                 }});
  out.push_back({"imu_unplugged", Kind::imu_gap, "imu", 160, surface, unplug_imu});
  out.push_back({"second_writer", Kind::second_writer, "gps", 240, surface, [](Stage& stage) {
                   stage.besides = [](const AnySample& sample, double t) {
                     std::vector<AnySample> more;
                     const auto* fix = std::get_if<GpsSample>(&sample);
                     if (fix == nullptr || t < kFault_s) return more;
                     GpsSample one = *fix;
                     aside(one, -60.0, 110.0);
                     one.header.stamp_ns += kNsPerSecond / 5;
                     one.header.received_ns += kNsPerSecond / 5;
                     more.emplace_back(one);
                     return more;
                   };
                 }});
  out.push_back({"restart", Kind::restart, "fusion", 240, surface, [](Stage& stage) {
                   stage.at(kFault_s, [&stage] { stage.kill_fusion(); });
                   stage.at(kFault_s + 2.3, [&stage] { stage.start_fusion(true); });
                 }});
  out.push_back({"restart_anew", Kind::restart, "fusion", 240, surface, [](Stage& stage) {
                   stage.at(kFault_s, [&stage] { stage.kill_fusion(); });
                   stage.at(kFault_s + 2.3, [&stage] { stage.start_fusion(false); });
                 }});
  out.push_back({"takeover", Kind::takeover, "fusion_b", 240, surface, [](Stage& stage) {
                   stage.add_standby();
                   stage.at(kFault_s, [&stage] { stage.take_over(); });
                 }});
  out.push_back({"bridge_died", Kind::stalled, "dvl_bridge", 200, surface,
                 [](Stage& stage) { stage.at(kFault_s, [&stage] { stage.kill_bridge("dvl_bridge"); }); }});
  out.push_back({"bridge_restarted", Kind::restart, "dvl_bridge", 200, surface, [](Stage& stage) {
                   stage.at(kFault_s, [&stage] { stage.kill_bridge("dvl_bridge"); });
                   stage.at(kFault_s + 12.0, [&stage] { stage.start_bridge("dvl_bridge"); });
                 }});
  // On a stand without a compass: nothing tells where north is.
  out.push_back({"not_aligned", Kind::not_aligned, "fusion", 180,
                 [] {
                   sim::Scenario one = surface();
                   one.mission.resize(1);
                   return one;
                 },
                 [](Stage& stage) {
                   stage.spoil = spoil<HeadingSample>([](HeadingSample&, double) { return false; });
                 }});
  out.push_back({"clock_set", Kind::clock_set, "vehicle", 240, surface,
                 [](Stage& stage) { stage.at(kFault_s, [&stage] { stage.set_clock(37.0); }); }});
  out.push_back({"clock_jump", Kind::clock_jump, "gps", 240, surface, [](Stage& stage) {
                   stage.spoil = spoil<GpsSample>([](GpsSample& one, double t) {
                     if (t >= kFault_s) one.header.stamp_ns -= 3 * kNsPerSecond;
                     return true;
                   });
                 }});
  out.push_back({"wrong_lever", Kind::wrong_lever, "gps", 300,
                 [] {
                   sim::Scenario one = surface();
                   one.sensors.of<GpsSample>().lever_B_m = {4.0, 0.0, -0.4};
                   return one;
                 },
                 [](Stage&) {}, surface});
  return out;
}

Findings explained(Stage& stage, double duration_s, explain::History& history) {
  const TemporaryFolder folder;
  const std::string file = folder / "staged.mcap";
  stage.run(duration_s, file);
  if (const char* keep = std::getenv("FATHOM_STAGED")) {
    std::filesystem::copy_file(file, keep, std::filesystem::copy_options::overwrite_existing);
  }
  auto reader = record::Reader::open(file);
  if (!reader) throw std::runtime_error(reader.error().message);
  const auto problems = cli::read_into(history, reader.value(), {});
  EXPECT_TRUE(problems.empty()) << problems.front();
  return explain::findings(history);
}

std::string told(const Findings& all, const explain::History& history) {
  std::string out;
  for (const Finding& one : all) {
    out += std::string(to_string(one.weight)) + " " + std::string(to_string(one.kind)) + " at " +
           explain::brief(to_seconds(one.begin_ns - Stage::kEpochNs)) + " s: " + explain::sentence(one) +
           (one.follows_from ? " <- " + std::to_string(*one.follows_from) : "") + "\n";
  }
  for (const auto& row : history.alarms())
    if (row.alarm.active) out += "   alarm " + row.alarm.alarm.str() + "\n";
  return out;
}

class Staged : public ::testing::TestWithParam<Case> {};

TEST_P(Staged, TheCauseIsNamedFirst) {
  const Case& one = GetParam();
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const sim::Scenario configured = one.configured ? one.configured() : one.scenario();
    Stage stage(one.scenario(), seed, &configured);
    one.set_up(stage);
    explain::History history;
    const Findings all = explained(stage, one.duration_s, history);
    SCOPED_TRACE(one.name + " seed " + std::to_string(seed) + "\n" + told(all, history));
    if (std::getenv("FATHOM_TELL"))
      std::printf("== %s %zu\n%s", one.name.c_str(), seed, told(all, history).c_str());
    if (all.empty()) {
      ADD_FAILURE() << "nothing was found";
      continue;
    }
    EXPECT_EQ(to_string(all.front().kind), to_string(one.kind));
    EXPECT_EQ(all.front().subject, one.subject);
    EXPECT_TRUE(explain::named(all.front()));
    // What was there from the beginning aside, it begins when it was done.
    const double begin_s = to_seconds(all.front().begin_ns - Stage::kEpochNs);
    if (one.at_fault()) {
      EXPECT_NEAR(begin_s, kFault_s, 5.0);
    }
    EXPECT_TRUE(explain::account(history, explain::answer(history, {})).starts_with("Most likely: "));
  }
}

INSTANTIATE_TEST_SUITE_P(All, Staged, ::testing::ValuesIn(cases()),
                         [](const auto& info) { return info.param.name; });

/// What is said of the one of a kind of a subject that begins near a time; nullptr: there is none.
const Finding* near(const Findings& all, Kind kind, const std::string& subject, double t_s) {
  for (const Finding& one : all)
    if (one.kind == kind && one.subject == subject &&
        std::abs(to_seconds(one.begin_ns - Stage::kEpochNs) - t_s) < 3.0)
      return &one;
  return nullptr;
}

/// The finding that led to the alarm of a name that was raised after a time.
const Finding* behind(const Findings& all, const explain::History& history, const std::string& alarm,
                      double after_s) {
  for (const explain::AlarmRow& row : history.alarms()) {
    if (!row.alarm.active || row.alarm.alarm.str() != alarm) continue;
    if (to_seconds(row.log_ns - Stage::kEpochNs) < after_s) continue;
    const auto cause = explain::behind(all, row);
    return cause ? &all[*cause] : nullptr;
  }
  ADD_FAILURE() << "no alarm " << alarm;
  return nullptr;
}

TEST(Silence, OfTheInertialUnitIsNoFaultOfTheClocksOfOthers) {
  Stage stage(surface(), 1);
  unplug_imu(stage);
  explain::History history;
  const Findings all = explained(stage, 160.0, history);
  SCOPED_TRACE(told(all, history));
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.front().said, "imu_bridge said: " + kGone);
  EXPECT_NE(explain::sentence(all.front()).find("fell silent at 22:15:2"), std::string::npos);
  EXPECT_NE(explain::sentence(all.front()).find("and stays so"), std::string::npos);
  std::size_t ahead = 0;
  for (const Finding& one : all) {
    if (one.kind != Kind::refused) continue;
    ++ahead;
    EXPECT_EQ(one.follows_from, 0U) << explain::sentence(one);
    EXPECT_EQ(explain::sentence(one).find("clocks"), std::string::npos);
    EXPECT_EQ(explain::advice(one), "");
  }
  EXPECT_GT(ahead, 0U);
  for (const char* alarm : {"sensor_missing:imu", "nav_state_missing", "service_unwell:imu_bridge"})
    EXPECT_EQ(behind(all, history, alarm, kFault_s), &all.front()) << alarm;
}

TEST(Silence, IsNotOfInstrumentsThatAFusionDidNotHear) {
  Stage stage(surface(), 1);
  stage.at(kFault_s, [&stage] { stage.kill_fusion(); });
  stage.at(kFault_s + 9.0, [&stage] { stage.start_fusion(true); });
  stage.at(kFault_s + 30.0, [&stage] { stage.kill_bridge("imu_bridge"); });
  stage.at(kFault_s + 45.0, [&stage] { stage.start_bridge("imu_bridge"); });
  explain::History history;
  const Findings all = explained(stage, 200.0, history);
  SCOPED_TRACE(told(all, history));
  for (const Finding& one : all)
    if (one.kind == Kind::lost) {
      EXPECT_NE(one.word, "silent") << explain::sentence(one);
    }
  // Each alarm is led to by what was under way when it began.
  const Finding* fusion = near(all, Kind::restart, "fusion", kFault_s);
  const Finding* bridge = near(all, Kind::restart, "imu_bridge", kFault_s + 30.0);
  ASSERT_NE(fusion, nullptr);
  ASSERT_NE(bridge, nullptr);
  EXPECT_EQ(behind(all, history, "nav_state_missing", kFault_s), fusion);
  EXPECT_EQ(behind(all, history, "service_missing:fusion", kFault_s), fusion);
  for (const char* alarm : {"nav_state_missing", "sensor_missing:imu", "service_missing:imu_bridge",
                            "refused:gps", "refused:dvl", "gps_outage"})
    EXPECT_EQ(behind(all, history, alarm, kFault_s + 30.0), bridge) << alarm;
}

TEST(Silence, ComesInSpellsOfTheirOwnReasons) {
  Stage stage(surface(), 1);
  stage.spoil = spoil<GpsSample>([](GpsSample& fix, double t) {
    if (t >= kFault_s && t < kFault_s + 16.0) fix.fix = GpsFix::none;
    const bool gone = t >= kFault_s + 30.0 && t < kFault_s + 46.0;
    return !gone && !(t >= kFault_s + 58.0 && t < kFault_s + 70.0);
  });
  const std::string garbage = "garbage: 4820 of the last 4820 bytes belong to no good frame";
  stage.at(kFault_s + 31.0, [&stage] { stage.let_say("gps_bridge", "gps: " + kGone); });
  stage.at(kFault_s + 46.0, [&stage] { stage.let_say("gps_bridge", ""); });
  stage.at(kFault_s + 60.0, [&] { stage.let_say("gps_bridge", "other: slow; gps: " + garbage + "; x: y"); });
  stage.at(kFault_s + 70.0, [&stage] { stage.let_say("gps_bridge", ""); });
  explain::History history;
  const Findings all = explained(stage, 220.0, history);
  SCOPED_TRACE(told(all, history));
  const Finding* blind = near(all, Kind::lost, "gps", kFault_s);
  const Finding* gone = near(all, Kind::lost, "gps", kFault_s + 30.0);
  const Finding* babble = near(all, Kind::lost, "gps", kFault_s + 58.0);
  ASSERT_TRUE(blind != nullptr && gone != nullptr && babble != nullptr);
  EXPECT_EQ(blind->word, "no_fix");
  EXPECT_EQ(blind->said, "");
  EXPECT_EQ(gone->said, "gps_bridge said: " + kGone);
  EXPECT_EQ(babble->said, "gps_bridge said: " + garbage);
  EXPECT_FALSE(blind->follows_from || gone->follows_from || babble->follows_from);
  EXPECT_NEAR(to_seconds(gone->end_ns - gone->begin_ns), 16.0, 2.0);
  EXPECT_EQ(behind(all, history, "sensor_missing:gps", kFault_s), gone);
  EXPECT_EQ(behind(all, history, "sensor_missing:gps", kFault_s + 55.0), babble);
}

class Quiet : public ::testing::TestWithParam<std::string> {};

TEST_P(Quiet, NothingIsNamed) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    sim::Scenario one = GetParam() == "surface" ? surface() : scenario(GetParam());
    cure(one);
    Stage stage(one, seed);
    explain::History history;
    const Findings all = explained(stage, one.duration_s, history);
    SCOPED_TRACE(GetParam() + " seed " + std::to_string(seed) + "\n" + told(all, history));
    if (std::getenv("FATHOM_TELL"))
      std::printf("== quiet %s %zu\n%s", GetParam().c_str(), seed, told(all, history).c_str());
    for (const Finding& finding : all) EXPECT_FALSE(explain::named(finding)) << explain::sentence(finding);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Quiet, ::testing::Values("survey", "surface", "flight"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace fathom::test
