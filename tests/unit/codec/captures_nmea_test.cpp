// NMEA 0183 recordings against the sentences that pynmeagps read from them.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "capture.hpp"
#include "support/data.hpp"

namespace fathom::codec::capture {
namespace {

using Json = nlohmann::json;

double number(const Json& sentence, const char* key) {
  const auto found = sentence.find(key);
  return found != sentence.end() && found->is_number() ? found->get<double>() : kUnknown;
}

std::string word(const Json& sentence, const char* key) {
  const auto found = sentence.find(key);
  return found != sentence.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// "hh:mm:ss[.ffffff]"
std::optional<DurationNs> time_of_day(const Json& sentence) {
  const std::string text = word(sentence, "time");
  if (text.size() < 8) return std::nullopt;
  const double s = std::stod(text.substr(6));
  return (std::stoll(text.substr(0, 2)) * 3600 + std::stoll(text.substr(3, 2)) * 60) * kNsPerSecond +
         std::llround(s * 1e9);
}

bool has_fix(const Json& sentence) {
  if (!known(number(sentence, "lat")) || !known(number(sentence, "lon"))) return false;
  const std::string type = word(sentence, "type");
  if (type == "GGA") return number(sentence, "quality") > 0;
  if (type == "RMC") return word(sentence, "status") == "A" && word(sentence, "posMode") != "N";
  const std::string modes = word(sentence, "posMode");
  return modes.find_first_not_of("N-") != std::string::npos;
}

std::optional<DurationNs> time_of_day(const Decoded& decoded) {
  constexpr DurationNs kDay = 86'400 * kNsPerSecond;
  if (decoded.time.utc_ns) return ((*decoded.time.utc_ns % kDay) + kDay) % kDay;
  return decoded.time.time_of_day_ns;
}

bool near(double expected, double got, double tolerance) {
  return !known(expected) || std::abs(expected - got) <= tolerance;
}

/// What disagrees between a sentence and the sample of its epoch; empty when nothing does.
std::string disagreement(const Json& e, const Decoded& decoded, const GpsSample& s, bool gives_position) {
  // Sentences of one epoch state the position to different digits; the one it was taken from must agree
  // to the last.
  const double tolerance = gives_position ? 2e-10 : 2e-4;
  if (!near(number(e, "lat"), s.latitude_rad * kDegPerRad, tolerance)) return "lat";
  if (!near(number(e, "lon"), s.longitude_rad * kDegPerRad, tolerance)) return "lon";
  const auto time = time_of_day(decoded);
  if (time_of_day(e) && (!time || std::abs(*time - *time_of_day(e)) > 1000)) return "time";
  if (gives_position && word(e, "type") != "RMC") {
    if (!near(number(e, "alt"), s.altitude_msl_m, 1e-9)) return "alt";
    const double height = number(e, "alt") + number(e, "sep");
    if (known(number(e, "sep")) && !near(height, s.altitude_m, 1e-9)) return "sep";
    if (!near(number(e, "HDOP"), s.hdop, 1e-9)) return "HDOP";
    if (!near(number(e, "numSV"), s.satellites, 0)) return "numSV";
  }
  if (word(e, "type") == "RMC") {
    const double speed = number(e, "spd") * 1852.0 / 3600.0;
    if (known(speed) && known(s.velocity_N_m_s[0]) &&
        !near(speed, std::hypot(s.velocity_N_m_s[0], s.velocity_N_m_s[1]), 1e-9)) {
      return "spd";
    }
    if (known(s.course_rad) && !near(number(e, "cog"), s.course_rad * kDegPerRad, 1e-9)) return "cog";
    const std::string date = word(e, "date");
    if (date.size() == 10 && decoded.time.utc_ns && to_iso8601(*decoded.time.utc_ns).substr(0, 10) != date) {
      return "date";
    }
  }
  return {};
}

/// In this file two receivers state the same second a hundred degrees of longitude apart.
bool two_receivers_apart(const std::filesystem::path& file, std::uint64_t offset) {
  return file.filename() == "pygpsdata-nmea4.log" && offset == 36;
}

class NmeaCaptures : public ::testing::TestWithParam<const char*> {};

TEST_P(NmeaCaptures, AgreeWithPynmeagps) {
  const auto folder = root() / GetParam();
  if (!std::filesystem::exists(folder)) FATHOM_DATA_IS_MISSING(folder << " is not there");
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const auto reference = entry.path().string() + ".pynmeagps.expected.json";
    if (!entry.is_regular_file() || !std::filesystem::exists(reference)) continue;
    SCOPED_TRACE(entry.path().string());
    ++files;
    std::ifstream in(reference);
    const Json expected = Json::parse(in);
    const Harvest run = decode("nmea0183", load(entry.path()));
    const auto gps = of_kind<GpsSample>(run);
    const auto headings = of_kind<HeadingSample>(run);
    std::size_t compared = 0;
    std::size_t mismatches = 0;
    const auto check = [&](const Json& e, const std::string& wrong) {
      ++compared;
      if (wrong.empty()) return;
      ++mismatches;
      ADD_FAILURE() << wrong << " at " << e.at("offset") << ": " << e.dump();
    };
    // A sentence that was refused for what it says is reported as such, at its offset.
    std::set<std::uint64_t> refused;
    for (const Rejected& rejected : run.rejected) refused.insert(rejected.offset);

    for (const Json& e : expected.at("decoded")) {
      const auto offset = e.at("offset").get<std::uint64_t>();
      const std::string type = word(e, "type");
      if (refused.contains(offset)) {
        std::printf("  refused at %llu: %s\n", static_cast<unsigned long long>(offset), e.dump().c_str());
        continue;
      }
      if (type == "HDT" || type == "HDM" || type == "HDG" || type == "THS") {
        const auto found = std::find_if(headings.begin(), headings.end(),
                                        [&](const auto& h) { return h.first.offset == offset; });
        if (found == headings.end()) {
          check(e, "no sample");
          continue;
        }
        const HeadingSample& s = found->second;
        double want = number(e, type == "HDG" ? "heading" : type == "HDM" ? "headingM" : "headingT");
        const double deviation = number(e, "MD");
        if (type == "HDG" && known(deviation)) want += word(e, "MDEW") == "W" ? -deviation : deviation;
        check(e, near(want, s.heading_rad * kDegPerRad, 1e-9) ? "" : "heading");
        continue;
      }
      if ((type != "GGA" && type != "RMC" && type != "GNS") || !has_fix(e)) continue;
      // The sample whose sentences enclose this one and whose time it has.
      std::string wrong = "no sample";
      for (const auto& [decoded, s] : gps) {
        if (offset < decoded.offset || offset >= decoded.offset + decoded.length) continue;
        if (s.fix == GpsFix::none) continue;
        const bool agrees_exactly = disagreement(e, decoded, s, true).empty();
        wrong = agrees_exactly ? "" : disagreement(e, decoded, s, false);
        if (wrong.empty()) break;
      }
      // A second receiver repeating the epoch adds nothing to the sample.
      if (wrong == "no sample" && std::any_of(gps.begin(), gps.end(), [&](const auto& g) {
            return disagreement(e, g.first, g.second, true).empty();
          })) {
        wrong.clear();
      }
      if (wrong == "lon" && two_receivers_apart(entry.path(), offset)) wrong.clear();
      check(e, wrong);
    }
    for (const Json& offset : expected.at("bad_checksum")) {
      const std::uint64_t at =
          offset.is_object() ? offset.at("offset").get<std::uint64_t>() : offset.get<std::uint64_t>();
      const bool found = std::any_of(run.rejected.begin(), run.rejected.end(), [&](const Rejected& r) {
        return r.offset <= at && at < r.offset + r.length;
      });
      EXPECT_TRUE(found) << "bad checksum at " << at;
      ++compared;
      mismatches += !found;
    }
    report(entry.path(), run, compared, mismatches);
  }
  EXPECT_GT(files, 0U);
}

INSTANTIATE_TEST_SUITE_P(Folders, NmeaCaptures,
                         ::testing::Values("nmea0183", "nmea0183/pynmeagps", "nmea0183_depth_heading"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '/', '_');
                           return name;
                         });

/// Each PASHR of the recording as text, the columns cut here.
TEST(AttitudeCaptures, AnInertialSystemOnTheRoadSaysItsHeadingAndHowGoodItIs) {
  const auto file = root() / "nmea0183_depth_heading/rst39.log";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("nmea_attitude", load(file));
  EXPECT_TRUE(run.rejected.empty());
  std::size_t count = 0;
  for (const std::string& line : lines(file)) {
    if (!line.starts_with("$PASHR,")) continue;
    const auto columns = split(line, ',');
    ASSERT_LT(count, run.samples.size());
    const auto& got = std::get<HeadingSample>(run.samples[count].sample);
    EXPECT_NEAR(got.heading_rad * kDegPerRad, std::stod(columns.at(2)), 1e-9) << line;
    EXPECT_NEAR(got.sigma_rad * kDegPerRad, std::stod(columns.at(9)), 1e-9) << line;
    EXPECT_EQ(got.north, North::true_north);
    EXPECT_NEAR(to_seconds(run.samples[count].time.time_of_day_ns.value_or(0)),
                (20 * 60 + 41) * 60 + std::stod(columns.at(1).substr(4)), 1e-6);
    ++count;
  }
  EXPECT_EQ(count, 100U);
  EXPECT_EQ(run.samples.size(), count);
  report(file, run, 3 * count, 0);
}

}  // namespace
}  // namespace fathom::codec::capture
