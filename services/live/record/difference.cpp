#include "live/record/difference.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <type_traits>

namespace fathom::cli {
namespace {

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

/// Finds the first field of two samples that differs.
class Difference {
 public:
  void field(const char* name, double recorded, double computed) {
    if (!text_.empty() || same(recorded, computed)) return;
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), "%s: recorded %.17g, computed %.17g", name, recorded, computed);
    text_ = text.data();
  }
  template <std::size_t N>
  void field(const char* name, const std::array<double, N>& recorded, const std::array<double, N>& computed) {
    for (std::size_t i = 0; i < N; ++i)
      field((std::string(name) + "[" + std::to_string(i) + "]").c_str(), recorded[i], computed[i]);
  }
  template <class T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void field(const char* name, T recorded, T computed) {
    if (!text_.empty() || recorded == computed) return;
    text_ = std::string(name) + ": recorded " + std::to_string(static_cast<std::int64_t>(recorded)) +
            ", computed " + std::to_string(static_cast<std::int64_t>(computed));
  }
  void field(const char* name, const Name& recorded, const Name& computed) {
    if (!text_.empty() || recorded == computed) return;
    text_ = std::string(name) + ": recorded '" + recorded.str() + "', computed '" + computed.str() + "'";
  }
  void header(const SampleHeader& recorded, const SampleHeader& computed) {
    field("vehicle", recorded.vehicle, computed.vehicle);
    field("sensor", recorded.sensor, computed.sensor);
    field("stamp_ns", recorded.stamp_ns, computed.stamp_ns);
    field("received_ns", recorded.received_ns, computed.received_ns);
    field("sequence_number", recorded.sequence, computed.sequence);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

std::string first_difference(const NavState& recorded, const NavState& computed) {
  // A field that is added to the sample does not compile here until it is compared.
  const auto& [header, mode, alignment, latitude_rad, longitude_rad, altitude_m, depth_m,
               altitude_above_bottom_m, velocity_N_m_s, q_NB, rpy_rad, angular_rate_B_rad_s,
               specific_force_B_m_s2, position_covariance_N_m2, velocity_covariance_N_m2_s2, rpy_sigma_rad,
               gps_outage_s, dvl_outage_s, reset_counter, last_reset_delta_N_m] = recorded;
  Difference d;
  d.header(header, computed.header);
  d.field("mode", mode, computed.mode);
  d.field("alignment", alignment, computed.alignment);
  d.field("latitude_rad", latitude_rad, computed.latitude_rad);
  d.field("longitude_rad", longitude_rad, computed.longitude_rad);
  d.field("altitude_m", altitude_m, computed.altitude_m);
  d.field("depth_m", depth_m, computed.depth_m);
  d.field("altitude_above_bottom_m", altitude_above_bottom_m, computed.altitude_above_bottom_m);
  d.field("velocity_N_m_s", velocity_N_m_s, computed.velocity_N_m_s);
  d.field("q_NB", q_NB, computed.q_NB);
  d.field("rpy_rad", rpy_rad, computed.rpy_rad);
  d.field("angular_rate_B_rad_s", angular_rate_B_rad_s, computed.angular_rate_B_rad_s);
  d.field("specific_force_B_m_s2", specific_force_B_m_s2, computed.specific_force_B_m_s2);
  d.field("position_covariance_N_m2", position_covariance_N_m2, computed.position_covariance_N_m2);
  d.field("velocity_covariance_N_m2_s2", velocity_covariance_N_m2_s2, computed.velocity_covariance_N_m2_s2);
  d.field("rpy_sigma_rad", rpy_sigma_rad, computed.rpy_sigma_rad);
  d.field("gps_outage_s", gps_outage_s, computed.gps_outage_s);
  d.field("dvl_outage_s", dvl_outage_s, computed.dvl_outage_s);
  d.field("reset_counter", reset_counter, computed.reset_counter);
  d.field("last_reset_delta_N_m", last_reset_delta_N_m, computed.last_reset_delta_N_m);
  return d.text();
}

std::string first_difference(const Verdict& recorded, const Verdict& computed) {
  // A field that is added to the sample does not compile here until it is compared.
  const auto& [header, source, model, writer, kind, dimensions, innovation, innovation_sigma, test_ratio,
               limit, revision, previous, is_final] = recorded;
  Difference d;
  d.header(header, computed.header);
  d.field("source", source, computed.source);
  d.field("model", model, computed.model);
  d.field("writer", writer, computed.writer);
  d.field("kind", kind, computed.kind);
  d.field("dimensions", dimensions, computed.dimensions);
  d.field("innovation", innovation, computed.innovation);
  d.field("innovation_sigma", innovation_sigma, computed.innovation_sigma);
  d.field("test_ratio", test_ratio, computed.test_ratio);
  d.field("limit", limit, computed.limit);
  d.field("revision", revision, computed.revision);
  d.field("previous", previous, computed.previous);
  d.field("is_final", is_final, computed.is_final);
  return d.text();
}

std::string in_words(const NavState& state) {
  return "navigation state " + std::to_string(state.header.sequence) + " at " +
         to_iso8601(state.header.stamp_ns, 6);
}

std::string in_words(const Verdict& verdict) {
  return "verdict on " + verdict.header.sensor.str() + " " + std::to_string(verdict.header.sequence) +
         " at " + to_iso8601(verdict.header.stamp_ns, 6);
}

}  // namespace fathom::cli
