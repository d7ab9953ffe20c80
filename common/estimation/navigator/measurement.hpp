#pragma once

#include <tuple>

#include "estimation/event_sample.hpp"
#include "samples/verdict.hpp"

namespace fathom::estimation {

/// Something that happens to the filter at an instant: a measurement or an order.
struct Measurement {
  TimeNs stamp_ns = 0;                   ///< validity, latency taken off
  bool command = false;                  ///< an order: no verdict, but an outcome
  bool judged = false;                   ///< its first verdict has been given
  bool settled = false;                  ///< its final verdict has been given
  VerdictKind said = VerdictKind::used;  ///< of the verdict given last
  std::uint32_t revision = 0;            ///< of the verdict given last
  SourceKind source = SourceKind::gps;
  int sensor = -1;  ///< index in EngineConfig::sensors
  std::uint64_t sequence = 0;
  Name writer;  ///< who published it, for its verdicts
  EventSample sample;

  [[nodiscard]] const SampleHeader& header() const { return header_of(sample); }
  /// The one order in which events are applied, whatever the order of their arrival. Orders come first.
  [[nodiscard]] auto key() const {
    return std::make_tuple(stamp_ns, command ? 0 : 1, static_cast<int>(source), sensor, sequence);
  }
};

/// What the filter says to a measurement.
struct Judgement {
  VerdictKind kind = VerdictKind::not_aligned;
  Name model;
  std::uint32_t dimensions = 0;
  std::array<double, 6> innovation{};
  std::array<double, 6> innovation_sigma{};
  double test_ratio = kUnknown;
  double limit = kUnknown;
};

}  // namespace fathom::estimation
