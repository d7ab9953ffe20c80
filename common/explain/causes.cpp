#include <algorithm>
#include <array>

#include "explain/explain.hpp"
#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

// An effect may be noticed a little before its cause, whose instant is that of a life sign or of a whole
// second, and begin while navigation still recovers from it.
constexpr DurationNs kBefore_ns = 3 * kNsPerSecond;
constexpr DurationNs kAfter_ns = 15 * kNsPerSecond;

/// Causes that touch every source.
bool touches_all(const Finding& cause) {
  switch (cause.kind) {
    case Kind::restart:
    case Kind::stalled:
    case Kind::takeover:
    case Kind::imu_late:
    case Kind::imu_gap:
    case Kind::not_aligned:
    case Kind::wrong_heading:
      return true;
    case Kind::clock_jump:
    case Kind::second_writer:
      return cause.word == "imu" || cause.subject == "imu";
    default:
      return false;
  }
}

bool is_effect(Kind kind) {
  return kind == Kind::alignment_lost || kind == Kind::state_gap || kind == Kind::reset ||
         kind == Kind::growth;
}

bool may_bring_about(const Finding& cause, const Finding& effect) {
  // A thing again is the same thing.
  const bool again =
      cause.kind == effect.kind && cause.subject == effect.subject && cause.begin_ns < effect.begin_ns;
  if (cause.kind >= effect.kind && !again) return false;
  if (cause.weight == Weight::note && effect.weight != Weight::note) return false;
  if (cause.kind == Kind::clock_set) return false;  // stamps are not moved by it
  // A service that is started again is silent; that is no effect of what its sensors said.
  if (effect.kind == Kind::takeover || effect.kind == Kind::second_writer) return false;
  // It was there before: a thing of the whole log.
  if (effect.begin_ns < cause.begin_ns - kBefore_ns || effect.begin_ns > cause.end_ns + kAfter_ns)
    return false;
  if (effect.kind == Kind::restart || effect.kind == Kind::stalled)
    return cause.kind == Kind::takeover && effect.subject == cause.word;
  // A service that is none of fusion's touches its own sensors, whose names begin as its own does.
  if ((cause.kind == Kind::restart || cause.kind == Kind::stalled) && !(cause.figure("fusion") > 0.0)) {
    constexpr std::string_view kBridge = "_bridge";
    if (!cause.subject.ends_with(kBridge)) return false;
    const std::string role = cause.subject.substr(0, cause.subject.size() - kBridge.size());
    return effect.subject.starts_with(role) || (role == "imu" && effect.kind != Kind::lost) ||
           is_effect(effect.kind);
  }
  if (is_effect(effect.kind)) return cause.kind != Kind::interference || effect.kind != Kind::state_gap;
  return touches_all(cause) || cause.subject == effect.subject;
}

/// A cause weighs as much as what it brings about.
void weigh(Findings& all) {
  for (const Finding& one : all)
    if (one.follows_from) {
      Finding& root = all[*one.follows_from];
      root.weight = std::min(root.weight, one.weight);
    }
}

void link(Findings& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (!may_bring_about(all[k], all[i])) continue;
      // Of several the one that comes first in the order of causes, and the nearest before of one kind.
      const auto& chosen = all[i].follows_from;
      if (!chosen || all[k].kind < all[*chosen].kind ||
          (all[k].kind == all[*chosen].kind && all[k].begin_ns > all[*chosen].begin_ns &&
           all[k].begin_ns <= all[i].begin_ns))
        all[i].follows_from = k;
    }
  }
  // An effect of an effect is one of its cause.
  for (Finding& one : all)
    while (one.follows_from && all[*one.follows_from].follows_from)
      one.follows_from = all[*one.follows_from].follows_from;
  weigh(all);
}

Findings in_order(Findings all) {
  std::vector<std::size_t> order(all.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto rank = [&](std::size_t i) {
    const Finding& one = all[i];
    // Takeover and restart stand beside each other: what came first goes first.
    const Kind kind = one.kind == Kind::restart ? Kind::takeover : one.kind;
    return std::tuple(one.follows_from.has_value(), one.weight, kind, one.begin_ns);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  std::vector<std::size_t> place(all.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  Findings out;
  for (const std::size_t i : order) {
    out.push_back(std::move(all[i]));
    if (out.back().follows_from) out.back().follows_from = place[*out.back().follows_from];
  }
  return out;
}

}  // namespace

Findings findings(const History& history) {
  const Track track(history);
  Findings all;
  watch_clocks(history, all);
  watch_writers(history, all);
  watch_inertial(history, all);
  watch_alignment(history, all);
  watch_receivers(history, all);
  watch_refusals(history, track, all);
  watch_noise(history, all);
  watch_biases(history, all);
  watch_course(history, track, all);
  watch_lever(history, track, all);
  watch_losses(history, track, all);
  watch_states(history, track, all);
  link(all);
  return in_order(std::move(all));
}

}  // namespace fathom::explain
