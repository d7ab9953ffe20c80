// Whatever the file of a checkpoint holds: fusion starts, and does not meet it for ever.

#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "fusion/checkpoint/file.hpp"
#include "fusion/checkpoint/start.hpp"
#include "support/temporary_folder.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::fusion {
namespace {

namespace fs = std::filesystem;
using estimation::FusionEngine;
using test::SurveyRun;

class CheckpointStart : public ::testing::Test {
 protected:
  void SetUp() override {
    config.path = (folder.path() / "fusion.checkpoint").string();
    for (std::size_t i = 0; i < run.samples.size() * 9 / 10; ++i) test::feed(before, run.samples[i]);
    ASSERT_TRUE(before.save(archive));
    own = {"auv", "fusion", "0123456789abcdef", "0.1.0-89abcdef",
           before.nav_state().header.stamp_ns + kNsPerSecond};
  }
  /// With a right checksum, whatever the archive is.
  void write(const std::vector<std::byte>& held, const std::string& build = "0.1.0-89abcdef") {
    archive::CheckpointLabel label = own;
    label.stamp_ns -= kNsPerSecond;
    label.build = build;
    std::vector<std::byte> bytes;
    encode(label, held, bytes);
    ASSERT_EQ(replace_file(config.path, bytes, false), "");
  }
  [[nodiscard]] bool there(const char* ending = "") const { return fs::exists(config.path + ending); }
  Resumption start() {
    FusionEngine engine(SurveyRun::config());
    return resume(engine, config, own);
  }

  test::TemporaryFolder folder;
  config::CheckpointConfig config;
  const SurveyRun run{{.duration_s = 20.0}};
  FusionEngine before{SurveyRun::config()};
  std::vector<std::byte> archive;
  archive::CheckpointLabel own;
};

TEST_F(CheckpointStart, GoesOn) {
  EXPECT_EQ(start().how, "started afresh: checkpoint " + config.path + " is not there");
  write(archive);
  FusionEngine engine(SurveyRun::config());
  const Resumption found = resume(engine, config, own);
  EXPECT_TRUE(found.resumed);
  EXPECT_EQ(found.how, "resumed from a checkpoint 1.00 s old");
  EXPECT_EQ(engine.nav_state().header.sequence, before.nav_state().header.sequence);
  EXPECT_NEAR(engine.nav_state().latitude_rad, before.nav_state().latitude_rad, 1e-6);
}

TEST_F(CheckpointStart, OfAnotherBuildItGoesOnAndSaysSo) {
  write(archive, "0.2.0-01234567");
  EXPECT_EQ(start().how, "resumed from a checkpoint 1.00 s old, written by build 0.2.0-01234567");
}

TEST_F(CheckpointStart, WhatIsWrongIsSaidAndPutAside) {
  std::vector<std::byte> bad = archive;
  bad.resize(bad.size() - 1);
  write(bad);
  const Resumption found = start();
  EXPECT_FALSE(found.resumed);
  EXPECT_TRUE(found.refused);
  EXPECT_NE(found.how.find("holds no state of this engine: events"), std::string::npos) << found.how;
  EXPECT_NE(found.how.find("put aside as " + config.path + ".refused"), std::string::npos) << found.how;
  EXPECT_FALSE(there());
  EXPECT_TRUE(there(".refused"));
  EXPECT_EQ(start().how, "started afresh: checkpoint " + config.path + " is not there");
}

TEST_F(CheckpointStart, AThingThatIsNoFileIsPutAsideToo) {
  fs::create_directory(config.path);
  EXPECT_NE(start().how.find("is no regular file, put aside"), std::string::npos);
  EXPECT_FALSE(there());
}

TEST_F(CheckpointStart, AStateThatEndsTheProcessIsMetTwiceAtMost) {
  write(archive);
  EXPECT_TRUE(start().resumed);  // and ended before it wrote a new one
  EXPECT_FALSE(there());
  EXPECT_TRUE(start().resumed);
  EXPECT_FALSE(start().resumed);
  EXPECT_TRUE(there(".refused"));
}

TEST_F(CheckpointStart, WithANewCheckpointTheTrialIsOver) {
  write(archive);
  EXPECT_TRUE(start().resumed);
  EXPECT_TRUE(there(".tried"));
  forget_trial(config.path);
  write(archive);
  EXPECT_FALSE(there(".tried"));
  EXPECT_TRUE(start().resumed);
}

TEST_F(CheckpointStart, MutatedImagesWithARightChecksumEndNothing) {
  test::Normal random(3);
  int refused = 0;
  for (int trial = 0; trial < 108; ++trial) {
    SCOPED_TRACE(trial);
    std::vector<std::byte> bad = archive;
    for (int i = 0; i < 1 + trial % 6; ++i) {
      const auto at = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(bad.size() - 1)));
      bad[at] = static_cast<std::byte>(random.uniform(0.0, 255.9));
    }
    write(bad);
    FusionEngine engine(SurveyRun::config());
    const Resumption found = resume(engine, config, own);
    refused += found.refused ? 1 : 0;
    EXPECT_EQ(there(".refused"), found.refused);
    for (std::size_t i = run.samples.size() * 9 / 10; i < run.samples.size(); ++i)
      test::feed(engine, run.samples[i]);
    fs::remove(config.path + ".refused");
    forget_trial(config.path);
  }
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace fathom::fusion
