#include "commission/fit/joint_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/median.hpp"
#include "base/units.hpp"
#include "commission/fit/joint_filter.hpp"
#include "commission/fit/latency.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::commission {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using I = JointIndex;

constexpr int kPasses = 5;
constexpr double kUnderWay_m_s = 0.7;
constexpr double kBefore_s = 10.0;
constexpr double kImuGap_s = 0.5;               // of the inertial unit
constexpr double kRowsApart_s = 0.09;           // of two rows that are used
constexpr double kSmooth_s = 0.05;              // to both sides of an instant
constexpr double kOvertakes_s = 1000;           // the wandering of a bias overtakes white noise here
constexpr std::size_t kSharedInnovations = 20;  // innovations that may have something in common
constexpr double kNotMeasured_m_s = 1e3;        // sigma of what a receiver does not give
constexpr double kMostStretch = 2.5;
constexpr double kWellBelow = 0.4549;  // median of the square of a normal number
// No figure is surer than this: axes of an inertial unit are not square, samples are not instants.
constexpr double kLeastTurn_rad = 0.02 * kRadPerDeg;
constexpr double kLeastLever_m = 0.003;

// Means of the inertial samples about an instant.
class Smooth {
 public:
  Smooth(const ImuSeries& imu, const std::vector<Vector3d>& values) : t_s_(imu.t_s) {
    sum_.reserve(values.size());
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i > 0) sum += values[i] * std::min(kImuGap_s, t_s_[i] - t_s_[i - 1]);
      sum_.push_back(sum);
    }
  }
  [[nodiscard]] Vector3d mean(double from_s, double to_s) const {
    return (at(to_s) - at(from_s)) / (to_s - from_s);
  }

 private:
  [[nodiscard]] Vector3d at(double t_s) const {
    const auto next = std::lower_bound(t_s_.begin() + 1, t_s_.end() - 1, t_s);
    const auto i = static_cast<std::size_t>(next - t_s_.begin());
    return sum_[i - 1] + (t_s - t_s_[i - 1]) / (t_s_[i] - t_s_[i - 1]) * (sum_[i] - sum_[i - 1]);
  }
  const std::vector<double>& t_s_;
  std::vector<Vector3d> sum_;
};

struct JointRow {
  double t_s;
  bool dvl;
  std::size_t index;
};

// Innovations of one instrument, over their expected sigmas.
struct Innovations {
  std::array<std::vector<double>, 3> of_axis;
  void add(const Vector3d& some, int axes = 3) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(axes); ++i)
      of_axis[i].push_back(some[static_cast<Eigen::Index>(i)]);
  }
  /// How much larger the noise is than was assumed, by axis.
  [[nodiscard]] Vector3d excess() const {
    Vector3d out = Vector3d::Ones();
    for (std::size_t i = 0; i < 3; ++i) {
      std::vector<double> squares;
      for (const double v : of_axis[i]) squares.push_back(v * v);
      if (squares.size() > 20)
        out[static_cast<Eigen::Index>(i)] = std::clamp(std::sqrt(median(squares) / kWellBelow), 0.1, 10.0);
    }
    return out;
  }
  /// Sigma of a mean of them over that of as many independent ones.
  [[nodiscard]] double stretch() const {
    double most = 1.0;
    for (const std::vector<double>& all : of_axis) {
      if (all.size() < 10 * kSharedInnovations) continue;
      std::vector<double> v;
      for (const double one : all) v.push_back(std::clamp(one, -4.0, 4.0));
      double power = 0.0;
      for (const double one : v) power += one * one;
      double sum = 1.0;
      for (std::size_t lag = 1; lag <= kSharedInnovations; ++lag) {
        double product = 0.0;
        for (std::size_t i = lag; i < v.size(); ++i) product += v[i] * v[i - lag];
        sum += 2.0 * product / power;
      }
      most = std::max(most, std::sqrt(std::max(sum, 1.0)));
    }
    return most;
  }
};

