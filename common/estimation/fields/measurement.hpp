#pragma once

#include "archive/samples.hpp"
#include "estimation/navigator/measurement.hpp"
#include "estimation/navigator/navigator.hpp"

/// Fields of what acts on the navigator: inertial steps, measurements, orders.
namespace fathom::estimation {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Increments>
void fields(Archive& archive, Self& self) {
  archive("dt_s", self.dt_s, fathom::archive::at_least_zero());
  archive("dtheta_rad", self.dtheta_rad, fathom::archive::finite());
  archive("dv_m_s", self.dv_m_s, fathom::archive::finite());
  archive("dtheta_before_rad", self.dtheta_before_rad, fathom::archive::finite());
  archive("dv_before_m_s", self.dv_before_m_s, fathom::archive::finite());
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, ImuStep>
void fields(Archive& archive, Self& self) {
  archive("from_ns", self.from_ns, fathom::archive::kInstant);
  archive("to_ns", self.to_ns, fathom::archive::kInstant);
  archive("increments", self.increments);
  archive("gap_s", self.gap_s, fathom::archive::at_least_zero());
  archive("fault", self.fault, ImuFault::stale);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Measurement>
void fields(Archive& archive, Self& self) {
  archive("stamp_ns", self.stamp_ns, fathom::archive::kInstant);
  archive("command", self.command);
  archive("judged", self.judged);
  archive("settled", self.settled);
  archive("said", self.said, static_cast<VerdictKind>(kVerdictKinds - 1));
  archive("revision", self.revision, fathom::archive::kAnyWhole);
  archive("source", self.source, kLastKind);
  archive("sensor", self.sensor, fathom::archive::Whole{-1, kMaxSensors - 1});
  archive("sequence", self.sequence);
  archive("writer", self.writer);
  archive("sample", self.sample);
}

}  // namespace fathom::estimation
