#pragma once

#include "estimation/hydro/water_velocity.hpp"
#include "estimation/navigator/estimate.hpp"
#include "estimation/navigator/measurement.hpp"

namespace fathom::estimation {

/// The vehicle's own dynamics as a virtual velocity log: driven by shaft speed and fins, tried beside the
/// DVL, believed as far as it did well there (HYD-4).
class ModelAiding {
 public:
  /// What a sample does for the model.
  enum class Drive : std::uint8_t { nothing, shaft, fins };
  [[nodiscard]] Drive drive(const Setup& setup, const Estimate& estimate, const Measurement& measurement);
  /// Carries the model through a step; what speaks against it makes its slow error in the filter faster.
  void predict(const Setup& setup, const ImuStep& step, Estimate& estimate);

  struct Trial {
    bool usable = false;  ///< it has settled, and is that of where the vehicle is
    bool believed = false;
    bool fits = false;  ///< its gate would pass it
  };
  /// Notes how the model did beside the DVL. `vouched`: a DVL was used lately.
  [[nodiscard]] Trial consider(const Setup& setup, const Estimate& estimate, const AidingState& state,
                               const PropulsionSample& sample, bool vouched);
  void measured() { water_.measured(); }
  /// The navigation begins anew.
  void stop() { water_.stop(); }
  /// Normalised innovation squared beside the DVL, averaged: 1 for a model that is as good as it says.
  [[nodiscard]] bool is_doubted(const VehicleModelConfig& config) const {
    return !(water_.model_nis() <= config.doubt_limit);
  }
  [[nodiscard]] const hydro::WaterVelocity& water_velocity() const { return water_; }

  /// For archives: see fields/navigator.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  hydro::WaterVelocity water_;
};

}  // namespace fathom::estimation
