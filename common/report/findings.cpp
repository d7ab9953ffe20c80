#include <algorithm>
#include <cmath>

#include "base/units.hpp"
#include "report/material.hpp"
#include "report/plot.hpp"

namespace fathom::report {
namespace {

using Weight = Finding::Weight;

// What is worth a sentence. Bounds of attention, not of acceptance.
constexpr std::uint64_t kEnough = 30;  // measurements, before shares mean anything
constexpr double kManyRejected = 0.05;
constexpr double kMostRejected = 0.15;
constexpr double kBiased_sigmas = 0.5;
constexpr double kTooWide = 1.5;  // root mean square of what should be 1
constexpr double kTooNarrow = 0.35;
constexpr double kFewInside = 0.85;  // of 0.95
constexpr double kLongGap = 5.0;     // times the step of the inertial samples

std::string percent(double share) {
  return brief(100.0 * share) + " %";
}

std::string seconds(double t_s) {
  return brief(t_s) + " s";
}

std::string name_of(const Source& source) {
  return source.model.empty() ? source.sensor : source.sensor + " (" + source.model + ")";
}

class Judge {
 public:
  explicit Judge(const Material& material) : m_(material) {}

  std::vector<Finding> all() {
    position();
    alignment();
    // Causes before what follows from them.
    inertial();
    for (const Source& source : m_.sources) measurement(source);
    biases();
    noise();
    consistency();
    outages();
    resets();
    unused();
    std::stable_sort(out_.begin(), out_.end(),
                     [](const Finding& a, const Finding& b) { return a.weight < b.weight; });
    if (out_.empty()) {
      say(Weight::good,
          "Nothing stands out: measurements agree with what navigation expected of them, and "
          "nothing was missing for long.",
          "innovations");
    }
    return std::move(out_);
  }

 private:
  void say(Weight weight, std::string text, std::string anchor) {
    out_.push_back({weight, std::move(text), std::move(anchor)});
  }

  void position() {
    const bool any = std::any_of(m_.states.begin(), m_.states.end(),
                                 [](const StateRow& row) { return known(row.latitude_rad); });
    if (any) return;
    say(Weight::bad,
        "Navigation never had a position. Look at the alignment, and whether GPS or a start position was "
        "there.",
        "alignment");
  }

  void alignment() {
    const auto aligned = std::find_if(m_.phases.begin(), m_.phases.end(), [](const PhaseChange& one) {
      return one.phase == AlignmentPhase::aligned;
    });
    const double length_s = m_.end_s - m_.begin_s;
    if (m_.start_heading_error_rad != 0.0)
      say(Weight::caution,
          "The heading of the start was wrong by " + brief(m_.start_heading_error_rad * kDegPerRad) +
              " deg, and was corrected once the way by GPS showed it. Look at iron near the compass, or at " +
              "the heading that was given.",
          "alignment");
    if (aligned == m_.phases.end()) {
      say(Weight::bad,
          "Alignment was never finished in " + seconds(length_s) + ": heading and tilt stayed coarser than " +
              "the configuration asks for.",
          "alignment");
    } else if (aligned->t_s - m_.begin_s > 0.3 * length_s) {
      say(Weight::caution,
          "Alignment took " + seconds(aligned->t_s - m_.begin_s) + " of " + seconds(length_s) + ".",
          "alignment");
    }
    for (const PhaseChange& one : m_.phases) {
      if (one.phase != AlignmentPhase::lost && one.phase != AlignmentPhase::timed_out) continue;
      say(Weight::bad,
          "At " + seconds(one.t_s) + " alignment was " +
              (one.phase == AlignmentPhase::lost ? "lost" : "given up") + ".",
          "alignment");
      break;
    }
  }

  void consistency() {
    const dataset::Nees& nees = m_.score.nees_horizontal;
    if (nees.count < kEnough) return;
    const std::string error = "Against the reference the horizontal error is " +
                              brief(m_.score.horizontal_m.rms) + " m (root mean square), " +
                              brief(m_.score.horizontal_m.max) + " m at most. ";
    if (nees.mean > nees.band_95[1]) {
      say(Weight::bad,
          error + "Navigation believes to be far better than it is: NEES is " + brief(nees.mean) +
              " in the mean, expected about 2, and largest at " + seconds(worst_nees_s()) +
              ". Sigmas cannot be trusted here.",
          "nees");
    } else if (nees.mean > 4.0) {
      say(Weight::caution,
          error + "The sigmas are too small: NEES is " + brief(nees.mean) + " in the mean, expected about 2.",
          "nees");
    } else if (nees.mean < 0.2) {
      say(Weight::caution,
          error + "The sigmas are larger than they need be: NEES is " + brief(nees.mean) +
              " in the mean, expected about 2.",
          "nees");
    }
  }

