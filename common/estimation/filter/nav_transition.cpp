#include "estimation/filter/nav_transition.hpp"

#include "base/wide.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kImuRows = 6;
constexpr int s = kRowStride;

/// What the scale states of one instrument add to its bias: rows `x` of the instrument += input times states.
FATHOM_WITHIN void add_scale(double* x, const double* scale, const Vector3d& input, int columns) {
  for (int row = 0; row < 3; ++row) {
    const double factor = input(row);
    double* to = x + row * s;
    const double* from = scale + row * s;
#pragma GCC ivdep
    for (int j = 0; j < columns; ++j) to[j] += factor * from[j];
  }
}

/// Likewise its misalignment, M = [0 m0 m1; m2 0 m3; m4 m5 0].
FATHOM_WITHIN void add_misalignment(double* x, const double* m, const Vector3d& input, int columns) {
  const double a = input.x();
  const double b = input.y();
  const double c = input.z();
#pragma GCC ivdep
  for (int j = 0; j < columns; ++j) {
    x[j] += b * m[j] + c * m[j + s];
    x[j + s] += a * m[j + 2 * s] + c * m[j + 3 * s];
    x[j + 2 * s] += a * m[j + 4 * s] + b * m[j + 5 * s];
  }
}

struct Errors {
  double rn, re, rd, vn, ve, vd, pn, pe, pd;
};

/// The entries of F dt that are not zero, each a scalar of its own so that the compiler keeps it out of the
/// loop.
struct Rates {
  Rates(double dt_s, const Matrix3d& r_r, const Matrix3d& v_r, const Matrix3d& v_v, const Matrix3d& phi_r,
        const Matrix3d& phi_v, const Vector3d& force, const Vector3d& turn)
      : dt(dt_s),
        rr00(r_r(0, 0)),
        rr02(r_r(0, 2)),
        rr10(r_r(1, 0)),
        rr11(r_r(1, 1)),
        rr12(r_r(1, 2)),
        vr00(v_r(0, 0)),
        vr02(v_r(0, 2)),
        vr10(v_r(1, 0)),
        vr12(v_r(1, 2)),
        vr20(v_r(2, 0)),
        vr22(v_r(2, 2)),
        vv00(v_v(0, 0)),
        vv01(v_v(0, 1)),
        vv02(v_v(0, 2)),
        vv10(v_v(1, 0)),
        vv11(v_v(1, 1)),
        vv12(v_v(1, 2)),
        vv20(v_v(2, 0)),
        vv21(v_v(2, 1)),
        pr00(phi_r(0, 0)),
        pr02(phi_r(0, 2)),
        pr12(phi_r(1, 2)),
        pr20(phi_r(2, 0)),
        pr22(phi_r(2, 2)),
        pv01(phi_v(0, 1)),
        pv10(phi_v(1, 0)),
        pv21(phi_v(2, 1)),
        fx(force.x()),
        fy(force.y()),
        fz(force.z()),
        wx(turn.x()),
        wy(turn.y()),
        wz(turn.z()) {}

  [[gnu::always_inline]] inline Errors operator()(const Errors& x) const {
    return {rr00 * x.rn + rr02 * x.rd + dt * x.vn,
            rr10 * x.rn + rr11 * x.re + rr12 * x.rd + dt * x.ve,
            dt * x.vd,
            vr00 * x.rn + vr02 * x.rd + vv00 * x.vn + vv01 * x.ve + vv02 * x.vd + (fy * x.pd - fz * x.pe),
            vr10 * x.rn + vr12 * x.rd + vv10 * x.vn + vv11 * x.ve + vv12 * x.vd + (fz * x.pn - fx * x.pd),
            vr20 * x.rn + vr22 * x.rd + vv20 * x.vn + vv21 * x.ve + (fx * x.pe - fy * x.pn),
            pr00 * x.rn + pr02 * x.rd + pv01 * x.ve + (wz * x.pe - wy * x.pd),
            pr12 * x.rd + pv10 * x.vn + (wx * x.pd - wz * x.pn),
            pr20 * x.rn + pr22 * x.rd + pv21 * x.ve + (wy * x.pn - wx * x.pe)};
  }

  double dt;
  double rr00, rr02, rr10, rr11, rr12;
  double vr00, vr02, vr10, vr12, vr20, vr22;
  double vv00, vv01, vv02, vv10, vv11, vv12, vv20, vv21;
  double pr00, pr02, pr12, pr20, pr22;
  double pv01, pv10, pv21;
  double fx, fy, fz, wx, wy, wz;
};

}  // namespace