class Fit {
 public:
  Fit(const Series& series, const GpsVelocity& velocity_N, const JointStart& start)
      : series_(series), velocity_N_(velocity_N), start_(start) {
    for (std::size_t i = 0; i < series.imu.size(); ++i) {
      rate_.push_back(start.reading.rate * (series.imu.rate[i] - start.reading.rate_bias));
      force_.push_back(start.reading.force * series.imu.force[i]);
    }
    smooth_rate_.emplace(series.imu, rate_);
    smooth_force_.emplace(series.imu, force_);
    if (start.dvl.similarity.mirrored) mirror_(1, 1) = -1.0;
    gps_sigma_ = Vector3d(1.0, 1.0, 2.0) * start.gps_sigma_m_s;
    if (!velocity_N.has_down) gps_sigma_.z() = kNotMeasured_m_s;
    dvl_sigma_.setConstant(std::max(0.003, start.dvl.residual_m_s) / start.dvl.similarity.scale);
    first_ = 1;
    const double begin_s = std::max(velocity_N.t_s.front() - 0.5, under_way_s(velocity_N) - kBefore_s);
    while (first_ + 1 < series.imu.size() && series.imu.t_s[first_] < begin_s) ++first_;
  }

  JointFit run() {
    JointState state;
    state.gps_lever_B_m = start_.gps.lever_B_m;
    state.gps_latency_s = start_.gps.latency_s;
    state.C_BD = start_.dvl.similarity.C;
    state.dvl_scale = start_.dvl.similarity.scale;
    state.dvl_lever_B_m = start_.dvl.lever_B_m;
    state.dvl_latency_s = start_.dvl.latency_s;
    state.v_N = first_velocity();
    state.C_NB = back(start_.gps.attitude->C_NB, index_of(start_.gps.attitude->t_s), state.gyro);
    for (int pass = 0; pass < kPasses; ++pass) {
      if (!one_pass(state, pass + 1 == kPasses)) return {};
    }
    return result_;
  }

 private:
  /// When the vehicle gets under way. Before that a filter that knows no heading learns it from noise.
  [[nodiscard]] static double under_way_s(const VectorSeries& velocity_N) {
    const auto under_way = std::find_if(velocity_N.v.begin(), velocity_N.v.end(),
                                        [](const Vector3d& v) { return v.norm() > kUnderWay_m_s; });
    return under_way == velocity_N.v.end()
               ? velocity_N.t_s.front()
               : velocity_N.t_s[static_cast<std::size_t>(under_way - velocity_N.v.begin())];
  }

  [[nodiscard]] std::size_t index_of(double t_s) const {
    const auto& t = series_.imu.t_s;
    return static_cast<std::size_t>(std::min(std::lower_bound(t.begin(), t.end(), t_s) - t.begin(),
                                             static_cast<std::ptrdiff_t>(t.size() - 1)));
  }

  /// The attitude where the filter starts, from that at a sample.
  [[nodiscard]] Matrix3d back(const Matrix3d& C_NB, std::size_t at, const TriadErrors& gyro) const {
    const Vector3d earth = geo::earth_rate_N(series_.latitude_rad);
    Matrix3d C = C_NB;
    const auto step = [&](std::size_t i, double sign) {
      const double dt = sign * (series_.imu.t_s[i] - series_.imu.t_s[i - 1]);
      const Vector3d w = (Matrix3d::Identity() + gyro.matrix) * (rate_[i] - gyro.bias);
      C = geo::to_matrix(geo::exp(-dt * earth)) * C * geo::to_matrix(geo::exp(dt * w));
    };
    for (std::size_t i = at; i >= first_; --i) step(i, -1.0);
    for (std::size_t i = at + 1; i < first_; ++i) step(i, 1.0);
    return geo::to_matrix(geo::normalized(geo::from_matrix(C)));
  }

  [[nodiscard]] Vector3d first_velocity() const {
    const auto at =
        std::lower_bound(velocity_N_.t_s.begin(), velocity_N_.t_s.end() - 1, series_.imu.t_s[first_]);
    return velocity_N_.v[static_cast<std::size_t>(at - velocity_N_.t_s.begin())];
  }

