#include "health/navigation/alignment_watch.hpp"

#include <algorithm>
#include <cstring>

#include "health/text.hpp"
#include "samples/alignment/help.hpp"

namespace fathom::health {
namespace {

/// Names come from the network.
constexpr std::size_t kMostNoisy = 64;

}  // namespace

void AlignmentWatch::add(const AlignmentStatus& status, const Instant& now) {
  last_ = status;
  last_known_ = true;
  last_ns_ = now.monotonic_ns;
  for (const NoiseFactor& one : noise_factors(status))
    if (noisy_.size() < kMostNoisy &&
        std::find(noisy_.begin(), noisy_.end(), Name(one.sensor)) == noisy_.end())
      noisy_.emplace_back(one.sensor);
  for (const FoundBias& one : found_biases(status))
    if (std::find(biased_.begin(), biased_.end(), one.axis) == biased_.end()) biased_.push_back(one.axis);
  const bool nav_speaks = nav_heard_ && now.monotonic_ns - nav_heard_ns_ < kNsPerSecond;
  if (!nav_speaks) phase(status.phase, now);
}

void AlignmentWatch::add(const NavState& state, const Instant& now) {
  nav_heard_ = true;
  nav_heard_ns_ = now.monotonic_ns;
  phase(state.alignment, now);
}

void AlignmentWatch::phase(AlignmentPhase phase, const Instant& now) {
  if (!heard_) {
    heard_ = true;
    heard_since_ns_ = now.monotonic_ns;
  }
  if (phase == AlignmentPhase::aligned) {
    ever_aligned_ = true;
  } else if (phase_ == AlignmentPhase::aligned) {
    lost_since_ns_ = now.monotonic_ns;
  }
  phase_ = phase;
}

std::string AlignmentWatch::unmet() const {
  if (!last_known_) return "";
  const auto count = std::min<std::size_t>(last_.condition_count, AlignmentStatus::kMaxConditions);
  for (std::size_t i = 0; i < count; ++i) {
    const AlignmentCondition& condition = last_.conditions[i];
    if (!condition.met) {
      const std::string help(help_of(condition));
      return sentence(", waiting for %s: %.3g, limit %.3g%s%s", condition.name.c_str(), condition.value,
                      condition.limit, help.empty() ? "" : "; ", help.c_str());
    }
  }
  return "";
}

void AlignmentWatch::report(AlarmBook& book, const Instant& now) const {
  const bool aligned = phase_ == AlignmentPhase::aligned;
  const std::string phase_word(to_string(phase_));
  const double waiting_s = heard_ ? to_seconds(now.monotonic_ns - heard_since_ns_) : 0.0;
  const bool timed_out = phase_ == AlignmentPhase::timed_out;
  book.set(heard_ && !ever_aligned_ && (timed_out || waiting_s > config_.limit_s),
           {.key = "not_aligned",
            .severity = Severity::warning,
            .text = sentence("Navigation is not aligned after %s: phase %s%s (limit %s).",
                             duration_text(waiting_s).c_str(), phase_word.c_str(), unmet().c_str(),
                             duration_text(config_.limit_s).c_str()),
            .value = waiting_s,
            .limit = config_.limit_s,
            .began_ago_s = waiting_s},
           now);
  // It comes once a second, like a life sign.
  const bool fresh = last_known_ && fresh_.of_service(last_ns_, now);
  const AlignmentCondition* wrong = fresh ? implausible(last_) : nullptr;
  book.set(wrong != nullptr,
           {.key = "implausible",
            .severity = Severity::critical,
            .text = std::string(last_.advice.data(), strnlen(last_.advice.data(), last_.advice.size())),
            .value = wrong != nullptr ? wrong->value : 0.0},
           now);
  report_noise(fresh, book, now);
  report_biases(fresh, book, now);
  const double lost_s = ever_aligned_ && !aligned ? to_seconds(now.monotonic_ns - lost_since_ns_) : 0.0;
  book.set(ever_aligned_ && !aligned,
           {.key = "alignment_lost",
            .severity = Severity::critical,
            .text = sentence("Alignment was lost %s ago: phase %s%s.", duration_text(lost_s).c_str(),
                             phase_word.c_str(), unmet().c_str()),
            .value = lost_s,
            .began_ago_s = lost_s,
            .clear_hold_s = config_.regain_hold_s},
           now);
}

void AlignmentWatch::report_noise(bool fresh, AlarmBook& book, const Instant& now) const {
  const std::vector<NoiseFactor> factors = noise_factors(last_);
  for (const Name& sensor : noisy_) {
    const auto found = std::find_if(factors.begin(), factors.end(),
                                    [&](const NoiseFactor& one) { return one.sensor == sensor.view(); });
    const double factor = found == factors.end() ? 1.0 : found->factor;
    const char* const text =
        is_inertial(sensor.view())
            ? "The motion strays as if the noise of the %s were %.1f times what is configured. Navigation "
              "counts with that."
            : "%s scatters %.1f times as much as its sigmas say. Navigation counts with that.";
    book.set(fresh && factor > 1.0,
             {.key = alarm_key("noisy", sensor.view()),
              .severity = Severity::notice,
              .text = sentence(text, sensor.c_str(), factor),
              .value = factor},
             now);
  }
}

void AlignmentWatch::report_biases(bool fresh, AlarmBook& book, const Instant& now) const {
  const std::vector<FoundBias> biases = found_biases(last_);
  for (const std::string_view axis : biased_) {
    const auto found =
        std::find_if(biases.begin(), biases.end(), [&](const FoundBias& one) { return one.axis == axis; });
    const FoundBias one = found == biases.end() ? FoundBias{axis} : *found;
    book.set(fresh && found != biases.end(),
             {.key = alarm_key("biased", axis),
              .severity = Severity::notice,
              .text = sentence("The %s. Navigation counts with the bias.", one.text().data()),
              .value = one.in_unit(one.value)},
             now);
  }
}

}  // namespace fathom::health
