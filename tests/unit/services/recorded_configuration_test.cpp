// A mistake in a configuration that a recording encloses is said to be in the recording, and one of the
// command line to be there: never in the file that it was put in for reading.
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "blackbox/enclosures.hpp"
#include "cli/recording.hpp"
#include "config/json/error.hpp"
#include "record/file.hpp"
#include "record/writer.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

void attach(record::Writer& writer, const std::string& name, const std::string& text) {
  record::Attachment out;
  out.name = "services/fusion/" + name;
  out.media_type = "application/json";
  out.data = {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
  ASSERT_EQ(writer.attach(out), "");
}

/// What is said of a recording that encloses this configuration, with an override.
std::string complaint(const std::string& configuration, const std::vector<std::string>& sets) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "log.mcap";
  auto sink = record::FileSink::create(file);
  EXPECT_TRUE(sink);
  record::Writer writer(std::move(sink.value()), {});
  EXPECT_EQ(writer.begin(), "");
  attach(writer, "command.json", blackbox::to_json({"fathom-fusion", "/", {"--config", "/fusion.json"}}));
  attach(writer, "config.json", configuration);
  EXPECT_EQ(writer.finish(), "");
  record::Reader reader = open_recording(file);
  try {
    (void)recorded_configuration(reader, "log.mcap", "fusion", sets);
  } catch (const config::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(RecordedConfiguration, AMistakeIsNamedWhereItStands) {
  std::ifstream in(test::source_dir() + "/deploy/config/fusion.json");
  std::ostringstream good;
  good << in.rdbuf();
  EXPECT_EQ(complaint(good.str(), {}), "");
  EXPECT_THAT(complaint(good.str(), {"engine.nope=1"}),
              StartsWith("--set: engine.nope: is 1, expected no such key"));
  EXPECT_THAT(complaint("{\"vehicel\": 1}", {}),
              StartsWith("log.mcap: services/fusion/config.json: vehicel: is 1, expected no such key"));
  EXPECT_THAT(complaint("{\"vehicel\": 1, \"instanc\": 2}", {}),
              HasSubstr("\nlog.mcap: services/fusion/config.json: vehicel: is 1, expected no such key"));
  EXPECT_THAT(complaint("{", {}), StartsWith("log.mcap: services/fusion/config.json:1: is not JSON"));
}

}  // namespace
}  // namespace fathom::cli
