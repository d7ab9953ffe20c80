#include "codec/text/json_object.hpp"

namespace fathom::codec {
namespace {

constexpr int kMaxDepth = 8;

}  // namespace

Probe probe_json_object(Bytes front) {
  std::size_t n = 0;
  while (n < front.size() && front[n] != '{') ++n;
  if (n > 0) return Probe::skip(n);
  int depth = 0;
  bool in_string = false;
  bool escaped = false;
  bool line_start = false;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const std::uint8_t c = front[i];
    const bool line_end = c == '\n' || c == '\r';
    if (in_string) {
      if (c < 0x20) return Probe::bad(line_end ? RejectReason::length : RejectReason::structure, i, i);
      if (escaped) {
        escaped = false;
      } else if (c == '\\') {
        escaped = true;
      } else if (c == '"') {
        in_string = false;
      }
      continue;
    }
    if (c == '{' && line_start) return Probe::bad(RejectReason::length, i, i);
    line_start = line_end;
    if ((c < 0x20 && !line_end && c != '\t') || c > 0x7E) return Probe::bad(RejectReason::structure, i, i);
    if (c == '"') in_string = true;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > kMaxDepth) return Probe::bad(RejectReason::structure, i, i);
    if (depth == 0) return Probe::frame(i + 1);
  }
  return Probe::need();
}

}  // namespace fathom::codec
