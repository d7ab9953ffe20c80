#include "cli/solve/metrics.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "cli/solve/score_text.hpp"
#include "runtime/build_info.hpp"
#include "samples/alignment/help.hpp"

namespace fathom::cli {
namespace {

using nlohmann::json;

json figures3(const std::array<dataset::ErrorFigures, 3>& f, const std::array<const char*, 3>& names,
              double factor = 1.0) {
  json out = json::object();
  for (std::size_t i = 0; i < 3; ++i) out[names[i]] = figures<json>(f[i], factor);
  return out;
}

json nees(const dataset::Nees& n) {
  return {{"degrees_of_freedom", n.dof},
          {"mean", number<json>(n.mean)},
          {"band_95", {n.band_95[0], n.band_95[1]}},
          {"inside_band", number<json>(n.inside)},
          {"count", n.count}};
}

json verdicts(const VerdictCounts& counts) {
  json out = json::object();
  for (const auto& [source, kinds] : counts) {
    json& entry = out[std::string(to_string(source))];
    for (std::size_t i = 0; i < kVerdictKinds; ++i) {
      entry[std::string(to_string(static_cast<VerdictKind>(i)))] = kinds[i];
    }
  }
  return out;
}

json innovations(const InnovationTallies& all) {
  json out = json::object();
  for (const auto& [name, one] : all)
    out[text_of(name)] = {{"count", one.measurements()},
                          {"mean_normalised_squared", number<json>(one.mean_square())},
                          {"within_95", number<json>(one.share_within_95())}};
  return out;
}

json placement(const Placement& p) {
  return {{"reference_late_s", number<json>(p.reference_late_s)},
          {"offset_B_m", {number<json>(p.offset_B_m[0]), number<json>(p.offset_B_m[1])}},
          {"horizontal_error_m", {{"rms", number<json>(p.rms_m)}}},
          {"nees_horizontal", number<json>(p.nees_horizontal)}};
}

json outage(const OutageFigures& f) {
  json list = json::array();
  for (const OutageWindow& window : f.windows) {
    json limits = json::object();
    for (const auto& [name, time_s] : window.time_to_limit_s) limits[name] = number<json>(time_s);
    list.push_back({{"start_s", number<json>(window.start_s)},
                    {"end_s", number<json>(window.end_s)},
                    {"horizontal_error_m", number<json>(window.horizontal_error_m)},
                    {"inside_rms_m", number<json>(window.inside.rms_m())},
                    {"smoothed_inside_rms_m", number<json>(window.smoothed_inside.rms_m())},
                    {"predicted_95_m", number<json>(window.predicted_95_m)},
                    {"forecast_95_m", number<json>(window.forecast_95_m)},
                    {"forecast_time_to_limit_s", limits}});
  }
  return {{"duration_s", f.duration_s},
          {"count", f.windows.size()},
          {"horizontal_error_m",
           {{"rms", number<json>(f.rms_m)}, {"p95", number<json>(f.p95_m)}, {"max", number<json>(f.max_m)}}},
          {"inside_horizontal_error_m", {{"rms", number<json>(f.inside_rms_m)}}},
          {"smoothed_inside_horizontal_error_m", {{"rms", number<json>(f.smoothed_inside_rms_m)}}},
          {"forecast_coverage", number<json>(f.forecast_coverage)},
          {"predicted_coverage", number<json>(f.predicted_coverage)},
          {"windows", list}};
}

double percent(double part, double whole) {
  return whole > 0.0 ? 100.0 * part / whole : kUnknown;
}

json errors(const dataset::Score& score, double distance_m) {
  return {{"horizontal_error_m", figures<json>(score.horizontal_m)},
          {"position_error_m", figures3(score.position_N_m, {"north", "east", "down"})},
          {"distance_3d_error_m", figures<json>(score.distance_3d_m)},
          {"velocity_error_m_s", figures3(score.velocity_N_m_s, {"north", "east", "down"})},
          {"attitude_error_deg", figures3(score.rpy_rad, {"roll", "pitch", "yaw"}, kDegPerRad)},
          {"horizontal_error_percent",
           {{"end", number<json>(percent(score.horizontal_m.end, distance_m))},
            {"rms", number<json>(percent(score.horizontal_m.rms, distance_m))},
            {"max", number<json>(percent(score.horizontal_m.max, distance_m))}}},
          {"nees",
           {{"horizontal", nees(score.nees_horizontal)},
            {"position", nees(score.nees_position)},
            {"velocity", nees(score.nees_velocity)}}}};
}

json heading(const HeadingErrors& errors) {
  return {{"count", errors.count()},
          {"mean_deg", number<json>(errors.mean_rad() * kDegPerRad)},
          {"rms_deg", number<json>(errors.rms_rad() * kDegPerRad)},
          {"worst_sigma", number<json>(errors.worst())},
          {"beyond_3_sigma", errors.beyond()},
          {"worst_own_sigma", number<json>(errors.worst_own())},
          {"beyond_3_own_sigma", errors.beyond_own()}};
}

json heading(const HeadingFigures& figures) {
  json out = {{"aligned_after_s", number<json>(figures.aligned_after_s)}};
  if (figures.course.count() > 0) {
    out["course_made_good"] = heading(figures.course);
    out["course_made_good"]["through"] = figures.through_medium ? "medium" : "ground";
    out["course_made_good"]["aligned"] = heading(figures.course_aligned);
  }
  if (figures.reference.count() > 0) out["reference"] = heading(figures.reference);
  return out;
}

double us_per_sample(const SolveResult& result) {
  return result.imu_samples > 0 ? 1e6 * result.wall_s / static_cast<double>(result.imu_samples) : kUnknown;
}

std::string is(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "is %.4g", value);
  return std::isfinite(value) ? text.data() : "is not known";
}

// Whether anything was there that could have said where the vehicle is.
bool fixes_given(const SolveResult& result) {
  return result.verdicts.contains(SourceKind::gps) || result.verdicts.contains(SourceKind::usbl) ||
         result.verdicts.contains(SourceKind::fix);
}

// One sentence, after `what` came of it.
std::string why_not_aligned(const std::string& what, const SolveReport& report) {
  const AlignmentStatus& status = report.result.alignment;
  std::string out = what + ": alignment is " + std::string(to_string(report.alignment)) + " at the end";
  if (report.smoothed || status.phase != report.alignment) return out;
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), ", for %.1f s", status.in_phase_s);
  out += text.data();
  std::string separator = "; it waits for ";
  for (std::uint32_t i = 0; i < status.condition_count && i < AlignmentStatus::kMaxConditions; ++i) {
    const AlignmentCondition& one = status.conditions[i];
    if (one.met) continue;
    std::snprintf(text.data(), text.size(), "%s", one.name.str().c_str());
    if (one.needed_s > 0.0) {  // the others are yes or no, or a figure that is good at once
      std::snprintf(text.data(), text.size(), "%s below %.4g for %.4g s (%s, has been below for %.4g s)",
                    one.name.str().c_str(), one.limit, one.needed_s, is(one.value).c_str(), one.held_s);
    } else if (one.limit == 0.0 && one.value == 1.0) {
      std::snprintf(text.data(), text.size(), "%s to be over", one.name.str().c_str());
    } else if (one.limit != 1.0 && known(one.limit)) {
      std::snprintf(text.data(), text.size(), "%s below %.4g (%s)", one.name.str().c_str(), one.limit,
                    is(one.value).c_str());
    }
    out += separator + text.data();
    if (const std::string_view help = help_of(one); !help.empty()) out += ": " + std::string(help);
    separator = "; and ";
  }
  if (status.advice[0] != '\0')
    out += "; " + std::string(status.advice.data(), strnlen(status.advice.data(), status.advice.size()));
  return out;
}

}  // namespace