  [[nodiscard]] double worst_nees_s() const {
    double most = -1.0;
    double at_s = kUnknown;
    for (const ErrorRow& row : m_.errors) {
      if (!(row.error.nees_horizontal > most)) continue;
      most = row.error.nees_horizontal;
      at_s = row.t_s;
    }
    return at_s;
  }

  void measurement(const Source& source) {
    // A measurement that no model has seen is still one of its sensor.
    std::uint64_t total = 0;
    for (const Source& one : m_.sources)
      if (one.kind == source.kind && one.sensor == source.sensor) total += one.total();
    if (total < kEnough) return;
    const auto share = [&](std::uint64_t count) {
      return static_cast<double>(count) / static_cast<double>(total);
    };
    const double rejected = share(source.of(VerdictKind::rejected) + source.of(VerdictKind::disputed));
    const std::string who = name_of(source) + ": ";
    if (rejected > kManyRejected) {
      say(rejected > kMostRejected ? Weight::bad : Weight::caution,
          who + percent(rejected) + " of " + std::to_string(total) + " measurements were rejected" +
              worst_time(source) + ". Either they or navigation were wrong then.",
          "innovations");
    }
    struct Reason {
      VerdictKind kind;
      const char* text;
    };
    for (const Reason& reason :
         {Reason{VerdictKind::late, "came too late to be used: look at delays and clocks"},
          Reason{VerdictKind::frozen, "repeated a value while the vehicle moved: the instrument may hang"},
          Reason{VerdictKind::out_of_range,
                 "held no value that can be used: the instrument had none (no bottom lock, no fix), or units "
                 "are "
                 "wrong"},
          Reason{VerdictKind::duplicate, "were duplicates: the same data may come twice"},
          Reason{VerdictKind::from_the_future, "were stamped in the future: look at clocks"},
          Reason{VerdictKind::unknown_frame, "were in a frame that is not configured"}}) {
      const std::uint64_t count = source.of(reason.kind);
      if (share(count) > 0.01)
        say(share(count) > 0.2 ? Weight::bad : Weight::caution,
            who + std::to_string(count) + " of " + std::to_string(total) + " measurements " + reason.text +
                ".",
            "innovations");
    }
    // Rejections are told already.
    if (rejected <= kManyRejected) spread(source);
  }

  void biases() {
    for (const FoundBias& one : m_.biases)
      say(Weight::caution,
          std::string("The ") + one.text().data() +
              ". Navigation counts with the bias. Look at the inertial unit, or at its sigma in the "
              "configuration.",
          "innovations");
  }

  void noise() {
    for (const auto& [sensor, factor] : m_.noise_factors)
      say(Weight::caution,
          "The noise of " + sensor + " was up to " + brief(factor) +
              " times what is configured. Navigation " +
              "counted with that. Look at the instrument, or at its sigma in the configuration.",
          "innovations");
  }

  void spread(const Source& source) {
    const InnovationTally& figures = source.innovations;
    if (source.of(VerdictKind::used) < kEnough || figures.components() < kEnough) return;
    const std::string who = name_of(source) + ": ";
    for (std::size_t i = 0; i < InnovationTally::kComponents; ++i) {
      if (!(std::abs(figures.used_mean(i)) > kBiased_sigmas)) continue;
      say(Weight::caution,
          who + "innovations of component " + std::to_string(i + 1) + " are " + brief(figures.used_mean(i)) +
              " sigmas in the mean, expected 0. A lever, a mounting angle, a scale, a latency or an offset "
              "may be "
              "wrong.",
          "innovations");
      break;
    }
    if (figures.used_rms() > kTooWide && figures.share_within_95() >= kFewInside) {
      say(Weight::caution,
          who +
              "most innovations are as their sigmas say, and a few that were used lie far outside (root mean "
              "square " +
              brief(figures.used_rms()) + " sigmas, expected 1). Look at these.",
          "innovations");
    } else if (figures.share_within_95() < kFewInside) {
      say(Weight::caution,
          who + "innovations scatter more than their sigmas say (" + percent(figures.share_within_95()) +
              " lie within their 95 %). The configured sigma may be too small.",
          "innovations");
    } else if (figures.used_rms() < kTooNarrow) {
      say(Weight::caution,
          who + "innovations scatter " + brief(figures.used_rms()) +
              " of what their sigmas say. The configured sigma may be too large.",
          "innovations");
    }
  }

