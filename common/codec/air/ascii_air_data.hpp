#pragma once

#include <memory>

#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::codec {

/// Air data as columns of text, one line a report, as air-data computers send them.
///
/// A line is the prefix, the configured columns with the separator between them, and `*hh`, the exclusive or
/// of all characters before the star but a leading `$`. By default: indicated airspeed in knots, pressure
/// altitude in feet, static air temperature in degC, e.g. `97.4,2950,8.5*12`. Lines that begin otherwise are
/// good and carry no sample. A blank column is unknown. Another number of columns is `structure`, what is no
/// decimal number `field`, a line without checksum `no_checksum` where one is required; a checksum that is
/// there has to be right in any case.
[[nodiscard]] std::unique_ptr<Codec> make_ascii_air_data(const CodecOptions& options);

}  // namespace fathom::codec
