// UBX recordings against the NAV-PVT messages that pyubx2 read from them.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "capture.hpp"
#include "support/data.hpp"

namespace fathom::codec::capture {
namespace {

using Json = nlohmann::json;

std::string disagreement(const Json& e, const Decoded& decoded, const GpsSample& s) {
  const auto integer = [&](const char* key) { return e.at(key).get<std::int64_t>(); };
  const bool resolved = integer("validDate") && integer("validTime") && integer("fullyResolved");
  if (decoded.time.utc_ns.has_value() != resolved) return "time validity";
  if (resolved) {
    CivilTime civil;
    civil.year = static_cast<int>(integer("year"));
    civil.month = static_cast<int>(integer("month"));
    civil.day = static_cast<int>(integer("day"));
    civil.hour = static_cast<int>(integer("hour"));
    civil.minute = static_cast<int>(integer("min"));
    civil.second = static_cast<int>(integer("second"));
    civil.nanosecond = integer("nano");
    if (from_civil(civil) != decoded.time.utc_ns) return "time";
  }
  if (s.satellites != integer("numSV")) return "numSV";
  const bool ok = integer("gnssFixOk") && !e.value("invalidLlh", 0);
  const std::int64_t type = integer("fixType");
  const std::int64_t carrier = integer("carrSoln");
  const GpsFix fix = !ok                   ? GpsFix::none
                     : type == 1           ? GpsFix::dead_reckoning
                     : type == 2           ? GpsFix::fix_2d
                     : type == 5           ? GpsFix::time_only
                     : type == 0           ? GpsFix::none
                     : carrier == 2        ? GpsFix::rtk_fixed
                     : carrier == 1        ? GpsFix::rtk_float
                     : integer("diffSoln") ? GpsFix::differential
                                           : GpsFix::fix_3d;
  if (s.fix != fix) return "fix";
  if (s.fix < GpsFix::dead_reckoning) return known(s.latitude_rad) ? "position without fix" : "";
  const auto near = [&](const char* key, double factor, double got) {
    return std::abs(e.at(key).get<double>() * factor - got) <= 1e-9;
  };
  if (!near("lat", 1.0, s.latitude_rad * kDegPerRad)) return "lat";
  if (!near("lon", 1.0, s.longitude_rad * kDegPerRad)) return "lon";
  if (!near("height", 1e-3, s.altitude_m)) return "height";
  if (!near("hMSL", 1e-3, s.altitude_msl_m)) return "hMSL";
  if (!near("velN", 1e-3, s.velocity_N_m_s[0])) return "velN";
  if (!near("velE", 1e-3, s.velocity_N_m_s[1])) return "velE";
  if (!near("velD", 1e-3, s.velocity_N_m_s[2])) return "velD";
  if (!near("vAcc", 1e-3, s.position_sigma_N_m[2])) return "vAcc";
  // Horizontal accuracy is of the plane, a sigma of one axis.
  if (!near("hAcc", 1e-3, std::hypot(s.position_sigma_N_m[0], s.position_sigma_N_m[1]))) return "hAcc";
  if (!near("sAcc", 1e-3, s.velocity_sigma_N_m_s[0])) return "sAcc";
  return {};
}

TEST(UbxCaptures, AgreeWithPyubx2) {
  const auto folder = root() / "ubx";
  if (!std::filesystem::exists(folder)) FATHOM_DATA_IS_MISSING(folder << " is not there");
  std::size_t total = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const auto reference = entry.path().string() + ".nav_pvt.expected.json";
    if (!std::filesystem::exists(reference)) continue;
    SCOPED_TRACE(entry.path().string());
    std::ifstream in(reference);
    const Json expected = Json::parse(in);
    const Harvest run = decode("ubx", load(entry.path()));
    const auto gps = of_kind<GpsSample>(run);
    ASSERT_EQ(gps.size(), expected.size());
    std::size_t mismatches = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const std::string wrong = disagreement(expected[i], gps[i].first, gps[i].second);
      EXPECT_EQ(wrong, "") << "message " << i << ": " << expected[i].dump();
      mismatches += !wrong.empty();
    }
    report(entry.path(), run, expected.size(), mismatches);
    total += expected.size();
  }
  EXPECT_GT(total, 0U);
}

}  // namespace
}  // namespace fathom::codec::capture