std::string to_json(const SolveReport& report) {
  json out;
  out["dataset"] = report.dataset;
  out["config"] = report.config;
  out["config_hash"] = report.config_hash;
  out["version"] = std::string(runtime::version());
  out["start"] = report.start;
  out["smoothed"] = report.smoothed;
  out["imu_samples"] = report.result.imu_samples;
  out["nav_states"] = report.result.nav_states;
  out["positions"] = report.positions;
  out["alignment"] = std::string(to_string(report.alignment));
  if (!report.smoothed) {
    out["ever_aligned"] = report.result.ever_aligned;
    out["refused_to_align"] = json::array();
    for (const ImplausibleSpan& one : report.result.implausibles)
      out["refused_to_align"].push_back({{"sensor", one.sensor},
                                         {"kind", one.blame.kind},
                                         {"name", one.name},
                                         {"text", one.text},
                                         {"value", number<json>(one.value)},
                                         {"first_s", one.first_s},
                                         {"last_s", one.last_s}});
  }
  if (!report.smoothed)
    out["start_heading_error_deg"] = start_heading_error_rad(report.result.alignment) * kDegPerRad;
  if (!report.smoothed) {
    out["noise_factors"] = report.result.noise_factors;
    out["biases"] = json::object();
    for (const auto& [axis, one] : report.result.biases)
      out["biases"][std::string(axis)] = {{"value", number<json>(one.in_unit(one.value))},
                                          {"configured_sigma", number<json>(one.in_unit(one.said_sigma))},
                                          {"unit", one.unit()}};
    out["slow_errors"] = json::object();
    for (const auto& [kind, one] : report.result.slow_errors)
      out["slow_errors"][kind] = {{"sigma_m", number<json>(one.sigma_m)},
                                  {"configured_sigma_m", number<json>(one.configured_m)}};
  }
  out["wall_time_s"] = report.result.wall_s;
  out["time_per_imu_sample_us"] = number<json>(us_per_sample(report.result));
  out["verdicts"] = verdicts(report.result.verdicts);
  out["innovations"] = innovations(report.result.innovations);
  if (!report.smoothed) out["heading"] = heading(report.heading);
  const dataset::Score& score = report.score;
  out["scored"] = score.count;
  if (score.count > 0) {
    out["scored_s"] = to_seconds(score.last_ns - score.first_ns);
    out["distance_m"] = number<json>(report.distance_m);
    out.update(errors(score, report.distance_m));
    if (known(report.placement.reference_late_s)) out["reference_placement"] = placement(report.placement);
  }
  if (report.filtered.count > 0) out["filtered"] = errors(report.filtered, report.distance_m);
  if (report.at_fixes.count > 0) {
    out["at_fixes"] = {{"count", report.at_fixes.count},
                       {"latency_found_s", report.result.gps_latency_s},
                       {"horizontal_error_m", {{"rms", number<json>(report.at_fixes.rms_m())}}}};
    if (report.smoothed)
      out["at_fixes"]["filtered"] = {
          {"horizontal_error_m", {{"rms", number<json>(report.filtered_at_fixes.rms_m())}}}};
  }
  if (!report.outages.empty()) {
    out["gps_outages"] = json::array();
    for (const OutageFigures& f : report.outages) out["gps_outages"].push_back(outage(f));
  }
  return out.dump(2) + "\n";
}

