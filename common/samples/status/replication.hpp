#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "samples/header.hpp"

namespace fathom {

/// What one of several fusion services knows, compared with the one that leads.
enum class ReplicaPhase : std::uint8_t {
  listening,  ///< finding out whether another one leads
  behind,     ///< another one leads and knows what this one does not
  in_step     ///< leads, or could at once
};

[[nodiscard]] constexpr std::string_view to_string(ReplicaPhase phase) {
  switch (phase) {
    case ReplicaPhase::listening:
      return "listening";
    case ReplicaPhase::behind:
      return "behind";
    case ReplicaPhase::in_step:
      return "in step";
  }
  return "?";
}

/// One fusion service among several; header.sensor is the instance.
struct ReplicaStatus {
  SampleHeader header;
  ReplicaPhase phase = ReplicaPhase::listening;
  double in_step_s = 0.0;  ///< for how long, without a break
  bool leads = false;      ///< its navigation state is the one heard
  std::int32_t ownership_strength = 0;
  std::uint64_t missed = 0;      ///< samples that its state lacks, by the gaps in their sequence numbers
  std::uint64_t caught_up = 0;   ///< times that it has taken the state of another one
  std::uint64_t unprepared = 0;  ///< times that it went on alone without being in step
};

/// A part of an engine's state on its way to another process of the same build; header.stamp_ns is that of
/// the navigation state in it.
struct EngineStatePart {
  static constexpr std::size_t kBytes = 16'384;
  SampleHeader header;
  std::uint64_t transfer = 0;  ///< which state: grows by one with each
  std::uint64_t missed = 0;    ///< as in ReplicaStatus
  std::uint32_t part = 0;      ///< from 0
  std::uint32_t parts = 0;
  std::uint32_t size = 0;  ///< bytes of this part that count
  std::array<std::uint8_t, kBytes> bytes{};
};

}  // namespace fathom
