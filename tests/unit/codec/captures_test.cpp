// Every recording of the protocols that this build decodes, whole and in pieces: the same samples, offsets
// and totals, and totals that account for every byte.
#include <algorithm>

#include <gtest/gtest.h>

#include "capture.hpp"
#include "support/data.hpp"

namespace fathom::codec::capture {
namespace {

struct Folder {
  const char* name;
  std::vector<const char*> protocols;
};

const std::vector<Folder>& folders() {
  static const std::vector<Folder> all{{"nmea0183", {"nmea0183", "nmea_attitude", "ubx"}},
                                       {"nmea0183_depth_heading", {"nmea0183", "nmea_attitude"}},
                                       {"ubx", {"ubx", "nmea0183"}},
                                       {"pd0", {"pd0"}},
                                       {"waterlinked_json", {"waterlinked"}},
                                       {"vectornav", {"vectornav", "nmea0183"}},
                                       {"xsens", {"xsens", "vectornav"}},
                                       {"pressure", {"paroscientific", "nmea0183"}},
                                       {"usbl", {"psimssb", "psonlld", "nmea0183"}},
                                       {"pd6", {"pd6", "nmea0183"}},
                                       {"nortek_dvl", {"nortek"}},
                                       {"microstrain", {"microstrain", "vectornav"}}};
  return all;
}

/// Recordings, not what others decoded from them.
bool is_recording(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  const auto ends = [&](std::string_view end) { return name.ends_with(end); };
  return name != "SOURCE.txt" && !ends(".expected.json") && !ends("expected.json") && !ends(".csv") &&
         !ends(".csv.gz") && !ends(".chk") && !ends(".nc") && !ends(".yml") && !ends(".dolfyn.log") &&
         !ends(".receive_times.txt") && !ends("_B") && !ends("_Bt") && !ends("_Gt") && !ends("_P") &&
         !ends(".golden") && !ends(".md");
}

class Captures : public ::testing::TestWithParam<Folder> {};

TEST_P(Captures, DoNotDependOnHowTheyAreCutAndAccountForEveryByte) {
  const std::filesystem::path folder = root() / GetParam().name;
  if (!std::filesystem::exists(folder)) FATHOM_DATA_IS_MISSING(folder << " is not there");
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || !is_recording(entry.path())) continue;
    ++files;
    const ByteVector bytes = load(entry.path());
    for (const char* protocol : GetParam().protocols) {
      SCOPED_TRACE(entry.path().string() + " as " + protocol);
      const Harvest whole = decode(protocol, bytes);
      const auto expected = text(whole);
      EXPECT_EQ(text(decode(protocol, bytes, {Cut::Kind::bytes})), expected);
      for (const std::uint32_t seed : {1U, 2U, 3U}) {
        EXPECT_EQ(text(decode(protocol, bytes, {Cut::Kind::random, seed})), expected);
      }
      EXPECT_EQ(whole.totals.bytes, bytes.size());
      EXPECT_EQ(whole.totals.samples, whole.samples.size());
      EXPECT_EQ(whole.totals.rejected, whole.rejected.size());
      EXPECT_LE(whole.totals.skipped_bytes, whole.totals.bytes);
      for (const Decoded& decoded : whole.samples) {
        EXPECT_GT(decoded.length, 0U);
        EXPECT_LE(decoded.offset + decoded.length, bytes.size());
      }
      for (const Rejected& rejected : whole.rejected) {
        EXPECT_GT(rejected.length, 0U);
        EXPECT_LE(rejected.offset + rejected.length, bytes.size());
      }
    }
  }
  EXPECT_GT(files, 0U);
}

INSTANTIATE_TEST_SUITE_P(Folders, Captures, ::testing::ValuesIn(folders()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace fathom::codec::capture
