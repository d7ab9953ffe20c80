#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "base/field.hpp"

namespace fathom::estimation::hydro {

/// Gertler-Hagen coefficients of a torpedo-shaped vehicle, dimensional, about an origin on the hull axis;
/// body axes forward-right-down. X_uu multiplies u|u| in the force along x, M_uw the product u w in the
/// moment about y; "dot" marks an acceleration (added mass), d a fin: r rudder, s stern planes, both positive
/// by the right-hand rule about the axis they turn around. Units stand in coefficient_table(). All zero is no
/// vehicle: the values come from a configuration file.
struct HydroCoefficients {
  // Rigid body.
  double weight = 0.0;
  double buoyancy = 0.0;
  double gravity = 9.81;  ///< of the weight: mass = weight/gravity
  double I_xx = 0.0, I_yy = 0.0, I_zz = 0.0;
  double x_G = 0.0, y_G = 0.0, z_G = 0.0;  ///< centre of gravity
  double x_B = 0.0, y_B = 0.0, z_B = 0.0;  ///< centre of buoyancy
  // Along x.
  double X_uu = 0.0, X_udot = 0.0, X_wq = 0.0, X_qq = 0.0, X_vr = 0.0, X_rr = 0.0, X_prop = 0.0;
  // Along y.
  double Y_vv = 0.0, Y_rr = 0.0, Y_uv = 0.0, Y_vdot = 0.0, Y_rdot = 0.0, Y_pdot = 0.0, Y_ur = 0.0, Y_wp = 0.0;
  double Y_pq = 0.0, Y_uudr = 0.0;
  // Along z.
  double Z_ww = 0.0, Z_qq = 0.0, Z_uw = 0.0, Z_wdot = 0.0, Z_qdot = 0.0, Z_uq = 0.0, Z_vp = 0.0, Z_rp = 0.0;
  double Z_uuds = 0.0;
  // About x.
  double K_pp = 0.0, K_pdot = 0.0, K_vdot = 0.0, K_rdot = 0.0, K_prop = 0.0;
  // About y.
  double M_ww = 0.0, M_qq = 0.0, M_uw = 0.0, M_wdot = 0.0, M_qdot = 0.0, M_uq = 0.0, M_vp = 0.0, M_rp = 0.0;
  double M_uuds = 0.0;
  // About z.
  double N_vv = 0.0, N_rr = 0.0, N_uv = 0.0, N_vdot = 0.0, N_rdot = 0.0, N_pdot = 0.0, N_ur = 0.0, N_wp = 0.0;
  double N_pq = 0.0, N_uudr = 0.0;
  /// Shaft speed at which X_prop and K_prop hold; both grow with n|n|.
  double propulsor_rpm = 0.0;

  [[nodiscard]] double mass() const { return weight / gravity; }
  /// Nothing when this is a vehicle: all finite, weights and inertias positive, damping that damps, a
  /// positive definite mass matrix.
  [[nodiscard]] std::optional<Complaint> complaint() const;
  /// Its text; empty when this is a vehicle.
  [[nodiscard]] std::string validate() const;
};

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Rigid body and added mass, row by row force and moment (HYD-1).
[[nodiscard]] Matrix6 mass_matrix(const HydroCoefficients& coefficients);

enum class CoefficientKind : std::uint8_t {
  body,        ///< weighed and measured ashore
  added_mass,  ///< from here on hydrodynamic: known to ten or thirty per cent
  cross_flow,  ///< drag of the hull across the flow, and products of velocities and rates
  drag,        ///< must be negative
  lift,        ///< of hull and fins, proportional to u
  fin,
  propulsion,
};

struct CoefficientEntry {
  const char* name;
  const char* unit;
  double HydroCoefficients::*member;
  CoefficientKind kind;
  bool positive = false;  ///< it must be
};

/// What a coefficient of the kind is, in a few words.
[[nodiscard]] std::string to_string(CoefficientKind kind);

/// Every coefficient once, in the order of the struct.
[[nodiscard]] std::span<const CoefficientEntry> coefficient_table();

}  // namespace fathom::estimation::hydro
