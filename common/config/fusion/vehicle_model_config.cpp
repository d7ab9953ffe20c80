#include <filesystem>

#include "config/fusion/engine_schema.hpp"
#include "config/fusion/hydro_config.hpp"

namespace fathom::config {

using estimation::VehicleModelConfig;

void describe(Schema<estimation::hydro::HydroCoefficients>& s) {
  for (const auto& one : estimation::hydro::coefficient_table())
    s.field(one.name, one.member, "coefficient of the vehicle").unit(one.unit);
}

void describe(Schema<VehicleModelConfig>& s) {
  using C = VehicleModelConfig;
  s.field("enabled", &C::enabled,
          "shaft speed and fins foretell the velocity through the water; needs the state "
          "groups current and model_bias");
  s.field(
      "coefficients_file", &C::coefficients_file,
      "of the vehicle, relative to this file, e.g. \"hydro/remus100.json\"; empty: as given in coefficients");
  s.field("coefficients", &C::coefficients, "of the vehicle where no file is named");
  s.field("origin_B_m", &C::origin_B_m,
          "of the coefficients (the hull's centre of buoyancy) from the inertial unit, forward, right, down")
      .unit("m")
      .range(-1000, 1000);
  s.field("sigma_m_s", &C::sigma_m_s, "ahead, across: what is neither scale nor slow bias")
      .unit("m/s")
      .range(1e-4, 10);
  s.field("correlation_time_s", &C::correlation_time_s, "of that").unit("s").range(0.01, 1000);
  s.field("fins_timeout_s", &C::fins_timeout_s, "without fin angles the velocity across counts less")
      .unit("s")
      .range(0.05, 1e6);
  s.field("min_depth_m", &C::min_depth_m, "not used above: the model is of the submerged vehicle; 0: always")
      .unit("m")
      .range(-1000, 12'000);
  s.field("settle_s", &C::settle_s,
          "not used before: it starts without knowing the current, and what was wrong dies out with the "
          "vehicle's own time constant")
      .unit("s")
      .range(0, 1e6);
  s.field("memory_s", &C::memory_s, "over which it is compared with the DVL-aided velocity")
      .unit("s")
      .range(1, 1e6);
  s.field("trial_s", &C::trial_s, "of comparison before it is believed without the DVL")
      .unit("s")
      .range(0, 1e6);
  s.field("doubt_limit", &C::doubt_limit, "mean normalised squared innovation above which it is not believed")
      .range(1, 100);
}

void load_value(const nlohmann::json& json, VehicleModelConfig& out, const Rules<VehicleModelConfig>&,
                const Place& place) {
  schema_of<VehicleModelConfig>().load(json, out, place);
  if (out.coefficients_file.empty()) return;
  const std::filesystem::path named = out.coefficients_file;
  out.coefficients =
      load_hydro_coefficients((std::filesystem::path(place.file).parent_path() / named).string());
}

}  // namespace fathom::config
