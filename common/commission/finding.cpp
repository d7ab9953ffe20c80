#include "commission/finding.hpp"

#include <algorithm>
#include <array>

namespace fathom::commission {

std::string_view to_string(FindingKind kind) {
  static constexpr std::array<std::string_view, 15> kWords{
      "axes",  "sign",        "unit", "rate",  "convention", "mounting", "lever",  "latency",
      "noise", "instability", "bias", "scale", "deviation",  "datum",    "missing"};
  return kWords[static_cast<std::size_t>(kind)];
}

std::string_view to_string(Severity severity) {
  switch (severity) {
    case Severity::ok:
      return "ok";
    case Severity::note:
      return "note";
    case Severity::wrong:
      return "wrong";
  }
  return "ok";
}

bool any_wrong(const Findings& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.severity == Severity::wrong; });
}

}  // namespace fathom::commission
