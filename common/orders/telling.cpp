#include "orders/telling.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace fathom::orders {
namespace {

template <class... Values>
std::string text(const char* format, Values... values) {
  std::array<char, 256> out{};
  (void)std::snprintf(out.data(), out.size(), format, values...);
  return out.data();
}

std::string reason(const FixSample& fix, const Verdict& verdict) {
  const double age_s = to_seconds(fix.header.received_ns - fix.header.stamp_ns);
  switch (verdict.kind) {
    case VerdictKind::used:
      return text("%.0f s after its instant", age_s);
    case VerdictKind::rejected:
    case VerdictKind::disputed:
      return "it does not go with what else was measured";
    case VerdictKind::late:
      return text("%.0f s is longer than navigation remembers, or it came long after it was told", age_s);
    case VerdictKind::source_disabled:
      return "the vehicle's configuration has no such source of positions, or it is switched off";
    case VerdictKind::not_aligned:
      return "navigation has no attitude or position to test it against";
    case VerdictKind::duplicate:
      return "a position of this instant was told before";
    case VerdictKind::out_of_range:
      return "it is no position, or its sigma is none";
    case VerdictKind::from_the_future:
      return "its instant has not come yet";
    default:
      return "";
  }
}

}  // namespace

std::string in_words(const FixSample& fix, const Verdict& verdict) {
  std::string out(to_string(verdict.kind));
  if (const std::string why = reason(fix, verdict); !why.empty()) out += ": " + why;
  if (verdict.dimensions >= 2) {
    out += text(
        "; navigation was %.1f m north and %.1f m east of it then, one sigma of that is %.1f m and %.1f m",
        verdict.innovation[0], verdict.innovation[1], verdict.innovation_sigma[0],
        verdict.innovation_sigma[1]);
    out += text(", test ratio %.3g of 1", verdict.test_ratio);
  }
  return out;
}

std::string json_line(const FixSample& fix, const Verdict& verdict) {
  nlohmann::json out{{"verdict", to_string(verdict.kind)},
                     {"reason", reason(fix, verdict)},
                     {"stamp_utc", to_iso8601(fix.header.stamp_ns)},
                     {"told_utc", to_iso8601(fix.header.received_ns)},
                     {"from", fix.header.sensor.str()}};
  if (verdict.dimensions >= 2) {
    out["north_m"] = verdict.innovation[0];
    out["east_m"] = verdict.innovation[1];
    out["sigma_north_m"] = verdict.innovation_sigma[0];
    out["sigma_east_m"] = verdict.innovation_sigma[1];
    out["test_ratio"] = verdict.test_ratio;
  }
  return out.dump();
}

}  // namespace fathom::orders
