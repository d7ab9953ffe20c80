// What instant a data set's second zero is, for fathom export.
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/iso8601.hpp"
#include "cli/command.hpp"
#include "cli/export/tracks.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::cli {
namespace {

class ExportEpoch : public ::testing::Test {
 protected:
  [[nodiscard]] std::string folder() const { return folder_.path().string(); }
  void write(const std::string& text) const { std::ofstream(folder_.path() / "import.json") << text; }
  /// The complaint about import.json; empty where there is none.
  [[nodiscard]] std::string complaint() const {
    try {
      (void)epoch_of(folder(), "");
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::bad_input);
      return failure.what();
    }
    return "";
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(ExportEpoch, IsWhatImportWroteUnlessSomebodyAsksForAnother) {
  EXPECT_EQ(epoch_of(folder(), ""), std::nullopt);
  write(R"({"utc_of_start": "2026-01-31T12:00:00Z"})");
  EXPECT_EQ(epoch_of(folder(), ""), from_iso8601("2026-01-31T12:00:00Z"));
  EXPECT_EQ(epoch_of(folder(), "2020-05-01T00:00:00Z"), from_iso8601("2020-05-01T00:00:00Z"));
  write(R"({"utc_of_start": null})");
  EXPECT_EQ(epoch_of(folder(), ""), std::nullopt);
}

TEST_F(ExportEpoch, AFileThatSaysNoneIsNamedWithWhatWasExpected) {
  const std::string file = folder() + "/import.json: ";
  write("something else\n");
  EXPECT_EQ(complaint(), file + "is no JSON object, expected what fathom import writes");
  write(R"({"utc_of_start": "noon"})");
  EXPECT_EQ(complaint(),
            file + "utc_of_start: is \"noon\", expected one like \"2026-01-31T12:00:00Z\", or --epoch");
}

TEST_F(ExportEpoch, APipeIsNotWaitedFor) {
  ASSERT_EQ(::mkfifo((folder() + "/import.json").c_str(), 0600), 0);
  EXPECT_EQ(complaint(), folder() + "/import.json: is a pipe, expected a regular file");
}

}  // namespace
}  // namespace fathom::cli
