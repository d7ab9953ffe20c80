// A data set that is written takes away what an earlier one left, and says so.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solve_fixture.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;

class RemovedFiles : public SolveTest {
 protected:
  void SetUp() override {
    SolveTest::SetUp();
    fs::create_directory(folder / "out");
    for (const char* name : {"out/usbl.csv", "out/altimeter.csv.gz", "out/notes.csv", "out/nav.csv"})
      write(name, "what somebody has\n");
  }
  /// Runs it twice: the first time says what is removed, the second time there is nothing to say.
  void expect_said(const std::vector<std::string>& arguments) {
    ASSERT_EQ(run("fathom", arguments), 0) << err;
    EXPECT_EQ(
        err,
        "fathom: " + path("out") +
            ": altimeter.csv.gz, usbl.csv: removed, a data set is the whole folder and the new one has no "
            "such file\n");
    EXPECT_FALSE(fs::exists(folder / "out/usbl.csv"));
    EXPECT_FALSE(fs::exists(folder / "out/altimeter.csv.gz"));
    EXPECT_TRUE(fs::exists(folder / "out/imu.csv"));
    EXPECT_TRUE(fs::exists(folder / "out/notes.csv"));
    EXPECT_TRUE(fs::exists(folder / "out/nav.csv"));
    ASSERT_EQ(run("fathom", arguments), 0) << err;
    EXPECT_EQ(err, "");
  }
};

TEST_F(RemovedFiles, ExportSaysThem) {
  dataset::write(path("data"), StraightCourse(true).data);
  expect_said({"export", path("data"), "--format", "csv", "--out", path("out")});
}

TEST_F(RemovedFiles, SimulateSaysThem) {
  const std::vector<std::string> arguments{"simulate", "flight", "--duration", "1", "--out", path("out")};
  expect_said(arguments);
  // The other form of the same file goes, too.
  std::vector<std::string> zipped = arguments;
  zipped.emplace_back("--gzip");
  ASSERT_EQ(run("fathom", zipped), 0) << err;
  EXPECT_THAT(err, HasSubstr("imu.csv, "));
}

TEST_F(RemovedFiles, NothingIsRemovedForAnInputThatCannotBeRead) {
  EXPECT_EQ(run("fathom", {"export", path("nowhere"), "--format", "csv", "--out", path("out")}), 3);
  EXPECT_TRUE(fs::exists(folder / "out/usbl.csv"));
}

}  // namespace
}  // namespace fathom::test
