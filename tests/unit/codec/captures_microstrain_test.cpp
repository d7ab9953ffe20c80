// A MicroStrain recording against what the maker's own kit decodes from it.
#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <zlib.h>

#include "capture.hpp"
#include "support/data.hpp"

namespace fathom::codec::capture {
namespace {

std::vector<std::string> lines_of_gzip(const std::filesystem::path& file) {
  const gzFile in = gzopen(file.c_str(), "rb");
  if (in == nullptr) throw std::runtime_error(file.string() + ": cannot be read");
  std::vector<std::string> found;
  std::array<char, 512> buffer{};
  while (gzgets(in, buffer.data(), static_cast<int>(buffer.size())) != nullptr) {
    std::string line(buffer.data());
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
    found.push_back(std::move(line));
  }
  gzclose(in);
  return found;
}

struct PacketOfTheKit {
  std::string set;
  std::map<std::string, std::vector<std::string>> fields;  ///< by descriptor
};

/// packet,descriptor_set,field,name,ok,v0,v1,v2,valid_flags
std::map<long, PacketOfTheKit> decoded_by_the_kit(const std::filesystem::path& table) {
  std::map<long, PacketOfTheKit> packets;
  auto rows = lines_of_gzip(table);
  rows.erase(rows.begin());
  for (const std::string& row : rows) {
    const auto f = split(row, ',');
    PacketOfTheKit& packet = packets[std::stol(f.at(0))];
    packet.set = f.at(1);
    packet.fields[f.at(2)] = {f.begin() + 5, f.end()};
  }
  return packets;
}

TEST(MicroStrainCaptures, AgreeWithTheMakersKit) {
  const auto file = root() / "microstrain/mip_sdk/mip_data.bin";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  constexpr double kG = 9.80665;
  const Harvest run = decode("microstrain", load(file));
  const auto imu = of_kind<ImuSample>(run);
  std::size_t packets = 0;
  std::size_t compared = 0;
  std::size_t mismatches = 0;
  const auto kit = decoded_by_the_kit(root() / "microstrain/mip_sdk/mip_data.vendor_sdk_decoded.csv.gz");
  for (const auto& [number, packet] : kit) {
    if (packet.set != "80" || !packet.fields.contains("04") || !packet.fields.contains("05")) continue;
    ASSERT_LT(packets, imu.size());
    const auto& [decoded, s] = imu[packets++];
    const auto agree = [&](double expected, double got) {
      // Of single precision, and the nine digits that it is printed with.
      const bool agrees = std::abs(expected - got) <= 1e-8 * std::abs(expected);
      EXPECT_TRUE(agrees) << "packet " << number << ": " << expected << " and " << got;
      ++compared;
      mismatches += !agrees;
    };
    ASSERT_TRUE(decoded.time.clock_ns.has_value());
    const std::int64_t clock_ns = std::stoll(packet.fields.at("D5").at(0));
    EXPECT_EQ(*decoded.time.clock_ns, clock_ns);
    ++compared;
    mismatches += *decoded.time.clock_ns != clock_ns;
    for (std::size_t i = 0; i < 3; ++i) {
      agree(std::stod(packet.fields.at("04").at(i)), s.specific_force_B_m_s2[i] / kG);
      agree(std::stod(packet.fields.at("05").at(i)), s.angular_rate_B_rad_s[i]);
    }
    EXPECT_FALSE(decoded.time.utc_ns.has_value());
    EXPECT_FALSE(known(s.delta_time_s));  // it has no increments
  }
  EXPECT_EQ(packets, imu.size());
  EXPECT_EQ(packets, 4473U);
  EXPECT_EQ(run.totals.rejected, 0U);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
  EXPECT_EQ(run.totals.samples + run.totals.frames_ignored, 8384U);  // checksums of all packets hold
  EXPECT_EQ(compared, 7U * 4473U);
  report(file, run, compared, mismatches);
}

}  // namespace
}  // namespace fathom::codec::capture
