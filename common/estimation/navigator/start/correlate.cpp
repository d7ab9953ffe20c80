#include "estimation/navigator/start/correlate.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Triad {
  Group bias;
  Group scale;
  Group misalignment;
};

void correlate(const Setup& setup, const Triad& triad, const Matrix3d& by_input, const Vector3d& input_B,
               ErrorFilter& filter) {
  const auto carries = [&](Group group, int component, const Vector3d& change_B) {
    const int state = setup.index.of(group);
    if (state < 0) return;
    const double variance = filter(state + component, state + component);
    const Vector3d turn = by_input * change_B;
    for (int i = 0; i < 3; ++i) {
      filter.set(6 + i, state + component, variance * turn(i));
      for (int k = 0; k <= i; ++k)
        filter.set(6 + i, 6 + k, filter(6 + i, 6 + k) + variance * turn(i) * turn(k));
    }
  };
  for (int i = 0; i < 3; ++i) {
    carries(triad.bias, i, Vector3d::Unit(i));
    carries(triad.scale, i, input_B(i) * Vector3d::Unit(i));
    // (IMU-1): two cross terms a row, in the order of the columns.
    carries(triad.misalignment, 2 * i, input_B(i == 0 ? 1 : 0) * Vector3d::Unit(i));
    carries(triad.misalignment, 2 * i + 1, input_B(i == 2 ? 1 : 2) * Vector3d::Unit(i));
  }
}

}  // namespace

void correlate_accelerometers(const Setup& setup, const Matrix3d& rotation_by_force,
                              const Vector3d& force_B_m_s2, ErrorFilter& filter) {
  correlate(setup, {Group::accel_bias, Group::accel_scale, Group::accel_misalignment}, rotation_by_force,
            force_B_m_s2, filter);
}

void correlate_gyros(const Setup& setup, const Matrix3d& rotation_by_rate, const Vector3d& rate_B_rad_s,
                     ErrorFilter& filter) {
  correlate(setup, {Group::gyro_bias, Group::gyro_scale, Group::gyro_misalignment}, rotation_by_rate,
            rate_B_rad_s, filter);
}

void correlate_usbl(const Setup& setup, const Matrix3d& turned_N_m, ErrorFilter& filter) {
  // (ALN-21)
  const auto carries = [&](int state, const Vector3d& moved_N) {
    const double variance = filter(state, state);
    for (int i = 0; i < 3; ++i) {
      filter.set(i, state, variance * moved_N(i));
      for (int k = 0; k <= i; ++k) filter.set(i, k, filter(i, k) + variance * moved_N(i) * moved_N(k));
    }
  };
  const int bias = setup.index.of(Group::usbl_bias);
  for (int i = 0; bias >= 0 && i < 2; ++i) carries(bias + i, Vector3d::Unit(i));
  const int misalignment = setup.index.of(Group::usbl_misalignment);
  for (int i = 0; misalignment >= 0 && i < 3; ++i) carries(misalignment + i, turned_N_m.col(i));
}

void correlate_antennas(const Setup& setup, const Vector3d& by_heading, ErrorFilter& filter) {
  // (ALN-23)
  const int bias = setup.index.of(Group::antenna_bias);
  if (bias < 0) return;
  for (int i = 0; i < 3; ++i) filter.set(6 + i, bias, filter(bias, bias) * by_heading(i));
}

}  // namespace fathom::estimation
