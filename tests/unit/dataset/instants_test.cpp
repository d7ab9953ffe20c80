#include "dataset/instants.hpp"

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "dataset/dataset.hpp"
#include "geo/so3.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::dataset {
namespace {

NavState state(double t_s, const Eigen::Vector3d& rotation, double latitude_rad, double longitude_rad) {
  NavState out;
  out.header.stamp_ns = from_seconds(t_s);
  out.latitude_rad = latitude_rad;
  out.longitude_rad = longitude_rad;
  out.altitude_m = 10.0 * t_s;
  out.velocity_N_m_s = {t_s, -t_s, 1.0};
  const geo::Quaternion q = geo::exp(rotation);
  out.q_NB = {q.w, q.x, q.y, q.z};
  out.rpy_rad = geo::arr(geo::to_rpy(q));
  out.position_covariance_N_m2.fill(0.0);
  for (const std::size_t i : {0U, 4U, 8U}) out.position_covariance_N_m2[i] = 1.0 + t_s;
  out.gps_outage_s = t_s;
  out.mode = NavMode::gps_aided;
  return out;
}

double turn_rad(const NavState& a, const NavState& b) {
  const geo::Quaternion p{a.q_NB[0], a.q_NB[1], a.q_NB[2], a.q_NB[3]};
  const geo::Quaternion q{b.q_NB[0], b.q_NB[1], b.q_NB[2], b.q_NB[3]};
  return geo::log(geo::conjugate(p) * q).norm();
}

TEST(Between, IsOnTheStraightLineAndOnTheShortestTurn) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d from(3.0 * any(random), any(random), any(random));
    const NavState a = state(0.0, from, 0.5, 3.1);
    const NavState b = state(1.0, from + Eigen::Vector3d(any(random), any(random), any(random)), 0.6, -3.1);
    const double share = 0.5 + 0.5 * any(random);
    const NavState c = between(a, b, from_seconds(share));
    EXPECT_NEAR(c.latitude_rad, 0.5 + 0.1 * share, 1e-9);
    EXPECT_NEAR(c.altitude_m, 10.0 * share, 1e-7);
    // Over the date line the short way.
    const double way = std::remainder(c.longitude_rad - 3.1, 2.0 * std::numbers::pi);
    EXPECT_NEAR(way, share * (2.0 * std::numbers::pi - 6.2), 1e-9);
    EXPECT_LE(std::abs(c.longitude_rad), std::numbers::pi);
    EXPECT_NEAR(turn_rad(a, c), share * turn_rad(a, b), 1e-7);
    EXPECT_NEAR(turn_rad(c, b), (1.0 - share) * turn_rad(a, b), 1e-7);
    // A sigma is one that the filter gave, of the nearer state.
    EXPECT_EQ(c.position_covariance_N_m2[0], share < 0.5 ? 1.0 : 2.0);
    EXPECT_NEAR(c.gps_outage_s, share, 1e-7);
  }
}

TEST(Between, AtAStateIsThatState) {
  const NavState a = state(0.0, {0.1, 0.2, 3.0}, 0.5, 1.0);
  const NavState b = state(1.0, {0.2, 0.1, -3.0}, 0.6, 1.0);
  EXPECT_EQ(between(a, b, 0).q_NB, a.q_NB);
  EXPECT_EQ(between(a, b, from_seconds(1.0)).latitude_rad, b.latitude_rad);
}

TEST(AtInstants, GivesEachInstantOnceAndNamesThoseOutside) {
  std::vector<Instant> wanted;
  for (const double t_s : {0.5, 1.0, 1.25, 1.25, 2.0, 3.5, 7.0, 9.0, 9.5})
    wanted.push_back({from_seconds(t_s), wanted.size() + 1});
  AtInstants at(wanted);
  std::vector<TimeNs> given;
  // From 4 to 8 s there are no states.
  for (const double t_s : {1.0, 2.0, 3.0, 4.0, 8.0, 9.0})
    at.add(state(t_s, {0, 0, 0}, 0.5, 1.0),
           [&](const NavState& one) { given.push_back(one.header.stamp_ns); });
  const std::vector<TimeNs> expected{from_seconds(1.0), from_seconds(1.25), from_seconds(1.25),
                                     from_seconds(2.0), from_seconds(3.5),  from_seconds(9.0)};
  EXPECT_EQ(given, expected);
  std::vector<std::size_t> lines;
  for (const Instant& one : at.refused()) lines.push_back(one.line);
  EXPECT_EQ(lines, (std::vector<std::size_t>{1, 7, 9}));
}

TEST(ReadInstants, TakesAHeaderAndNamesTheLineThatIsWrong) {
  const test::TemporaryFolder folder;
  const auto file = [&](const std::string& text) {
    std::ofstream(folder.path() / "at.csv") << text;
    return folder.path() / "at.csv";
  };
  const auto read = read_instants(file("t_s\n1.5\r\n\n2\n"), 7);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].stamp_ns, 7 + 1'500'000'000);
  EXPECT_EQ(read[1].line, 4U);
  EXPECT_EQ(read_instants(file("\xEF\xBB\xBF"
                               "1.5\r\n2\r\n"),
                          0)
                .size(),
            2U);  // as spreadsheets write it
  const std::vector<std::pair<std::string, std::string>> bad{
      {"1\nx\n", "at.csv:2: 'x', expected one instant"},
      {"1\n2,3\n", "at.csv:2: '2,3'"},
      {"2\n1\n", "at.csv:2: 1 is earlier"},
      {"", "at.csv: no instants"},
      {"t_s\n", "at.csv: no instants"},
      {"1\nnan\n", "at.csv:2: 'nan'"},
      {"nan\n1\n", "at.csv:1: 'nan'"},
      {"1e300\n", "at.csv:1: '1e300'"},
      {"t_s\nt_s\n1\n", "at.csv:2: 't_s'"},
      {"1\n2" + std::string(1, '\0') + "\n", "at.csv:2: '2"},
      {"1\n" + std::string(5000, '0'), "at.csv: line 2 is longer than 4094 bytes"}};
  for (const auto& [text, message] : bad) {
    try {
      (void)read_instants(file(text), 0);
      FAIL() << text;
    } catch (const DatasetError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW((void)read_instants(folder.path() / "nothing", 0), DatasetError);
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THROW((void)read_instants(folder / "pipe", 0), DatasetError);
}

}  // namespace
}  // namespace fathom::dataset
