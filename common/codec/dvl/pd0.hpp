#pragma once

#include <memory>

#include "codec/registry.hpp"

namespace fathom::codec {

/// Teledyne RDI PD0 ensembles (Workhorse, Explorer, Pathfinder, Tasman and whatever else writes them).
///
/// Bottom track gives a DvlSample of mode bottom, with unknown velocity while the instrument has no lock;
/// a valid water-layer velocity gives a second one of mode water. Ensembles without bottom track and wave
/// packets (7F 79) are good frames without sample. Unknown data types are skipped.
///
/// PD0 states the velocity of the bottom relative to the DVL: the sample's velocity is its negative, in
/// forward-right-down axes. By recorded frame:
///  - ship: starboard, forward, mast. The instrument has applied its heading alignment (EA) and tilts.
///  - instrument: X right, Y forward (beam 3), Z up of a downward-looking DVL; of an upward-looking one X and
///    Z point the other way. Turned about down by CodecOptions::dvl_heading_alignment_rad, the angle from the
///    vehicle's forward to beam 3, clockwise seen from above.
///  - beam: as instrument, after the Janus transformation with the fixed leader's beam angle. The recorded
///    beam velocity, positive towards the transducer, is the vehicle's velocity along the outward beam
///    direction d: the bottom moves with -v, and towards the transducer means along -d. Three good beams give
///    the whole velocity, two opposite ones what they measure.
///  - earth: east, north, up, turned back with heading, pitch and roll of the variable leader. The pitch of a
///    pendulum is not the pitch angle: pitch = atan(tan(recorded) cos(roll)), as the instrument itself does.
/// roll_rad, pitch_rad and heading_rad are as recorded.
///
/// A known velocity without error velocity is a three-beam solution. sigma_m_s is known where the instrument
/// sends navigation parameters (0x2013), and sqrt(3) times larger for three beams. beam_range_m is vertical
/// range along each beam. High-resolution velocities (0x5803) refine those of 0x0600 which they agree with.
///
/// Time: the real-time clock (four-digit year where present) as free-running clock.
[[nodiscard]] std::unique_ptr<Codec> make_pd0(const CodecOptions& options);

}  // namespace fathom::codec
