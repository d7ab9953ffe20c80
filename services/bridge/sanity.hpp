#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "codec/codec.hpp"
#include "config/bridge/bridge_config.hpp"

namespace fathom::bridge {

/// Why a decoded sample is not published.
enum class Refusal : std::uint8_t {
  not_finite = 0,  ///< infinite, or unknown where the sample is worth nothing without
  impossible = 1,  ///< beyond the configured limits of what such an instrument can mean
  no_instant = 2,  ///< the instant that it names is none of the time that the configuration allows
};
inline constexpr std::size_t kRefusals = 3;
[[nodiscard]] std::string_view to_string(Refusal refusal);

/// A sample that is not published: of which value, and what was expected instead of it.
struct Refused {
  Refusal why;
  std::string_view field;                 ///< of the sample, with its unit; a literal
  std::optional<std::size_t> index = {};  ///< in the array that the field is
  double value = 0.0;
  double least = 0.0;
  double most = 0.0;
};

/// "depth_m is 12000.5, expected -100 to 11000".
[[nodiscard]] std::string sentence(const Refused& refused);

/// Unknown (NaN) is a legal answer of an instrument that has lost its bottom or its satellites and is
/// published, so that others see it alive; an inertial sample, a depth or a heading without its value is
/// nothing.
[[nodiscard]] std::optional<Refused> refuse(const AnySample& sample, const config::SampleLimits& limits);

/// Turns an inertial sample from instrument axes into the body: v_B = R_BS v_S (row-major).
void rotate_into_body(ImuSample& sample, const std::array<double, 9>& R_BS);

}  // namespace fathom::bridge
