#pragma once

#include <memory>

#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::codec {

/// EvoLogics S2C acoustic modems with a USBL head: the notification USBLLONG, an acoustic fix of another
/// modem.
///
///     +++AT:132:USBLLONG,1325384364.662679,1325384364.401149,2,0.0234,0.3407,-0.1417,-0.3286,0.0800,-0.1494,
///         -0.0178,0.1164,1.3498,247,-16,388,0.0116
///
/// The device's clock when the line was sent and when the place was measured, s; the address of the other
/// modem; its place from the head along the head's axes (x, y, z) and along east, north, up, m; roll, pitch
/// and yaw of the head, rad; travel time one way, us; signal strength and integrity; accuracy, m. The head's
/// axes are forward, left, up, and its angles turn them into east, north, up: in what devices have sent
/// (tests/vectors/evologics), ENU = Rz(yaw) Ry(pitch) Rx(roll) XYZ to the last digit but one. A line
/// whose two places are not equally far away is refused.
///
/// Who carries the head decides what a fix is (UsblOptions): on a station, the place of the vehicle's modem
/// from there along north, east, down; on the vehicle, the place of a beacon's modem along the vehicle's
/// axes, with the beacon's own place where it is configured. The accuracy is taken as the sigma of one axis,
/// 0 as unknown, and not below `sigma_floor_m`. The sample is as old as the two instants of the line say.
///
/// A line begins with `+++AT:` and the number of characters that follow, or, where the modem is set so, with
/// its first word; only the former shows damage, for neither has a checksum. USBLANGLES has no range and
/// gives no sample, as any other notification, and payload is passed over by its length.
[[nodiscard]] std::unique_ptr<Codec> make_evologics(const CodecOptions& options);

}  // namespace fathom::codec
