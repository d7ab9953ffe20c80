#include "dataset/instants.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <string_view>

#include "base/disk/regular_file.hpp"
#include "dataset/dataset.hpp"
#include "geo/so3.hpp"

namespace fathom::dataset {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r,;";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

double straight(double a, double b, double share) {
  return a + share * (b - a);
}

geo::Quaternion quaternion(const std::array<double, 4>& q) {
  return {q[0], q[1], q[2], q[3]};
}

}  // namespace

std::vector<Instant> read_instants(const std::filesystem::path& path, TimeNs epoch_ns) {
  const auto fail = [&path](const std::string& wrong) {
    throw DatasetError(path.string() + ": " + wrong + ", expected a file with one instant a line");
  };
  if (!no_regular_file(path).empty()) fail("is not there or no file");
  std::ifstream file(path, std::ios::binary);
  if (!file) fail("cannot be read");
  std::vector<Instant> out;
  std::array<char, 4096> buffer{};
  bool first = true;
  for (std::size_t number = 1; file.getline(buffer.data(), buffer.size()) || file.gcount() > 0; ++number) {
    if (file.fail() && !file.eof()) fail("line " + std::to_string(number) + " is longer than 4094 bytes");
    const auto taken = static_cast<std::size_t>(file.gcount());
    std::string_view line(buffer.data(), file.eof() ? taken : taken - 1);  // without its end
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    const std::string_view word = trimmed(line);
    if (word.empty()) continue;
    double t_s = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), t_s);
    const bool good = error == std::errc() && end == word.data() + word.size() && std::abs(t_s) < 4e9;
    const bool header =
        first && !good && std::isalpha(static_cast<unsigned char>(word.front())) != 0 && !std::isnan(t_s);
    first = false;
    if (header) continue;
    const std::string place = path.string() + ":" + std::to_string(number) + ": ";
    if (!good) {
      throw DatasetError(place + "'" + std::string(word.substr(0, 40)) +
                         "', expected one instant in seconds of the data set");
    }
    const TimeNs stamp_ns = epoch_ns + from_seconds(t_s);
    if (!out.empty() && stamp_ns < out.back().stamp_ns)
      throw DatasetError(place + std::string(word) + " is earlier than the instant before");
    out.push_back({stamp_ns, number});
  }
  if (out.empty()) throw DatasetError(path.string() + ": no instants, expected one a line");
  return out;
}

NavState between(const NavState& a, const NavState& b, TimeNs stamp_ns) {
  if (stamp_ns == b.header.stamp_ns) return b;
  if (stamp_ns == a.header.stamp_ns) return a;
  const double share = static_cast<double>(stamp_ns - a.header.stamp_ns) /
                       static_cast<double>(b.header.stamp_ns - a.header.stamp_ns);
  const NavState& nearer = share < 0.5 ? a : b;
  NavState out = a;
  out.header.stamp_ns = stamp_ns;
  out.latitude_rad = straight(a.latitude_rad, b.latitude_rad, share);
  out.longitude_rad = std::remainder(
      a.longitude_rad + share * std::remainder(b.longitude_rad - a.longitude_rad, 2.0 * std::numbers::pi),
      2.0 * std::numbers::pi);
  out.altitude_m = straight(a.altitude_m, b.altitude_m, share);
  out.depth_m = straight(a.depth_m, b.depth_m, share);
  for (std::size_t i = 0; i < 3; ++i) {
    out.velocity_N_m_s[i] = straight(a.velocity_N_m_s[i], b.velocity_N_m_s[i], share);
    out.angular_rate_B_rad_s[i] = straight(a.angular_rate_B_rad_s[i], b.angular_rate_B_rad_s[i], share);
    out.specific_force_B_m_s2[i] = straight(a.specific_force_B_m_s2[i], b.specific_force_B_m_s2[i], share);
  }
  const geo::Quaternion from = quaternion(a.q_NB);
  const geo::Quaternion turned =
      geo::normalized(from * geo::exp(share * geo::log(geo::conjugate(from) * quaternion(b.q_NB))));
  out.q_NB = {turned.w, turned.x, turned.y, turned.z};
  out.rpy_rad = geo::arr(geo::to_rpy(turned));
  out.position_covariance_N_m2 = nearer.position_covariance_N_m2;
  out.velocity_covariance_N_m2_s2 = nearer.velocity_covariance_N_m2_s2;
  out.rpy_sigma_rad = nearer.rpy_sigma_rad;
  const double since_s = to_seconds(stamp_ns - a.header.stamp_ns);
  out.gps_outage_s = a.gps_outage_s + since_s;
  out.dvl_outage_s = a.dvl_outage_s + since_s;
  return out;
}

AtInstants::AtInstants(std::vector<Instant> instants, double longest_gap_s)
    : instants_(std::move(instants)), longest_gap_ns_(from_seconds(longest_gap_s)) {}

std::vector<Instant> AtInstants::refused() const {
  std::vector<Instant> out = refused_;
  out.insert(out.end(), instants_.begin() + static_cast<std::ptrdiff_t>(next_), instants_.end());
  return out;
}

std::optional<TimeNs> AtInstants::last_ns() const {
  return last_ ? std::optional<TimeNs>(last_->header.stamp_ns) : std::nullopt;
}

}  // namespace fathom::dataset
