#include "explain/finding.hpp"

#include <array>

namespace fathom::explain {

std::string_view to_string(Kind kind) {
  static constexpr std::array<std::string_view, kKinds> kWords{
      "clock_set", "clock_jump", "second_writer",  "takeover",      "restart",      "stalled",
      "imu_late",  "imu_gap",    "not_aligned",    "wrong_heading", "interference", "frozen",
      "jump",      "drag",       "outliers",       "noisy",         "biased",       "wrong_lever",
      "lost",      "refused",    "alignment_lost", "state_gap",     "reset",        "growth"};
  const auto number = static_cast<std::size_t>(kind);
  return number < kWords.size() ? kWords[number] : "?";
}

std::string_view to_string(Weight weight) {
  switch (weight) {
    case Weight::bad:
      return "bad";
    case Weight::caution:
      return "caution";
    case Weight::note:
      return "note";
  }
  return "?";
}

double Finding::figure(std::string_view name) const {
  for (const Figure& one : figures)
    if (one.name == name) return one.value;
  return kUnknown;
}

bool began_nearer(const Finding& one, const Finding& other, TimeNs at_ns) {
  const auto before = [&](const Finding& it) { return it.begin_ns <= at_ns + kNsPerSecond; };
  if (before(one) != before(other)) return before(one);
  return before(one) ? one.begin_ns > other.begin_ns : one.begin_ns < other.begin_ns;
}

}  // namespace fathom::explain
