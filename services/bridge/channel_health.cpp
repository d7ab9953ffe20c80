#include "bridge/channel_health.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "base/unknown.hpp"

namespace fathom::bridge {
namespace {

// Half of the expected samples is slow; less than that much of the bytes being frames is babble.
constexpr double kSlowFraction = 0.5;
constexpr double kBabbleFraction = 0.5;
constexpr std::size_t kMostMarks = 600;

template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

}  // namespace

ChannelHealth::ChannelHealth(double rate_hz, double stale_after_s, double first_sample_s, TimeNs now_ns)
    : rate_hz_(rate_hz),
      stale_after_s_(stale_after_s),
      first_sample_s_(first_sample_s),
      window_s_(rate_hz > 0.0 ? std::max(5.0, 10.0 / rate_hz) : 60.0),
      start_ns_(now_ns) {}

double ChannelHealth::rate_hz() const {
  if (marks_.size() < 2) return kUnknown;
  const double span_s = to_seconds(marks_.back().at_ns - marks_.front().at_ns);
  return span_s > 0.0 ? static_cast<double>(marks_.back().samples - marks_.front().samples) / span_s
                      : kUnknown;
}

std::optional<std::string> ChannelHealth::judge(const ChannelTotals& totals, TimeNs now_ns) {
  // The silence before the first sample is no part of its rate.
  if (!marks_.empty() && marks_.back().samples == 0 && totals.samples > 0) marks_.clear();
  marks_.push_back({now_ns, totals.bytes, totals.waste_bytes, totals.samples});
  while (marks_.size() > 2 &&
         (to_seconds(now_ns - marks_.front().at_ns) > window_s_ || marks_.size() > kMostMarks)) {
    marks_.pop_front();
  }
  const double silent_s = to_seconds(now_ns - totals.last_sample_ns.value_or(start_ns_));
  const bool just_started = !totals.last_sample_ns && silent_s < stale_after_s_;
  const bool not_yet_due = !totals.last_sample_ns && silent_s < first_sample_s_;
  if (totals.state == runtime::SourceState::finished) return totals.detail;
  if (totals.state == runtime::SourceState::lost || totals.state == runtime::SourceState::silent) {
    if (just_started) return std::nullopt;
    if (not_yet_due && totals.state == runtime::SourceState::silent) return std::nullopt;
    return totals.detail;
  }

  const Mark& first = marks_.front();
  const Mark& last = marks_.back();
  const auto bytes = static_cast<double>(last.bytes - first.bytes);
  const auto waste = std::min(bytes, static_cast<double>(last.waste - first.waste));
  const double span_s = to_seconds(last.at_ns - first.at_ns);
  // A whole window is needed: fewer seconds say little about a rate.
  const bool full = span_s > 0.8 * window_s_;
  const bool slow = full && rate_hz() < kSlowFraction * rate_hz_;
  const bool stale = silent_s > stale_after_s_;
  if ((slow || stale) && waste > kBabbleFraction * bytes) {
    return format("garbage: %.0f of the last %.0f bytes belong to no good frame", waste, bytes);
  }
  if (not_yet_due) return std::nullopt;
  if (stale) return format("no usable sample for %.1f s", silent_s);
  if (slow) return format("slow: %.2f Hz instead of %.2f Hz", rate_hz(), rate_hz_);
  return std::nullopt;
}

}  // namespace fathom::bridge
