// A fusion that dies and is started again.

#include <chrono>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "base/clock.hpp"
#include "fusion_fixture.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

class FusionRestart : public FusionTest {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "fathom-restart-XXXXXX").string();
    folder = mkdtemp(pattern.data());
  }
  void TearDown() override {
    FusionTest::TearDown();
    fs::remove_all(folder);
  }
  /// The still vehicle's time runs faster than the clock, and no checkpoint may be from the future.
  [[nodiscard]] static TimeNs before_now_ns() { return SystemClock().utc_ns() - 600 * kNsPerSecond; }
  [[nodiscard]] std::string checkpoint() const { return (folder / "fusion.checkpoint").string(); }
  /// What it says of its start, once it says that it is healthy.
  std::string how_started() {
    std::string text;
    EXPECT_TRUE(wait_until(
        [&] {
          const auto status = ear->service();
          if (!status || status->pid != static_cast<std::uint32_t>(fusion->pid()) ||
              status->state != ServiceState::healthy) {
            vehicle->run(10);  // it is healthy while it is fed
            return false;
          }
          text = status->text;
          return true;
        },
        60.0));
    return text;
  }
  /// Under way until a checkpoint holds what it knows, then kill -9.
  void begin_and_kill(std::uint32_t domain) {
    start(domain, {"checkpoint.path=" + checkpoint(), "checkpoint.period_s=0.1", "checkpoint.max_age_s=3600"},
          before_now_ns());
    vehicle->run(400);
    ASSERT_TRUE(wait_until([&] { return ear->state_count() >= 400; }, 60.0));
    EXPECT_EQ(how_started(), "started afresh: checkpoint " + checkpoint() + " is not there");
    // One that was written from here on.
    const auto from = fs::file_time_type::clock::now();
    std::error_code error;
    ASSERT_TRUE(wait_until([&] { return fs::last_write_time(checkpoint(), error) > from && !error; }, 60.0));
    fusion->kill(SIGKILL);
    EXPECT_EQ(fusion->wait(), 128 + SIGKILL);
    ear = nullptr;
    ear = std::make_unique<FusionEar>(vehicle->participant());
  }

  fs::path folder;
};

TEST_F(FusionRestart, GoesOnFromItsCheckpointWithTheFirstInertialSample) {
  begin_and_kill(166);
  vehicle->run(100, false);  // a second of the vehicle that nobody saw
  launch();
  // The dead one may still count as a reader, and the vehicle's time must not run far ahead of a slow start:
  // it waits for the new one's life sign, and speaks until it is heard.
  ASSERT_TRUE(wait_until(
      [&] {
        const auto status = ear->service();
        return status && status->pid == static_cast<std::uint32_t>(fusion->pid());
      },
      60.0))
      << fusion->err();
  ASSERT_TRUE(wait_until(
      [&] {
        vehicle->run(5, false);
        return ear->state_count() > 0;
      },
      60.0))
      << fusion->err();
  const NavState first = ear->all_states().front();
  EXPECT_GT(first.mode, NavMode::aligning) << "it navigates at once";
  EXPECT_GE(first.alignment, AlignmentPhase::fine);
  EXPECT_LE(first.alignment, AlignmentPhase::aligned);
  const double sigma_m = std::sqrt(first.position_covariance_N_m2[0]);
  EXPECT_NEAR(first.latitude_rad, kStillLatitude_rad, (3.0 * sigma_m + 3.0) / 6.4e6);
  EXPECT_EQ(how_started().find("resumed from a checkpoint "), 0U) << how_started();
}

TEST_F(FusionRestart, StartsAfreshFromADamagedCheckpointAndSaysSo) {
  begin_and_kill(167);
  std::fstream file(checkpoint(), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(200);
  file.write("damage", 6);
  file.close();
  launch();
  EXPECT_EQ(how_started(), "started afresh: checkpoint " + checkpoint() +
                               " is damaged: its checksum is wrong, put aside as " + checkpoint() +
                               ".refused");
  EXPECT_TRUE(fs::exists(checkpoint() + ".refused"));
}

TEST_F(FusionRestart, ADiskThatTakesNothingStopsNoNavigation) {
  fs::create_symlink("/dev/full", checkpoint() + ".new");
  start(168, {"checkpoint.path=" + checkpoint(), "checkpoint.period_s=0.05"}, before_now_ns());
  vehicle->run(400);
  ASSERT_TRUE(wait_until([&] { return ear->state_count() >= 400; }, 60.0));
  EXPECT_TRUE(wait_until(
      [&] {
        vehicle->run(10);
        const auto status = ear->service();
        if (!status) return false;
        for (const auto& counter : status->counters) {
          if (counter.name == Name("checkpoints_failed") && counter.value > 0) return true;
        }
        return false;
      },
      60.0));
  // A disk that stays so.
  fs::create_directory(checkpoint() + ".new");
  EXPECT_TRUE(wait_until(
      [&] {
        vehicle->run(10);
        const auto status = ear->service();
        return status && status->state == ServiceState::degraded &&
               status->text.find("a restart would begin anew: checkpoint ") != std::string::npos;
      },
      60.0));
}

}  // namespace
}  // namespace fathom::test