  [[nodiscard]] std::vector<JointRow> rows(const JointState& state) const {
    std::vector<JointRow> out;
    const double from_s = series_.imu.t_s[first_] + 0.3;
    const double to_s = series_.imu.t_s.back() - 0.3;
    const auto add = [&](const VectorSeries& of, bool dvl, double latency_s) {
      double last = -1e9;
      for (std::size_t i = 0; i < of.size(); ++i) {
        const double t = of.t_s[i] - latency_s;
        if (t < from_s || t > to_s || t - last < kRowsApart_s) continue;
        out.push_back({t, dvl, i});
        last = t;
      }
    };
    add(velocity_N_, false, state.gps_latency_s);
    if (start_.with_dvl) add(series_.dvl, true, state.dvl_latency_s);
    std::stable_sort(out.begin(), out.end(),
                     [](const JointRow& a, const JointRow& b) { return a.t_s < b.t_s; });
    return out;
  }

  [[nodiscard]] JointFilter::Vector first_sigma(bool rough) const {
    JointFilter::Vector s;
    s.segment<3>(I::kAttitude) = Vector3d(1.0, 1.0, 5.0) * (rough ? 3.0 : 1.0) * kRadPerDeg;
    s.segment<3>(I::kVelocity).setConstant(1.0);
    s.segment<3>(I::kGyroBias).setConstant(start_.rate_bias_sigma);
    s.segment<3>(I::kForceBias).setConstant(0.2);
    s.segment<9>(I::kGyroMatrix).setConstant(1.5e-3);
    s.segment<6>(I::kForceMatrix).setConstant(1.5e-3);
    for (const int scale : {I::kGyroMatrix, I::kGyroMatrix + 4, I::kGyroMatrix + 8, I::kForceMatrix,
                            I::kForceMatrix + 2, I::kForceMatrix + 5})
      s[scale] = 3e-3;
    s.segment<3>(I::kGpsLever).setConstant(3.0);
    s[I::kGpsLatency] = 0.3;
    s.segment<3>(I::kDvlTurn).setConstant(5.0 * kRadPerDeg);
    s[I::kDvlScale] = 0.1;
    s.segment<3>(I::kDvlLever).setConstant(3.0);
    s[I::kDvlLatency] = 0.3;
    return s;
  }

  /// From the state's start to its end; the state then is that for the next pass.
  bool one_pass(JointState& state, bool last) {
    JointFilter::Noise noise{1.1 * start_.rate_noise, 1.1 * start_.force_noise, 0.0, 0.0};
    noise.rate_bias = std::sqrt(3.0) * noise.rate / kOvertakes_s;
    noise.force_bias = std::sqrt(3.0) * noise.force / kOvertakes_s;
    JointFilter filter(state, first_sigma(!last), noise, series_.latitude_rad);
    const std::vector<JointRow> all = rows(state);
    if (all.size() < 100) return false;
    Innovations of_gps;
    Innovations of_dvl;
    std::size_t next = 0;
    double sunk = 0.0;
    double recorded_s = -1e9;
    const ImuSeries& imu = series_.imu;
    result_ = {};
    for (std::size_t i = first_; i < imu.size(); ++i) {
      const double dt = imu.t_s[i] - imu.t_s[i - 1];
      if (dt > kImuGap_s) filter.lost();
      filter.propagate(rate_[i], force_[i], std::min(dt, kImuGap_s));
      for (; next < all.size() && all[next].t_s <= imu.t_s[i]; ++next) {
        const JointRow& row = all[next];
        const double t = row.t_s;
        const Vector3d turn =
            (smooth_rate_->mean(t, t + 2.0 * kSmooth_s) - smooth_rate_->mean(t - 2.0 * kSmooth_s, t)) /
            (2.0 * kSmooth_s);
        const JointFilter::Motion motion =
            filter.motion(imu.t_s[i] - t, smooth_rate_->mean(t - kSmooth_s, t + kSmooth_s), turn,
                          smooth_force_->mean(t - kSmooth_s, t + kSmooth_s));
        if (row.dvl) {
          of_dvl.add(
              filter.update_dvl(series_.dvl.v[row.index], motion, state.dvl_latency_s, mirror_, dvl_sigma_));
        } else {
          of_gps.add(filter.update_gps(velocity_N_.v[row.index], motion, state.gps_latency_s, gps_sigma_),
                     velocity_N_.known_axes());
        }
      }
      sunk += filter.state().v_N.z() * dt;
      if (!last || imu.t_s[i] - recorded_s < 0.0999) continue;
      recorded_s = imu.t_s[i];
      record(recorded_s, filter.state().C_NB, sunk);
    }
    const JointState& end = filter.state();
    if (!end.v_N.allFinite() || !filter.sigmas().allFinite() || !end.C_BD.allFinite()) return false;
    if (last) finish(filter, of_gps, of_dvl);
    gps_sigma_ = gps_sigma_.cwiseProduct(of_gps.excess());
    dvl_sigma_ = dvl_sigma_.cwiseProduct(of_dvl.excess());
    JointState again = end;
    again.C_NB = back(end.C_NB, imu.size() - 1, end.gyro);
    again.v_N = first_velocity();
    // What was known before about the inertial unit is counted once in each pass.
    again.gyro = {};
    again.force = {};
    state = again;
    return true;
  }

