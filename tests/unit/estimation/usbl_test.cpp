#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "estimation/engine/fusion_engine.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::Normal;
using test::Sample;
using test::SurveyRun;

constexpr double kDive_s = 50.0;
constexpr double kDvlEnds_s = 90.0;

/// What the acoustic system gives.
enum class Kind { none, vessel_vector, vessel_polar, inverted_polar, inverted_vector, range_only };

const Vector3d kTransponder_B(0.3, -0.1, -0.2);

/// A ship that crosses over the survey at 3 m/s while it rolls, and what its transceiver says of the vehicle;
/// or a beacon on the bottom that the vehicle's own transceiver looks at. Two seconds late.
std::vector<Sample> acoustic(const SurveyRun& survey, Kind kind) {
  std::vector<Sample> out;
  Normal normal(77);
  const Truth& first = survey.truth.front();
  const geo::Geodetic start{first.latitude_rad, first.longitude_rad, SurveyRun::kSurfaceAltitude_m};
  const bool inverted = kind == Kind::inverted_polar || kind == Kind::inverted_vector;
  std::uint64_t sequence = 0;
  for (std::size_t k = 250; kind != Kind::none && k < survey.truth.size(); k += 300) {
    const Truth& truth = survey.truth[k];
    const double t = 0.01 * static_cast<double>(k);
    if (t < kDive_s) continue;
    const Vector3d moved = inverted ? Vector3d(40.0, 120.0, 60.0) : Vector3d(-250.0 + 2.0 * t, 100.0, 4.0);
    const geo::Geodetic station = geo::moved_by(start, moved);
    const Vector3d ship_rpy(0.1 * std::sin(0.7 * t), 0.04 * std::sin(0.5 * t), 0.0);
    const Matrix3d C_NB = geo::to_matrix(geo::from_rpy(geo::vec(truth.rpy_rad)));
    const Vector3d path_N =
        geo::difference_N(station, {truth.latitude_rad, truth.longitude_rad, truth.altitude_m}) +
        C_NB * kTransponder_B;
    const Vector3d path = inverted ? Vector3d(C_NB.transpose() * -path_N)
                                   : Vector3d(geo::to_matrix(geo::from_rpy(ship_rpy)).transpose() * path_N);
    UsblSample s;
    s.header.vehicle = "auv";
    s.header.sensor = "usbl0";
    s.header.stamp_ns = truth.header.stamp_ns;
    s.header.received_ns = s.header.stamp_ns + 2 * kNsPerSecond;
    s.header.sequence = ++sequence;
    s.frame = inverted ? UsblFrame::vehicle_frd : UsblFrame::vessel_frd;
    s.station_latitude_rad = station.latitude_rad;
    s.station_longitude_rad = station.longitude_rad;
    s.station_depth_m = moved.z();
    if (!inverted) s.station_rpy_rad = geo::arr(ship_rpy);
    if (kind == Kind::vessel_vector || kind == Kind::inverted_vector) {
      s.relative_m = geo::arr(path + normal.vector(1.0));
      s.sigma_m = 1.0;
    } else {
      s.range_m = path.norm() + normal(0.5);
      s.sigma_m = 0.5;
      const double depression = std::atan2(path.z(), std::hypot(path.x(), path.y()));
      if (kind != Kind::range_only) {
        s.bearing_rad =
            geo::wrap_two_pi(std::atan2(path.y(), path.x()) + normal(0.008) / std::cos(depression));
        s.depression_rad = depression + normal(0.008);
        s.sigma_rad = 0.008;
      }
    }
    out.emplace_back(s);
  }
  return out;
}

struct UsblOutcome {
  double horizontal_end_m = 0.0;
  double horizontal_max_m = 0.0;
  double sigma_end_m = 0.0;
  double worst_sigmas = 0.0;  ///< horizontal error over its own standard deviation
  std::map<VerdictKind, int> usbl;
  NavMode mode = NavMode::none;
};