std::string to_text(const SolveReport& report) {
  std::string out = line("%s: %llu inertial samples in %.2f s, %.1f us each", report.dataset.c_str(),
                         static_cast<unsigned long long>(report.result.imu_samples), report.result.wall_s,
                         us_per_sample(report.result));
  for (const auto& [source, kinds] : report.result.verdicts) {
    std::string words = std::string(to_string(source)) + ":";
    for (std::size_t i = 0; i < kVerdictKinds; ++i) {
      if (kinds[i] == 0) continue;
      words += " " + std::to_string(kinds[i]) + " " + std::string(to_string(static_cast<VerdictKind>(i)));
    }
    out += words + "\n";
  }
  for (const ImplausibleSpan& one : report.result.implausibles)
    out += one.text + line(" (seen from %.1f s to %.1f s)", one.first_s, one.last_s);
  if (implausible(report.result.alignment) != nullptr)
    out += report.result.ever_aligned ? "it is not aligned at the end because of that\n"
                                      : "it did not align because of that\n";
  else if (report.positions > 0 && !report.smoothed && !report.result.ever_aligned)
    out += why_not_aligned("it never aligned", report) + "\n";
  if (report.positions == 0) {
    if (!fixes_given(report.result))
      out += "the data have no position: neither gps nor usbl nor fix has a row\n";
    out += why_not_aligned("no position was found", report) + "\n";
  }
  const dataset::Score& score = report.score;
  if (score.count > 0) {
    out += line("horizontal error: rms %.2f m, 95 %% %.2f m, end %.2f m, %.3f %% of %.0f m",
                score.horizontal_m.rms, score.horizontal_m.p95, score.horizontal_m.end,
                percent(score.horizontal_m.end, report.distance_m), report.distance_m);
    if (known(score.rpy_rad[2].rms))
      out +=
          line("attitude error rms: roll %.3f, pitch %.3f, yaw %.3f deg", score.rpy_rad[0].rms * kDegPerRad,
               score.rpy_rad[1].rms * kDegPerRad, score.rpy_rad[2].rms * kDegPerRad);
    out += line("horizontal NEES %.2f, consistent from %.2f to %.2f", score.nees_horizontal.mean,
                score.nees_horizontal.band_95[0], score.nees_horizontal.band_95[1]);
    if (const Placement& p = report.placement; known(p.reference_late_s))
      out += line(
          "  of which by the reference's clock %+.3f s and its point %+.2f m forward, %+.2f m right; "
          "without them rms %.2f m, NEES %.2f",
          p.reference_late_s, p.offset_B_m[0], p.offset_B_m[1], p.rms_m, p.nees_horizontal);
  }
  for (const auto& [name, one] : report.result.innovations)
    if (one.components() > 0)
      out += line("innovations of %s: mean square %.2f sigma^2 (1 where sigmas hold), %.1f %% within 95 %%",
                  text_of(name).c_str(), one.mean_square(), 100.0 * one.share_within_95());
  for (const auto& [sensor, factor] : report.result.noise_factors)
    out += line("the noise of %s was up to %.1f times what is configured, and counted as that",
                sensor.c_str(), factor);
  for (const auto& [axis, one] : report.result.biases)
    out += line("the %s; navigation counts with the bias", one.text().data());
  for (const auto& [kind, one] : report.result.slow_errors)
    out += line(
        "the fixes of %s are off slowly by %.1f m (sigma), and %.1f m is configured; navigation counts with "
        "that",
        kind.c_str(), one.sigma_m, one.configured_m);
  if (known(report.heading.aligned_after_s))
    out += line("aligned %.1f s after the first position", report.heading.aligned_after_s);
  if (const double start_rad = start_heading_error_rad(report.result.alignment); start_rad != 0.0)
    out += line("the heading of the start was wrong by %.1f deg and was corrected", start_rad * kDegPerRad);
  if (const HeadingErrors& course = report.heading.course; course.count() > 0)
    out += line(
        "heading against the course made good%s, straight ahead: rms %.2f deg, worst %.2f sigma, "
        "%zu of %zu beyond 3 sigma",
        report.heading.through_medium ? " through the medium" : "", course.rms_rad() * kDegPerRad,
        course.worst(), course.beyond(), course.count());
  if (const HeadingErrors& reference = report.heading.reference; reference.count() > 0)
    out += line("heading against the reference: worst %.2f sigma, %zu of %zu states beyond 3 sigma",
                reference.worst(), reference.beyond(), reference.count());
  if (report.filtered.count > 0)
    out += line("before smoothing: horizontal error rms %.2f m, 95 %% %.2f m",
                report.filtered.horizontal_m.rms, report.filtered.horizontal_m.p95);
  if (report.smoothed && report.at_fixes.count > 0)
    out += line("at the fixes it was given, each at its own instant: rms %.2f m, before smoothing %.2f m",
                report.at_fixes.rms_m(), report.filtered_at_fixes.rms_m());
  for (const OutageFigures& f : report.outages) {
    out += f.duration_s > 0.0 ? line("GPS outage %g s:", f.duration_s) : "GPS outages at random:\n";
    out += line("  horizontal error at its end rms %.2f m, 95 %% %.2f m, max %.2f m, %zu windows", f.rms_m,
                f.p95_m, f.max_m, f.windows.size());
    out +=
        line("  inside the 95 %% forecast when GPS was lost: %.1f %%, inside the 95 %% at the end: %.1f %%",
             100.0 * f.forecast_coverage, 100.0 * f.predicted_coverage);
    if (known(f.smoothed_inside_rms_m))
      out += line("  over all withheld fixes: rms %.2f m, smoothed %.2f m", f.inside_rms_m,
                  f.smoothed_inside_rms_m);
  }
  return out;
}

}  // namespace fathom::cli
