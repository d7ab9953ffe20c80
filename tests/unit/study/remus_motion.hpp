#pragma once

#include <cmath>
#include <functional>

#include "base/units.hpp"
#include "estimation/hydro/vehicle_model.hpp"
#include "geo/so3.hpp"
#include "study/hydro/vehicles.hpp"

namespace fathom::study {

/// The REMUS 100 model in open water, its fins held.
struct RemusMotion {
  static constexpr double kDt_s = 0.02;

  estimation::hydro::Vector6 nu = estimation::hydro::Vector6::Zero();
  geo::Quaternion q_NB;
  Eigen::Vector3d position_N_m = Eigen::Vector3d::Zero();
  double turned_rad = 0.0;

  [[nodiscard]] double rpy_deg(int i) const { return geo::to_rpy(q_NB)(i) / kRadPerDeg; }

  /// From steady flight ahead. `each` sees every step.
  static RemusMotion run(double rudder_deg, double stern_deg, double duration_s,
                         const std::function<void(double t_s, const RemusMotion&)>& each = {}) {
    const estimation::hydro::VehicleModel model(hydro::remus100());
    RemusMotion m;
    m.nu[0] = 1.54;
    m.q_NB = geo::from_rpy({-5.3 * kRadPerDeg, 0.0, 0.0});
    const estimation::hydro::Controls controls{1500.0, rudder_deg * kRadPerDeg, stern_deg * kRadPerDeg};
    const int steps = static_cast<int>(std::lround(duration_s / kDt_s));
    for (int i = 0; i < steps; ++i) {
      if (each) each(i * kDt_s, m);
      const Eigen::Matrix3d c = geo::to_matrix(m.q_NB);
      const estimation::hydro::Vector6 after = model.step(m.nu, c.row(2).transpose(), controls, kDt_s);
      const estimation::hydro::Vector6 mean = 0.5 * (m.nu + after);
      m.position_N_m += c * mean.head<3>() * kDt_s;
      m.turned_rad += (c * mean.tail<3>()).z() * kDt_s;
      m.q_NB = geo::normalized(m.q_NB * geo::exp(Eigen::Vector3d(mean.tail<3>() * kDt_s)));
      m.nu = after;
    }
    if (each) each(steps * kDt_s, m);
    return m;
  }
};

}  // namespace fathom::study