  void record(double t_s, const Matrix3d& C_NB, double sunk) {
    Vector3d rpy = geo::to_rpy(geo::from_matrix(C_NB));
    if (result_.rpy_rad.size() > 0) {
      const double before = result_.rpy_rad.v.back().z();
      rpy.z() = before + geo::wrap_pi(rpy.z() - before);
    }
    result_.rpy_rad.t_s.push_back(t_s);
    result_.rpy_rad.v.push_back(rpy);
    result_.sunk_m.t_s.push_back(t_s);
    result_.sunk_m.v.push_back(sunk);
  }

  void finish(const JointFilter& filter, const Innovations& of_gps, const Innovations& of_dvl) {
    const JointState& end = filter.state();
    const JointFilter::Vector sigma = kModelMargin * filter.sigmas();
    const double gps = of_gps.stretch();
    const double dvl = of_dvl.stretch();
    const auto three = [&](int at, double stretch, double least) {
      return Vector3d(stretch * sigma.segment<3>(at)).cwiseMax(least).eval();
    };
    result_.yaw_sigma_rad = std::max(gps, dvl) * sigma[I::kAttitude + 2];
    result_.gps = start_.gps;
    result_.gps.lever_B_m = end.gps_lever_B_m;
    result_.gps.lever_sigma_m = three(I::kGpsLever, gps, kLeastLever_m);
    result_.gps.latency_s = end.gps_latency_s;
    result_.gps.latency_sigma_s = std::max(kLeastLatency_s, gps * sigma[I::kGpsLatency]);
    result_.dvl = start_.dvl;
    result_.dvl.done = start_.with_dvl && of_dvl.of_axis[0].size() > 100;
    if (result_.dvl.done) {
      result_.dvl.similarity.C = end.C_BD;
      result_.dvl.similarity.turn_sigma_rad = three(I::kDvlTurn, dvl, kLeastTurn_rad);
      result_.dvl.similarity.scale = end.dvl_scale;
      result_.dvl.similarity.scale_sigma = end.dvl_scale * dvl * sigma[I::kDvlScale];
      result_.dvl.lever_B_m = end.dvl_lever_B_m;
      result_.dvl.lever_sigma_m = three(I::kDvlLever, dvl, kLeastLever_m);
      result_.dvl.latency_s = end.dvl_latency_s;
      result_.dvl.latency_sigma_s = std::max(kLeastLatency_s, dvl * sigma[I::kDvlLatency]);
    }
    // Nothing holds the vertical.
    if (!velocity_N_.has_down && !result_.dvl.done) result_.sunk_m = {};
    // A filter that does not follow the instruments has found nothing, and one whose innovations have much in
    // common does not know what moves the vehicle.
    const double most = 3.0;
    const bool follows = of_gps.excess().maxCoeff() < most && gps < kMostStretch;
    result_.done =
        follows && (!result_.dvl.done || (of_dvl.excess().maxCoeff() < most && dvl < kMostStretch));
  }

  const Series& series_;
  const GpsVelocity& velocity_N_;
  const JointStart& start_;
  std::vector<Vector3d> rate_, force_;
  std::optional<Smooth> smooth_rate_, smooth_force_;
  Matrix3d mirror_ = Matrix3d::Identity();
  Vector3d gps_sigma_, dvl_sigma_;
  std::size_t first_ = 1;
  JointFit result_;
};

}  // namespace

JointFit fit_joint(const Series& series, const GpsVelocity& velocity_N, const JointStart& start) {
  return Fit(series, velocity_N, start).run();
}

}  // namespace fathom::commission
