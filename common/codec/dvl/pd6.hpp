#pragma once

#include <memory>

#include "codec/registry.hpp"

namespace fathom::codec {

/// Teledyne's PD6, lines of text (Pathfinder DVL Guide 95B-6116, "Special Output Data Formats", Table 50),
/// and PD13, which has the ranges of the beams besides. Wayfinder, Water Linked, NavQuest and others speak it
/// too.
///
/// A ping is a group of lines: attitude :SA, time :TS, water :WI :WS :WE :WD, bottom :BI :BS :BE :BD. It
/// begins with :SA or :TS, or with a line that the group has already. Its samples are delivered with the line
/// that ended most of the last pings (:BD until that is known), so that nothing waits for the next ping; what
/// that line does not end, the next ping does. A sample's frame reaches from the first of its lines to the
/// last. A line ends at CR, LF or the `:` of the next one. There is no checksum: the count of fields, the
/// shape of every number and its range are checked, and a refused line is lost alone. Lines without a
/// velocity, and others (:HM, :RA), are good frames that carry no sample of their own.
///
/// Bottom track gives a DvlSample of mode bottom, with unknown velocity while the instrument has no lock; a
/// good velocity through the water gives a second one of mode water. A status other than A (V; I of a
/// NavQuest) is bad whatever the numbers say, and -32768 is unknown. A known velocity without error velocity
/// is a three-beam solution.
///
/// PD6 states the velocity of the vessel, the opposite of PD0. In forward-right-down axes, by frame, of which
/// the first that is sent counts:
///  - instrument (:BI, :WI): X from beam 1 to beam 2, Y from beam 4 to beam 3, Z away from the bottom. These
///    are right, forward and up of a downward-looking DVL, turned about down by
///    CodecOptions::dvl_heading_alignment_rad as in make_pd0.
///  - ship (:BS, :WS): transverse to starboard, longitudinal forward, normal away from the bottom. The
///    instrument has applied its heading alignment.
///  - earth (:BE, :WE): east, north, up, turned back with the attitude of :SA, without which it is refused.
/// Water Linked sends its vehicle frame, forward, right, down, as :BI ("DVL PD formats" and "Axes" of its
/// documentation), and no attitude. It is known by its :BE, which it marks bad with zeros in place of -32768.
///
/// altitude_m is the range to the bottom of :BD. Depth, temperature, salinity and distances made good are not
/// handed on. roll_rad, pitch_rad and heading_rad are as recorded. Time: that of :TS as free-running clock.
[[nodiscard]] std::unique_ptr<Codec> make_pd6(const CodecOptions& options);

}  // namespace fathom::codec
