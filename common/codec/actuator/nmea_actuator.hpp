#pragma once

#include <cstdint>
#include <optional>

#include "codec/text/nmea_sentence.hpp"
#include "samples/actuator.hpp"

namespace fathom::codec {

/// RPM of one shaft. The sample has no number for the shaft, so a stream follows one of them: the first seen,
/// and a shaft before an engine, which may turn differently through a gear.
class ShaftFollower {
 public:
  /// Refused, or whether `sample` was written. Status other than A gives unknown rpm.
  [[nodiscard]] std::optional<RejectReason> parse(const Sentence& sentence, PropulsionSample& sample,
                                                  bool& followed);

 private:
  struct Source {
    char kind = '\0';
    std::uint32_t number = 0;
    friend bool operator==(const Source&, const Source&) = default;
  };
  std::optional<Source> source_;
};

/// Deflections that one sentence gives, radians by the sign rule of FinsSample. Empty where the sentence does
/// not speak of that fin, NaN where it says that its value is not valid.
struct FinsReport {
  std::optional<double> rudder_rad;
  std::optional<double> stern_rad;
};

/// RSA: the starboard or single rudder. RSA counts a turn of the bow to starboard positive, which is a
/// negative rotation of the rudder about the body's down axis, so the sign changes.
[[nodiscard]] std::optional<RejectReason> parse_rsa(const Sentence& sentence, FinsReport& report);

/// XDR: angles in degrees named RUDDER and STERN, in the sign of FinsSample. Other transducers are skipped.
[[nodiscard]] std::optional<RejectReason> parse_xdr(const Sentence& sentence, FinsReport& report);

/// Pairs rudder and stern plane, which come in different sentences, into samples. A fin is held back until
/// its partner comes; where the stream has no partner, samples leave at once with the other unknown.
class FinsPairing {
 public:
  struct Ready {
    FinsSample sample;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
  };
  /// At most two: a report that was left alone, then the new one.
  struct Result {
    std::optional<Ready> first;
    std::optional<Ready> second;
  };

  [[nodiscard]] Result add(const FinsReport& report, std::uint64_t offset, std::uint64_t length);
  [[nodiscard]] std::optional<Ready> finish();

 private:
  struct Half {
    FinsReport report;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
  };

  std::optional<Half> waiting_;
  int alone_ = 0;  ///< halves in a row that found no partner
  bool last_alone_is_rudder_ = false;
};

}  // namespace fathom::codec
