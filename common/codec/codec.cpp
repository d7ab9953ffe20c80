#include "codec/codec.hpp"

namespace fathom::codec {

std::string_view to_string(RejectReason reason) {
  switch (reason) {
    case RejectReason::checksum:
      return "checksum";
    case RejectReason::length:
      return "length";
    case RejectReason::structure:
      return "structure";
    case RejectReason::field:
      return "field";
    case RejectReason::out_of_range:
      return "out_of_range";
    case RejectReason::no_checksum:
      return "no_checksum";
    case RejectReason::truncated:
      return "truncated";
    case RejectReason::incomplete:
      return "incomplete";
  }
  return "unknown";
}

}  // namespace fathom::codec
