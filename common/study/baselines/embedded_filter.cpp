#include "study/baselines/embedded_filter.hpp"

#include <cmath>

#include "estimation/aiding/dvl_velocity.hpp"
#include "estimation/hydro/runge_kutta.hpp"

namespace fathom::study::hydro {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kGyroBias = kEmbeddedStates;
constexpr int kCurrent = kGyroBias + 3;

Vector3d squares(double a, double b, double c) {
  return {a * a, b * b, c * c};
}

/// The attitude that the navigator would have without the error phi.
Matrix3d true_C_BN(const Matrix3d& C_NB, const Vector3d& phi) {
  return C_NB.transpose() * (Matrix3d::Identity() - geo::skew(phi));
}

}  // namespace

template <int N>
EmbeddedFilter<N>::EmbeddedFilter(const HydroCoefficients& coefficients, const EmbeddedFilterConfig& config)
    : config_(config),
      model_(coefficients),
      dvl_(estimation::default_sensor(SourceKind::dvl, "dvl")),
      index_(estimation::StateGroups{}),
      filter_(config.tuning) {
  noise_.setZero();
  noise_.diagonal().template head<kEmbeddedStates>() << 4e-5, 4e-5, 4e-5, 3.6e-4, 9e-5, 9e-5, 1e-6, 1e-6,
      1e-6, 1e-6, 1e-9, 1e-9, 1e-9;
  if constexpr (N == kLinkedStates) {
    const double m = config.motion_m_s;
    noise_.diagonal().template head<3>() = squares(m, m, m);
    const double c = config.current_walk_m_s;
    noise_.diagonal().template tail<2>() << c * c, c * c;
  }
}

template <int N>
void EmbeddedFilter<N>::start(const NavSolution& nav, double surface_altitude_m) {
  navigator_.start(nav, surface_altitude_m);
  filter_.x.setZero();
  filter_.x.template head<3>() = geo::to_matrix(nav.q_NB).transpose() * nav.v_N_m_s;
  filter_.P.setZero();
  auto p = filter_.P.diagonal();
  p.template segment<3>(kV) = squares(0.2, 0.1, 0.1);
  p.template segment<3>(kOmega) = squares(0.05, 0.05, 0.05);
  p.template segment<2>(kPosition).setConstant(config_.position_m * config_.position_m);
  p.template segment<2>(kVelocity).setConstant(config_.velocity_m_s * config_.velocity_m_s);
  p.template segment<3>(kPhi) = squares(config_.tilt_rad, config_.tilt_rad, config_.heading_rad);
  if constexpr (N == kLinkedStates) {
    p.template segment<3>(kGyroBias).setConstant(config_.gyro_bias_rad_s * config_.gyro_bias_rad_s);
    p.template segment<2>(kCurrent).setConstant(config_.current_m_s * config_.current_m_s);
    p.template segment<3>(kV) += Vector3d::Constant(config_.current_m_s * config_.current_m_s);
  }
}

template <int N>
void EmbeddedFilter<N>::step(const Controls& controls, const std::optional<DvlSample>& dvl) {
  // (HYD-UKF-1), with the remaining gyro bias turning the navigator (HYD-UKF-2)
  const NavigatorView view = navigator_.view();
  const EmbeddedDynamics dynamics(model_, view, controls);
  filter_.predict(
      [&](const State& x) {
        return estimation::hydro::runge_kutta(x, kStep_s, [&](const State& at) {
          State dot = State::Zero();
          dot.template head<kEmbeddedStates>() = dynamics.derivative(at.template head<kEmbeddedStates>());
          if constexpr (N == kLinkedStates)
            dot.template segment<3>(kPhi) -= view.C_NB * at.template segment<3>(kGyroBias);
          return dot;
        });
      },
      noise_);
  if constexpr (N == kLinkedStates) {
    measure_gyro();
    link();
  }
  if (dvl) measure_dvl(*dvl);
  feed_back();
}

template <int N>
void EmbeddedFilter<N>::measure_dvl(const DvlSample& dvl) {
  const Vector3d measured = geo::vec(dvl.velocity_D_m_s);
  if (!measured.allFinite()) return;
  const Matrix3d r = squares(config_.dvl_m_s, config_.dvl_m_s, config_.dvl_m_s).asDiagonal();
  if constexpr (N == kPrintedStates) {
    Eigen::Matrix<double, 3, N> h = Eigen::Matrix<double, 3, N>::Zero();
    h.template leftCols<3>().setIdentity();
    filter_.template update_linear<3>(h, measured, r);
  } else {
    estimation::FilterState state;
    const auto seen = [&](const State& x) {
      state.nav = navigator_.nav();
      state.nav.v_N_m_s -= Vector3d(x[kVelocity], x[kVelocity + 1], 0.0);
      state.nav.q_NB = geo::exp(Vector3d(x.template segment<3>(kPhi))) * state.nav.q_NB;
      const estimation::AidingState aiding(index_, state, Vector3d::Zero(), 0.0);
      return Vector3d(estimation::DvlVelocity(aiding, dvl_, dvl).predicted());
    };
    filter_.template update<3>(seen, measured, r);
  }
}

template <int N>
void EmbeddedFilter<N>::measure_gyro() {
  if constexpr (N == kLinkedStates) {
    const double s = config_.gyro_rad_s;
    Eigen::Matrix<double, 3, N> h = Eigen::Matrix<double, 3, N>::Zero();
    h.template block<3, 3>(0, kOmega).setIdentity();
    h.template block<3, 3>(0, kGyroBias).setIdentity();
    filter_.template update_linear<3>(h, navigator_.rate_nb_B_rad_s(),
                                      Matrix3d(squares(s, s, s).asDiagonal()));
  }
}

template <int N>
void EmbeddedFilter<N>::link() {
  // (HYD-UKF-3)
  if constexpr (N == kLinkedStates) {
    const double s = config_.link_m_s;
    const Matrix3d c = geo::to_matrix(navigator_.nav().q_NB);
    const Vector3d v_N = navigator_.nav().v_N_m_s;
    filter_.template update<3>(
        [&](const State& x) {
          const Vector3d through_N =
              v_N - Vector3d(x[kVelocity] + x[kCurrent], x[kVelocity + 1] + x[kCurrent + 1], 0.0);
          return Vector3d(true_C_BN(c, x.template segment<3>(kPhi)) * through_N - x.template head<3>());
        },
        Vector3d::Zero(), Matrix3d(squares(s, s, s).asDiagonal()));
  }
}

template <int N>
void EmbeddedFilter<N>::feed_back() {
  navigator_.correct(filter_.x.template segment<7>(kPosition));
  filter_.x.template segment<7>(kPosition).setZero();
  if constexpr (N == kLinkedStates) {
    navigator_.correct_gyro_bias(filter_.x.template segment<3>(kGyroBias));
    filter_.x.template segment<3>(kGyroBias).setZero();
  }
}

template class EmbeddedFilter<kPrintedStates>;
template class EmbeddedFilter<kLinkedStates>;

}  // namespace fathom::study::hydro