  // The ten seconds with the most rejections.
  static std::string worst_time(const Source& source) {
    std::size_t first = 0;
    std::size_t most = 0;
    double at_s = 0.0;
    std::vector<double> times;
    for (const Judged& one : source.judged)
      if (one.kind == VerdictKind::rejected || one.kind == VerdictKind::disputed) times.push_back(one.t_s);
    for (std::size_t i = 0; i < times.size(); ++i) {
      while (times[i] - times[first] > 10.0) ++first;
      if (i - first + 1 <= most) continue;
      most = i - first + 1;
      at_s = times[first];
    }
    return most > 0 ? ", most of them around " + seconds(at_s) : "";
  }

  void unused() {
    for (const auto& [word, count] : m_.samples) {
      if (word == "imu" || word == "altimeter" || count < kEnough) continue;
      std::uint64_t used = 0;
      std::uint64_t disabled = 0;
      for (const Source& source : m_.sources) {
        if (to_string(source.kind) != word) continue;
        used += source.of(VerdictKind::used);
        disabled += source.of(VerdictKind::source_disabled);
      }
      if (used > 0) continue;
      say(disabled > 0 ? Weight::caution : Weight::bad,
          word + ": none of " + std::to_string(count) + " samples was used" +
              (disabled > 0 ? ": the configuration has no enabled sensor of this name." : "."),
          "innovations");
    }
  }

  void outages() {
    const auto longest = std::max_element(
        m_.outages.begin(), m_.outages.end(),
        [](const Outage& a, const Outage& b) { return a.end_s - a.begin_s < b.end_s - b.begin_s; });
    if (longest == m_.outages.end()) return;
    const double length_s = longest->end_s - longest->begin_s;
    std::string text = "The longest time without GPS was " + seconds(length_s) + " from " +
                       seconds(longest->begin_s) + " on";
    if (known(longest->sigma_after_m))
      text += "; the horizontal sigma went from " + brief(longest->sigma_before_m) + " to " +
              brief(longest->sigma_after_m) + " m";
    if (known(longest->error_m)) text += ", the error at its end was " + brief(longest->error_m) + " m";
    say(Weight::caution, text + ".", "outages");
    std::size_t checked = 0;
    std::size_t beyond = 0;
    for (const Outage& one : m_.outages) {
      if (!known(one.error_m) || !known(one.forecast_95_m)) continue;
      ++checked;
      beyond += one.error_m > one.forecast_95_m ? 1U : 0U;
    }
    if (beyond > 0 && static_cast<double>(beyond) > 0.15 * static_cast<double>(checked)) {
      say(Weight::bad,
          "In " + std::to_string(beyond) + " of " + std::to_string(checked) +
              " outages the error passed the 95 % that was forecast when they began.",
          "outages");
    }
  }

  void inertial() {
    if (m_.imu_gaps.empty()) return;
    const auto longest = std::max_element(m_.imu_gaps.begin(), m_.imu_gaps.end(),
                                          [](const auto& a, const auto& b) { return a[1] < b[1]; });
    say((*longest)[1] > 1.0 ? Weight::bad : Weight::caution,
        "Inertial samples are missing " + std::to_string(m_.imu_gaps.size()) + " times for more than " +
            brief(kLongGap) + " steps; longest " + seconds((*longest)[1]) + " at " + seconds((*longest)[0]) +
            ".",
        "sigmas");
  }

  void resets() {
    if (m_.states.empty() || m_.states.back().resets == 0) return;
    const std::uint32_t count = m_.states.back().resets;
    say(Weight::caution,
        "The position stepped " + std::to_string(count) + (count == 1 ? " time" : " times") +
            " without motion: navigation was put right at once.",
        "track");
  }

  const Material& m_;
  std::vector<Finding> out_;
};

}  // namespace

std::vector<Finding> findings(const Material& material) {
  return Judge(material).all();
}

}  // namespace fathom::report
