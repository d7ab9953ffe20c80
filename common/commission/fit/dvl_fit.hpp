#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "commission/fit/strapdown.hpp"
#include "commission/fit/window_fit.hpp"

namespace fathom::commission {

/// What IMU and DVL together tell: velocity of the inertial unit = M v_D - rate x lever, M any matrix.
struct DvlFit {
  bool done = false;
  double squares = 0.0;  ///< left over, m^2/s^2, with what the model neglects
  double freedom = 1.0;
  std::size_t windows = 0;
  Eigen::Matrix3d M = Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 9, 9> M_covariance =
      Eigen::Matrix<double, 9, 9>::Identity();  ///< of its columns, stacked
  Eigen::Vector3d lever_B_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d lever_sigma_m = Eigen::Vector3d::Constant(1e9);
};

/// Linear fit, of `M` and lever, at a given latency: what compares hypotheses.
[[nodiscard]] DvlFit fit_dvl_linear(const Series& series, const std::vector<Span>& windows,
                                    const ImuReading& reading, double latency_s);
/// The similarity that a matrix is within its covariance: M = scale * C, or scale * C * diag(1, -1, 1).
struct Similarity {
  double scale = 1.0;
  double scale_sigma = 1e9;
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity();                  ///< rotation, DVL's axes into body
  Eigen::Vector3d turn_sigma_rad = Eigen::Vector3d::Constant(1e9);  ///< about the axes of the DVL
  bool mirrored = false;
  double chi2 = 0.0;
};
[[nodiscard]] Similarity fit_similarity(const DvlFit& fit, bool mirrored);

/// Figures of the DVL: what it reads = (1/scale) diag(1, +-1, 1) C^T (velocity of the inertial unit + rate x
/// lever), with noise on the reading alone. Each window has a velocity and a gravity of its own.
struct DvlFigures {
  bool done = false;
  bool settled = false;   ///< a further step turns the mounting by less than its sigma
  Similarity similarity;  ///< chi2 not set
  Eigen::Vector3d lever_B_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d lever_sigma_m = Eigen::Vector3d::Constant(1e9);
  double latency_s = 0.0;
  double latency_sigma_s = 1e9;
  double residual_m_s = 0.0;
  std::size_t windows = 0;
};
/// From a first guess of the similarity and latency. About `held_D`, an axis of the DVL, the mounting stays
/// as guessed.
[[nodiscard]] DvlFigures fit_dvl(const Series& series, const std::vector<Span>& windows,
                                 const ImuReading& reading, const Similarity& guess,
                                 const Eigen::Vector3d& lever_B_m, double latency_s,
                                 const std::optional<Eigen::Vector3d>& held_D = std::nullopt);

}  // namespace fathom::commission
