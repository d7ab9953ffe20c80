#pragma once

#include <memory>
#include <optional>

#include "codec/codec.hpp"
#include "codec/registry.hpp"
#include "codec/text/nmea_sentence.hpp"
#include "samples/heading.hpp"

namespace fathom::codec {

/// Attitude sentences of compasses, two-antenna receivers and inertial systems, in place of HDT or HDG.
/// Angles are in degrees; of the attitude only the heading is kept, roll and pitch have to be possible. In
/// the order in which one is preferred:
///
///     $PASHR,hhmmss.sss,heading,T,roll,pitch,heave,roll accuracy,pitch accuracy,heading accuracy,GNSS,INS
///         Applanix POS MV, NovAtel SPAN, Trimble, OxTS, SBG, Hemisphere. True heading with its sigma. INS is
///         not sent by Hemisphere and by NovAtel before 7.03.
///     $PSAT,HPR,hhmmss.ss,heading,pitch,roll,N
///         Hemisphere and CSI Wireless. True heading by satellites (N) or held by a gyro (G).
///     $PTNTHPR,heading,status,pitch,status,roll,status
///         Honeywell HMR3000, True North, Jewell. Magnetic heading. N is normal, M and O are warnings of low
///         and high, every other status is an alarm. An alarm of any of the three leaves no heading, as the
///         HMR3000 itself has it. An instrument that is set to mils is not taken.
///     $OHPR,heading,pitch,roll,...
///     $C320.5P0.2R-18.3T19.0
///         OceanServer OS4000 and OS5000. Magnetic heading; what follows is any selection of further values.
///     $PRDID,pitch,roll,heading
///         Teledyne RDI, TSS, Applanix, Sonardyne: true heading, as inertial systems have it. Motion sensors
///         without a heading leave it empty.
///
/// Where the sentence does not say which north it means, the last four, CodecOptions::untold_north goes
/// before what is said here: OceanServer compasses, for one, add a declination that was entered.
///
/// The flags of PASHR mean different things to different makers: INS 1 is aligned for Applanix and NovAtel,
/// coarse levelling for Trimble; INS 0 is no alignment for the former, two antennas alone for Trimble, an IMU
/// in order for OxTS. So the accuracy decides where it can. There is no heading where it is empty, where it
/// is not known to half a turn, where GNSS is 0 and INS is 0 or not there, or where INS is 0 and no accuracy
/// is told. An aligned system without satellites is under water and keeps its heading.
///
/// The other sentences that begin with $PASHR and a word (Ashtech), or with $PSAT, carry no sample, nor do
/// HDT, HDG and THS: one instrument's heading would count twice. A line with several of the above is followed
/// by the best of them that has a heading.
[[nodiscard]] std::unique_ptr<Codec> make_nmea_attitude(const CodecOptions& options);

}  // namespace fathom::codec
