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

std::string_view meaning(RejectReason reason) {
  switch (reason) {
    case RejectReason::checksum:
      return "its checksum is wrong";
    case RejectReason::length:
      return "it declares a length that it cannot have, or is longer than any";
    case RejectReason::structure:
      return "it has not the fields that its kind has";
    case RejectReason::field:
      return "a field is not a number, or none of its words";
    case RejectReason::out_of_range:
      return "a number is none that such an instrument can mean";
    case RejectReason::no_checksum:
      return "it has no checksum, expected one";
    case RejectReason::truncated:
      return "the stream ended inside it";
    case RejectReason::incomplete:
      return "a value is missing without which the others mean nothing";
  }
  return "unknown";
}

}  // namespace fathom::codec
