#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "codec/registry.hpp"

namespace fathom::codec {

/// Xsens (Movella) MTi: MTData2 messages of the Xbus protocol, in any of its four number formats (MT Low
/// Level Communication Protocol, MT0101P, and MTi Family Reference Manual: MTData2, data identifiers). Other
/// messages are ignored, and so are MTData2 without a fix and without both a rate of turn and an
/// acceleration, or their increments.
///
/// Axes: the unit's sensor frame S is forward, left, up, whatever frame its orientation is given in. The
/// sample is turned to forward-right-down: y and z change their signs.
///
/// Rates and forces: RateOfTurnHR and AccelerationHR are preferred to RateOfTurn and Acceleration.
///
/// Increments: DeltaQ as rotation vector, and DeltaV. Their interval is not in the message. It is the
/// difference of SampleTimeFine to the message with increments before, where PacketCounter shows that no
/// message was lost between them; without PacketCounter the increments stay unknown. So do those
/// of a DeltaQ in format fp12.20 beside a rate of turn: its steps of 2^-20 are 2e-4 rad/s at 100 Hz, and not
/// rounded evenly. Where there is nothing else, rates and forces are increments over their interval.
///
/// An axis that StatusWord says was clipped is unknown.
///
/// Time: SampleTimeFine (100 us) as free-running clock, carried on where its 32 bits begin again after five
/// days. UTC from UtcTime where it says that it is valid.
///
/// Fix: of the receiver in the unit (MTi-7, 670 and their like), item GNSS PVT Data, which comes once a fix,
/// as the maker's xsrawgnsspvtdata.h has it (satellite/pvt.hpp), at the receiver's own UTC. The position and
/// velocity of the unit's filter are not read. Of a message with an inertial part and a fix, one of which
/// cannot be, the other one is kept; the message is refused where nothing is left of it.
[[nodiscard]] std::unique_ptr<Codec> make_xsens(const CodecOptions& options);

namespace xsens {

inline constexpr std::uint8_t kPreamble = 0xFA;
inline constexpr std::uint8_t kMaster = 0xFF;  ///< bus identifier of a unit that is alone on its line
inline constexpr std::uint8_t kMtData2 = 0x36;
inline constexpr std::uint8_t kExtendedLength = 0xFF;
inline constexpr std::uint64_t kTick_ns = 100'000;  ///< of SampleTimeFine
inline constexpr std::size_t kGnssPvtBytes = 94;

/// Data identifiers without their lowest four bits, which say number format and frame.
enum Item : std::uint16_t {
  temperature = 0x0810,
  utc_time = 0x1010,
  packet_counter = 0x1020,
  sample_time_fine = 0x1060,
  delta_v = 0x4010,
  acceleration = 0x4020,
  acceleration_hr = 0x4040,
  gnss_pvt = 0x7010,
  rate_of_turn = 0x8020,
  delta_q = 0x8030,
  rate_of_turn_hr = 0x8040,
  status_word = 0xE020,
};

/// The last byte of a message: all bytes after the preamble and it sum up to 0.
[[nodiscard]] std::uint8_t checksum(std::span<const std::uint8_t> after_preamble);

}  // namespace xsens
}  // namespace fathom::codec
