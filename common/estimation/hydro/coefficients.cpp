#include "estimation/hydro/coefficients.hpp"

#include <array>
#include <cmath>
#include <sstream>

#include <Eigen/Cholesky>

namespace fathom::estimation::hydro {
namespace {

using C = HydroCoefficients;
using enum CoefficientKind;

constexpr std::array kTable{
    CoefficientEntry{"weight", "N", &C::weight, body, true},
    CoefficientEntry{"buoyancy", "N", &C::buoyancy, body, true},
    CoefficientEntry{"gravity", "m/s^2", &C::gravity, body, true},
    CoefficientEntry{"I_xx", "kg m^2", &C::I_xx, body, true},
    CoefficientEntry{"I_yy", "kg m^2", &C::I_yy, body, true},
    CoefficientEntry{"I_zz", "kg m^2", &C::I_zz, body, true},
    CoefficientEntry{"x_G", "m", &C::x_G, body},
    CoefficientEntry{"y_G", "m", &C::y_G, body},
    CoefficientEntry{"z_G", "m", &C::z_G, body},
    CoefficientEntry{"x_B", "m", &C::x_B, body},
    CoefficientEntry{"y_B", "m", &C::y_B, body},
    CoefficientEntry{"z_B", "m", &C::z_B, body},
    CoefficientEntry{"X_uu", "kg/m", &C::X_uu, drag},
    CoefficientEntry{"X_udot", "kg", &C::X_udot, added_mass},
    CoefficientEntry{"X_wq", "kg/rad", &C::X_wq, cross_flow},
    CoefficientEntry{"X_qq", "kg m/rad", &C::X_qq, cross_flow},
    CoefficientEntry{"X_vr", "kg/rad", &C::X_vr, cross_flow},
    CoefficientEntry{"X_rr", "kg m/rad", &C::X_rr, cross_flow},
    CoefficientEntry{"X_prop", "N", &C::X_prop, propulsion},
    CoefficientEntry{"Y_vv", "kg/m", &C::Y_vv, drag},
    CoefficientEntry{"Y_rr", "kg m/rad^2", &C::Y_rr, cross_flow},
    CoefficientEntry{"Y_uv", "kg/m", &C::Y_uv, lift},
    CoefficientEntry{"Y_vdot", "kg", &C::Y_vdot, added_mass},
    CoefficientEntry{"Y_rdot", "kg m/rad", &C::Y_rdot, added_mass},
    CoefficientEntry{"Y_pdot", "kg m/rad", &C::Y_pdot, added_mass},
    CoefficientEntry{"Y_ur", "kg/rad", &C::Y_ur, lift},
    CoefficientEntry{"Y_wp", "kg/rad", &C::Y_wp, cross_flow},
    CoefficientEntry{"Y_pq", "kg m/rad", &C::Y_pq, cross_flow},
    CoefficientEntry{"Y_uudr", "kg/(m rad)", &C::Y_uudr, fin},
    CoefficientEntry{"Z_ww", "kg/m", &C::Z_ww, drag},
    CoefficientEntry{"Z_qq", "kg m/rad^2", &C::Z_qq, cross_flow},
    CoefficientEntry{"Z_uw", "kg/m", &C::Z_uw, lift},
    CoefficientEntry{"Z_wdot", "kg", &C::Z_wdot, added_mass},
    CoefficientEntry{"Z_qdot", "kg m/rad", &C::Z_qdot, added_mass},
    CoefficientEntry{"Z_uq", "kg/rad", &C::Z_uq, lift},
    CoefficientEntry{"Z_vp", "kg/rad", &C::Z_vp, cross_flow},
    CoefficientEntry{"Z_rp", "kg m/rad", &C::Z_rp, cross_flow},
    CoefficientEntry{"Z_uuds", "kg/(m rad)", &C::Z_uuds, fin},
    CoefficientEntry{"K_pp", "kg m^2/rad^2", &C::K_pp, drag},
    CoefficientEntry{"K_pdot", "kg m^2/rad", &C::K_pdot, added_mass},
    CoefficientEntry{"K_vdot", "kg m", &C::K_vdot, added_mass},
    CoefficientEntry{"K_rdot", "kg m^2/rad", &C::K_rdot, added_mass},
    CoefficientEntry{"K_prop", "N m", &C::K_prop, propulsion},
    CoefficientEntry{"M_ww", "kg", &C::M_ww, cross_flow},
    CoefficientEntry{"M_qq", "kg m^2/rad^2", &C::M_qq, drag},
    CoefficientEntry{"M_uw", "kg", &C::M_uw, lift},
    CoefficientEntry{"M_wdot", "kg m", &C::M_wdot, added_mass},
    CoefficientEntry{"M_qdot", "kg m^2/rad", &C::M_qdot, added_mass},
    CoefficientEntry{"M_uq", "kg m/rad", &C::M_uq, lift},
    CoefficientEntry{"M_vp", "kg m/rad", &C::M_vp, cross_flow},
    CoefficientEntry{"M_rp", "kg m^2/rad^2", &C::M_rp, cross_flow},
    CoefficientEntry{"M_uuds", "kg/rad", &C::M_uuds, fin},
    CoefficientEntry{"N_vv", "kg", &C::N_vv, cross_flow},
    CoefficientEntry{"N_rr", "kg m^2/rad^2", &C::N_rr, drag},
    CoefficientEntry{"N_uv", "kg", &C::N_uv, lift},
    CoefficientEntry{"N_vdot", "kg m", &C::N_vdot, added_mass},
    CoefficientEntry{"N_rdot", "kg m^2/rad", &C::N_rdot, added_mass},
    CoefficientEntry{"N_pdot", "kg m^2/rad", &C::N_pdot, added_mass},
    CoefficientEntry{"N_ur", "kg m/rad", &C::N_ur, lift},
    CoefficientEntry{"N_wp", "kg m/rad", &C::N_wp, cross_flow},
    CoefficientEntry{"N_pq", "kg m^2/rad^2", &C::N_pq, cross_flow},
    CoefficientEntry{"N_uudr", "kg/rad", &C::N_uudr, fin},
    CoefficientEntry{"propulsor_rpm", "rpm", &C::propulsor_rpm, body, true},
};

}  // namespace

std::span<const CoefficientEntry> coefficient_table() {
  return kTable;
}

Matrix6 mass_matrix(const HydroCoefficients& c) {
  // (HYD-1)
  const double m = c.mass();
  Matrix6 out;
  out << m - c.X_udot, 0, 0, 0, m * c.z_G, -m * c.y_G,                       //
      0, m - c.Y_vdot, 0, -m * c.z_G - c.Y_pdot, 0, m * c.x_G - c.Y_rdot,    //
      0, 0, m - c.Z_wdot, m * c.y_G, -m * c.x_G - c.Z_qdot, 0,               //
      0, -m * c.z_G - c.K_vdot, m * c.y_G, c.I_xx - c.K_pdot, 0, -c.K_rdot,  //
      m * c.z_G, 0, -m * c.x_G - c.M_wdot, 0, c.I_yy - c.M_qdot, 0,          //
      -m * c.y_G, m * c.x_G - c.N_vdot, 0, -c.N_pdot, 0, c.I_zz - c.N_rdot;
  return out;
}

std::optional<Complaint> HydroCoefficients::complaint() const {
  const auto complaint = [](const CoefficientEntry& one, double value, const char* expected) {
    std::ostringstream text;
    text << value;
    return Complaint{one.name, text.str(), expected};
  };
  for (const CoefficientEntry& one : kTable) {
    const double value = this->*one.member;
    if (!std::isfinite(value)) return complaint(one, value, "a finite number");
    if (one.kind == drag && !(value < 0.0))
      return complaint(one, value, "a negative number: drag takes energy from the motion");
  }
  for (const CoefficientEntry& one : kTable) {
    if (one.positive && !(this->*one.member > 0.0))
      return complaint(one, this->*one.member, "a positive number");
  }
  // Energy of any motion is positive: of the symmetric part, since sources differ in the cross terms.
  const Matrix6 m = mass_matrix(*this);
  const Eigen::LLT<Matrix6> factor(0.5 * (m + m.transpose()));
  if (factor.info() != Eigen::Success)
    return Complaint{"mass matrix", "not positive definite",
                     "added masses (X_udot, Y_vdot, Z_wdot, K_pdot, M_qdot, N_rdot) at or below 0 and small "
                     "cross terms"};
  return {};
}

std::string HydroCoefficients::validate() const {
  const auto found = complaint();
  return found ? found->text() : "";
}

std::string to_string(CoefficientKind kind) {
  switch (kind) {
    case body:
      return "rigid body, weighed and measured ashore";
    case added_mass:
      return "added mass";
    case cross_flow:
      return "drag of the hull across the flow, and products of velocities and rates";
    case drag:
      return "drag, negative";
    case lift:
      return "lift of hull and fins, proportional to u";
    case fin:
      return "force of a fin";
    case propulsion:
      return "force of the propulsor at propulsor_rpm";
  }
  return {};
}

}  // namespace fathom::estimation::hydro
