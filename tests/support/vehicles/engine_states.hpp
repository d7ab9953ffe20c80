#pragma once

#include <cstddef>
#include <variant>
#include <vector>

#include "estimation/engine/fusion_engine.hpp"

namespace fathom::test {

/// A state that an engine saved, and what it hears next: for those who forge it.
struct EngineState {
  using Heard = std::variant<ImuSample, GpsSample, DvlSample, DepthSample, HeadingSample, UsblSample,
                             AirspeedSample, PropulsionSample, FinsSample, Command>;

  estimation::EngineConfig config;
  std::vector<std::byte> image;
  std::vector<Heard> next;  ///< of the first second after it

  void feed_to(estimation::FusionEngine& engine) const;
};

/// A survey with every instrument and most states, saved at an instant of the run.
EngineState survey_state(double at_s);

/// A drop while roll and pitch are being found.
EngineState drop_state(double at_s);

}  // namespace fathom::test