NavTransition::NavTransition(const StateIndex& index, const ErrorRates& rates, const Matrix3d& C_NB,
                             const Vector3d& rate_B_rad_s, const Vector3d& force_B_m_s2, double dt_s)
    : dt_s_(dt_s),
      driven_(index.imu_end()),
      accel_scale_(index.of(Group::accel_scale)),
      gyro_scale_(index.of(Group::gyro_scale)),
      accel_misalignment_(index.of(Group::accel_misalignment)),
      gyro_misalignment_(index.of(Group::gyro_misalignment)),
      biases_only_(accel_scale_ < 0 && gyro_scale_ < 0 && accel_misalignment_ < 0 && gyro_misalignment_ < 0),
      rate_B_(rate_B_rad_s),
      force_B_(force_B_m_s2),
      r_r_(dt_s * rates.r_r),
      v_r_(dt_s * rates.v_r),
      v_v_(dt_s * rates.v_v),
      phi_r_(dt_s * rates.phi_r),
      phi_v_(dt_s * rates.phi_v),
      c_(dt_s * C_NB),
      force_(dt_s * rates.force_N_m_s2),
      turn_(dt_s * rates.rate_in_N_rad_s) {}

NavTransition::NavTransition(const StateIndex& index, const NavSolution& nav, const Vector3d& rate_B_rad_s,
                             const Vector3d& force_B_m_s2, double dt_s)
    : NavTransition(
          index,
          error_rates(geo::LocalEarth(nav.position), nav.v_N_m_s, geo::to_matrix(nav.q_NB) * force_B_m_s2),
          geo::to_matrix(nav.q_NB), rate_B_rad_s, force_B_m_s2, dt_s) {}

FATHOM_WIDE void NavTransition::apply(double* rows, int columns) const {
  const double* bias = rows + kNavStates * s;
  if (biases_only_) {
    move(rows, bias, columns);
    return;
  }
  // (DYN-2): scale and misalignment act through the same three axes as the bias.
  alignas(64) std::array<double, static_cast<std::size_t>(kImuRows) * kRowStride> sum;
  for (int row = 0; row < kImuRows; ++row)
    std::copy(bias + row * s, bias + row * s + columns, sum.data() + row * s);
  double* accel = sum.data();
  double* gyro = sum.data() + 3 * s;
  if (accel_scale_ >= 0) add_scale(accel, rows + accel_scale_ * s, force_B_, columns);
  if (gyro_scale_ >= 0) add_scale(gyro, rows + gyro_scale_ * s, rate_B_, columns);
  if (accel_misalignment_ >= 0) add_misalignment(accel, rows + accel_misalignment_ * s, force_B_, columns);
  if (gyro_misalignment_ >= 0) add_misalignment(gyro, rows + gyro_misalignment_ * s, rate_B_, columns);
  move(rows, sum.data(), columns);
}

FATHOM_WIDE void NavTransition::move(double* nav, const double* imu, int columns) const {
  const Rates f{dt_s_, r_r_, v_r_, v_v_, phi_r_, phi_v_, force_, turn_};
  const double c00 = c_(0, 0), c01 = c_(0, 1), c02 = c_(0, 2);
  const double c10 = c_(1, 0), c11 = c_(1, 1), c12 = c_(1, 2);
  const double c20 = c_(2, 0), c21 = c_(2, 1), c22 = c_(2, 2);
#pragma GCC ivdep
  for (int j = 0; j < columns; ++j) {
    double* x = nav + j;
    const double* u = imu + j;
    const Errors at{x[0], x[s], x[2 * s], x[3 * s], x[4 * s], x[5 * s], x[6 * s], x[7 * s], x[8 * s]};
    const double ax = u[0], ay = u[s], az = u[2 * s], gx = u[3 * s], gy = u[4 * s], gz = u[5 * s];
    Errors d = f(at);
    d.vn += c00 * ax + c01 * ay + c02 * az;
    d.ve += c10 * ax + c11 * ay + c12 * az;
    d.vd += c20 * ax + c21 * ay + c22 * az;
    d.pn -= c00 * gx + c01 * gy + c02 * gz;
    d.pe -= c10 * gx + c11 * gy + c12 * gz;
    d.pd -= c20 * gx + c21 * gy + c22 * gz;
    // The instrument's errors stand still within the step: only the navigation errors have a second
    // derivative.
    const Errors dd = f(d);
    x[0] = at.rn + (d.rn + 0.5 * dd.rn);
    x[s] = at.re + (d.re + 0.5 * dd.re);
    x[2 * s] = at.rd + (d.rd + 0.5 * dd.rd);
    x[3 * s] = at.vn + (d.vn + 0.5 * dd.vn);
    x[4 * s] = at.ve + (d.ve + 0.5 * dd.ve);
    x[5 * s] = at.vd + (d.vd + 0.5 * dd.vd);
    x[6 * s] = at.pn + (d.pn + 0.5 * dd.pn);
    x[7 * s] = at.pe + (d.pe + 0.5 * dd.pe);
    x[8 * s] = at.pd + (d.pd + 0.5 * dd.pd);
  }
}

NavTransition::Rows NavTransition::rows(int columns) const {
  std::array<double, static_cast<std::size_t>(kMaxStates) * kRowStride> unit{};
  for (int i = 0; i < columns; ++i) unit[static_cast<std::size_t>(i * kRowStride + i)] = 1.0;
  apply(unit.data(), columns);
  Rows out(kNavStates, columns);
  for (int i = 0; i < kNavStates; ++i)
    for (int j = 0; j < columns; ++j) out(i, j) = unit[static_cast<std::size_t>(i * kRowStride + j)];
  return out;
}

}  // namespace fathom::estimation