UsblOutcome run(Kind kind) {
  const SurveyRun survey({.duration_s = 240.0, .dive_s = kDive_s, .seed = 3, .usbl = false});
  std::vector<Sample> samples = survey.samples;
  const std::vector<Sample> fixes = acoustic(survey, kind);
  samples.insert(samples.end(), fixes.begin(), fixes.end());
  std::stable_sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
    return test::header(a).received_ns < test::header(b).received_ns;
  });
  EngineConfig config = SurveyRun::config();
  EXPECT_TRUE(named_state_groups("full", config.groups));
  SensorConfig& usbl = config.sensors.back();
  usbl.sigma = {0.5, 0.5, 0.5};
  usbl.angle_sigma_rad = 0.008;
  usbl.lever_B_m = geo::arr(kTransponder_B);
  config.states.usbl_bias_sigma_m = 0.3;
  config.states.usbl_misalignment_sigma_rad = 0.002;
  FusionEngine engine(config);
  UsblOutcome out;
  std::size_t index = 0;
  Verdict verdict;
  for (const Sample& sample : samples) {
    const auto t = to_seconds(test::header(sample).stamp_ns - SurveyRun::kEpochNs);
    if (std::holds_alternative<DvlSample>(sample) && t > kDvlEnds_s) continue;
    test::feed(engine, sample);
    while (engine.next_verdict(verdict))
      if (verdict.source == SourceKind::usbl && is_news(verdict)) ++out.usbl[verdict.kind];
    if (!std::holds_alternative<ImuSample>(sample)) continue;
    const Truth& truth = survey.truth[index++];
    if (t < kDvlEnds_s) continue;
    const NavState& nav = engine.nav_state();
    const Vector3d e = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                                         {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
    const auto& p = nav.position_covariance_N_m2;
    out.horizontal_end_m = std::hypot(e.x(), e.y());
    out.horizontal_max_m = std::max(out.horizontal_max_m, out.horizontal_end_m);
    const double squared = (e.x() * e.x() * p[4] - 2.0 * e.x() * e.y() * p[1] + e.y() * e.y() * p[0]) /
                           (p[0] * p[4] - p[1] * p[3]);
    out.worst_sigmas = std::max(out.worst_sigmas, std::sqrt(squared));
    out.sigma_end_m = std::sqrt(p[0] + p[4]);
    out.mode = nav.mode;
  }
  return out;
}

TEST(RelativeUsbl, WithoutItTheVehicleDriftsOnceTheDopplerLogIsGone) {
  const UsblOutcome out = run(Kind::none);
  EXPECT_GT(out.horizontal_max_m, 15.0);
  EXPECT_GT(out.sigma_end_m, 25.0);
}

TEST(RelativeUsbl, AMovingShipBoundsTheDrift) {
  for (const Kind kind : {Kind::vessel_vector, Kind::vessel_polar}) {
    UsblOutcome out = run(kind);
    EXPECT_LT(out.horizontal_max_m, 3.5) << static_cast<int>(kind);
    EXPECT_LT(out.worst_sigmas, 4.5) << static_cast<int>(kind);
    EXPECT_GT(out.usbl[VerdictKind::used], 55) << static_cast<int>(kind);
    EXPECT_EQ(out.mode, NavMode::acoustic_aided);
  }
}

TEST(RelativeUsbl, ABeaconSeenFromTheVehicleBoundsTheDrift) {
  for (const Kind kind : {Kind::inverted_polar, Kind::inverted_vector}) {
    UsblOutcome out = run(kind);
    EXPECT_LT(out.horizontal_max_m, 3.5) << static_cast<int>(kind);
    EXPECT_LT(out.worst_sigmas, 4.5) << static_cast<int>(kind);
    EXPECT_GT(out.usbl[VerdictKind::used], 55) << static_cast<int>(kind);
  }
}

TEST(RelativeUsbl, RangeAloneBoundsWhatLiesAlongThePath) {
  // Across it there is drift as long as the bearing to the ship stays what it is, and the filter knows.
  UsblOutcome out = run(Kind::range_only);
  EXPECT_LT(out.sigma_end_m, 0.7 * run(Kind::none).sigma_end_m);
  EXPECT_LT(out.worst_sigmas, 4.5);
  EXPECT_GT(out.usbl[VerdictKind::used], 55);
}

}  // namespace
}  // namespace fathom::estimation
