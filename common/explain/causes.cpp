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

/// The role of a bridge, with which the names of its sensors begin; empty: it is none.
std::string_view role_of(const Finding& cause) {
  constexpr std::string_view kBridge = "_bridge";
  const std::string_view name = cause.subject;
  if (!name.ends_with(kBridge)) return {};
  return name.substr(0, name.size() - kBridge.size());
}

/// An instrument itself was silent.
bool is_silence(const Finding& one) {
  return (one.kind == Kind::lost || one.kind == Kind::imu_gap) && one.word == "silent";
}

bool is_effect(Kind kind) {
  return kind == Kind::alignment_lost || kind == Kind::state_gap || kind == Kind::reset ||
         kind == Kind::growth;
}

bool may_bring_about(const Finding& cause, const Finding& effect) {
  // A thing again is the same thing; a source may be lost again for another reason.
  const bool again = cause.kind == effect.kind && cause.subject == effect.subject &&
                     cause.begin_ns < effect.begin_ns && effect.kind != Kind::lost && !is_silence(effect);
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
    const std::string_view role = role_of(cause);
    if (role.empty()) return false;
    return effect.subject.starts_with(role) || (role == "imu" && effect.kind != Kind::lost) ||
           is_effect(effect.kind);
  }
  // Whether an instrument talks is no matter of who listens, nor of what it said before.
  if (is_silence(effect)) return cause.subject == effect.subject && cause.kind < Kind::not_aligned;
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

/// Whether a cause explains an effect better than another one does.
bool is_better(const Finding& cause, const Finding& other, const Finding& effect) {
  const auto under_way = [&](const Finding& one) { return one.end_ns + kBefore_ns >= effect.begin_ns; };
  // Of those that touch everything the one that was under way, before one that was just over.
  if (touches_all(cause) && touches_all(other) && under_way(cause) != under_way(other))
    return under_way(cause);
  // Then the one that comes first in the order of causes, and the nearest before of one kind.
  if (cause.kind != other.kind) return cause.kind < other.kind;
  // What navigation does is rather of a service that touches all than of the bridge of one sensor.
  if (is_effect(effect.kind) && touches_all(cause) != touches_all(other) && under_way(cause) &&
      under_way(other))
    return touches_all(cause);
  return began_nearer(cause, other, effect.begin_ns);
}

void link(Findings& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    auto& chosen = all[i].follows_from;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (!may_bring_about(all[k], all[i])) continue;
      if (!chosen || is_better(all[k], all[*chosen], all[i])) chosen = k;
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
    // An inertial unit that is silent now goes before what was the matter with it earlier.
    const bool over = !(one.kind == Kind::imu_gap && one.figure("to_end") > 0.0);
    return std::tuple(one.follows_from.has_value(), one.weight, kind, over, one.begin_ns);
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

bool touches_all(const Finding& cause) {
  switch (cause.kind) {
    case Kind::restart:
    case Kind::stalled:
      return cause.figure("fusion") > 0.0 || role_of(cause) == "imu";
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
