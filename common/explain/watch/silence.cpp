#include "explain/watch/silence.hpp"

#include <algorithm>

namespace fathom::explain {
namespace {

// Services that are stopped together end one behind the other, each within this.
constexpr DurationNs kOrderly_ns = 5 * kNsPerSecond;

/// The name of who last gave samples of an instrument, without its process.
std::string writer_of(const History& history, const Stream& stream) {
  if (stream.seconds.empty()) return {};
  const std::string& writer = history.writer(stream.seconds.back().writer);
  return writer.substr(0, writer.find(" ("));
}

/// The last arrival of a sample of another instrument.
TimeNs others_heard_to_ns(const History& history, const Stream& stream) {
  TimeNs out = 0;
  for (const Stream& other : history.streams())
    if (&other != &stream) out = std::max(out, other.last_log_ns);
  return out;
}

}  // namespace

bool goes_on(const History& history, const std::string& service) {
  const auto& signs = history.life_signs();
  const auto last = std::find_if(signs.rbegin(), signs.rend(),
                                 [&](const LifeSign& sign) { return history.name(sign.service) == service; });
  return last != signs.rend() && last->state != ServiceState::stopping;
}

std::vector<Silence> silences(const History& history, const Stream& stream, DurationNs least_ns) {
  std::vector<Silence> out;
  for (const Pause& pause : stream.pauses)
    if (pause.to_ns - pause.from_ns >= least_ns)
      out.push_back({pause.from_ns, pause.to_ns, false, pause.stamps_ns});
  if (stream.samples == 0) return out;
  // Who was told to stop, or said nothing of itself, is missed only where others went on.
  const bool missed = goes_on(history, writer_of(history, stream));
  const TimeNs end_ns = missed ? history.to_ns() : others_heard_to_ns(history, stream);
  const DurationNs length_ns = end_ns - stream.last_log_ns;
  if (length_ns >= (missed ? least_ns : std::max(least_ns, kOrderly_ns)))
    out.push_back({stream.last_log_ns, end_ns, true, length_ns});
  return out;
}

std::string bridge_said(const History& history, const std::string& sensor, TimeNs from_ns, TimeNs to_ns) {
  const std::string head = sensor + ": ";
  constexpr std::string_view kNext = "; ";  // between the instruments of one bridge
  std::string out;
  for (const LifeSign& sign : history.life_signs()) {
    if (sign.log_ns < from_ns || sign.log_ns > to_ns || sign.state != ServiceState::degraded) continue;
    std::size_t at = 0;
    if (!sign.text.starts_with(head)) {
      at = sign.text.find(std::string(kNext) + head);
      if (at == std::string::npos) continue;
      at += kNext.size();
    }
    at += head.size();
    out = history.name(sign.service) + " said: " + sign.text.substr(at, sign.text.find(kNext, at) - at);
  }
  while (out.ends_with('.')) out.pop_back();
  return out;
}

}  // namespace fathom::explain
