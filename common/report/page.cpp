#include <algorithm>
#include <cmath>

#include "base/markup.hpp"
#include "base/units.hpp"
#include "report/frame.hpp"
#include "report/material.hpp"
#include "report/page_plots.hpp"
#include "report/plot.hpp"

namespace fathom::report {
namespace {

std::string tile(const std::string& name, const std::string& value) {
  return "<div><span class=\"soft\">" + name + "</span><strong>" + escaped(value) + "</strong></div>";
}

std::string verdict(const Material& m) {
  std::string out = "<ul class=\"findings\">\n";
  for (const Finding& one : findings(m)) {
    const char* cls = one.weight == Finding::Weight::bad       ? "bad"
                      : one.weight == Finding::Weight::caution ? "caution"
                                                               : "good";
    const char* word = one.weight == Finding::Weight::bad       ? "wrong"
                       : one.weight == Finding::Weight::caution ? "look"
                                                                : "good";
    out += std::string("<li class=\"") + cls + "\"><b>" + word + "</b> " + escaped(one.text) +
           " <a href=\"#" + one.anchor + "\">show</a></li>\n";
  }
  return out + "</ul>\n";
}

std::string tiles(const Material& m) {
  std::string out = "<div class=\"tiles\">";
  out += tile("length", brief(m.end_s - m.begin_s) + " s");
  out += tile("inertial samples", std::to_string(m.imu_samples));
  std::size_t aided = 0;
  for (const StateRow& row : m.states) aided += row.mode == NavMode::gps_aided ? 1U : 0U;
  if (!m.states.empty()) {
    out +=
        tile("aided by GPS",
             brief(100.0 * static_cast<double>(aided) / static_cast<double>(m.states.size())) + " % of time");
    const StateRow& last = m.states.back();
    out += tile("sigma at the end",
                brief(std::hypot(last.position_sigma_N_m[0], last.position_sigma_N_m[1])) + " m");
  }
  if (m.score.count > 0) {
    out += tile("horizontal error, rms", brief(m.score.horizontal_m.rms) + " m");
    out += tile("horizontal error, most", brief(m.score.horizontal_m.max) + " m");
  }
  return out + "</div>\n";
}

std::string error_table(const Material& m) {
  if (m.score.count == 0) return {};
  std::string out =
      "<table><tr><th>error</th><th>rms</th><th>95 %</th><th>most</th><th>at the end</th></tr>\n";
  const auto row = [&](const std::string& name, const dataset::ErrorFigures& f, double scale) {
    if (!known(f.rms)) return;
    out += "<tr><td>" + name + "</td><td>" + brief(f.rms * scale) + "</td><td>" + brief(f.p95 * scale) +
           "</td><td>" + brief(f.max * scale) + "</td><td>" + brief(f.end * scale) + "</td></tr>\n";
  };
  row("horizontal, m", m.score.horizontal_m, 1.0);
  row("down, m", m.score.position_N_m[2], 1.0);
  row("velocity north, m/s", m.score.velocity_N_m_s[0], 1.0);
  row("velocity east, m/s", m.score.velocity_N_m_s[1], 1.0);
  row("roll, degrees", m.score.rpy_rad[0], kDegPerRad);
  row("pitch, degrees", m.score.rpy_rad[1], kDegPerRad);
  row("yaw, degrees", m.score.rpy_rad[2], kDegPerRad);
  return out + "</table>\n";
}

std::string source_table(const Material& m) {
  std::string out =
      "<table><tr><th>source</th><th>all</th><th>used</th><th>rejected</th><th>other</th>"
      "<th>within 95 %</th><th>rms, sigmas</th><th>mean, sigmas</th></tr>\n";
  for (const Source& source : m.sources) {
    const InnovationTally& figures = source.innovations;
    const std::uint64_t used = source.of(VerdictKind::used);
    const std::uint64_t rejected = source.of(VerdictKind::rejected) + source.of(VerdictKind::disputed);
    std::string others;
    for (std::size_t i = 0; i < kVerdictKinds; ++i) {
      const auto kind = static_cast<VerdictKind>(i);
      if (source.counts[i] == 0 || kind == VerdictKind::used || kind == VerdictKind::rejected ||
          kind == VerdictKind::disputed)
        continue;
      others += (others.empty() ? "" : ", ") + std::to_string(source.counts[i]) + " " +
                std::string(to_string(kind));
    }
    std::string means;
    for (std::size_t i = 0; i < InnovationTally::kComponents; ++i)
      if (const double mean = figures.used_mean(i); known(mean))
        means += (means.empty() ? "" : ", ") + label_of(mean, 0.01);
    const auto cell = [&out](const std::string& content, const char* cls = "") {
      out += "<td";
      if (*cls != '\0') out.append(" class=\"").append(cls).append("\"");
      out.append(">").append(content).append("</td>");
    };
    out += "<tr>";
    cell(escaped(source.sensor + (source.model.empty() ? ", no model" : " " + source.model)));
    cell(std::to_string(source.total()));
    cell(std::to_string(used));
    cell(std::to_string(rejected));
    cell(others, "words");
    cell(known(figures.share_within_95()) ? brief(100.0 * figures.share_within_95()) + " %" : "");
    cell(known(figures.used_rms()) ? brief(figures.used_rms()) : "");
    cell(means, "words");
    out += "</tr>\n";
  }
  return out + "</table>\n";
}

std::string outage_table(const Material& m) {
  if (m.outages.empty()) return "<p>There was none of more than 5 s.</p>\n";
  std::string out =
      "<table><tr><th>from</th><th>length</th><th>sigma before</th><th>sigma at its end</th>"
      "<th>95 % forecast 5 s into it</th><th>error at its end</th></tr>\n";
  for (const Outage& one : m.outages) {
    const auto metres = [](double value) { return known(value) ? brief(value) + " m" : std::string(); };
    const bool beyond = known(one.error_m) && known(one.forecast_95_m) && one.error_m > one.forecast_95_m;
    out += "<tr><td>" + brief(one.begin_s) + " s</td><td>" + brief(one.end_s - one.begin_s) + " s</td><td>" +
           metres(one.sigma_before_m) + "</td><td>" + metres(one.sigma_after_m) + "</td><td>" +
           metres(one.forecast_95_m) + "</td><td>" + metres(one.error_m) + (beyond ? " (beyond)" : "") +
           "</td></tr>\n";
  }
  return out + "</table>\n";
}

std::string phase_table(const Material& m) {
  std::string out = "<table><tr><th>alignment</th><th>from</th></tr>\n";
  for (const PhaseChange& one : m.phases)
    out += "<tr><td>" + std::string(to_string(one.phase)) + "</td><td>" + brief(one.t_s) + " s</td></tr>\n";
  return out + "</table>\n";
}

std::string told_list(const Material& m) {
  if (m.told.empty())
    return "<p>Nothing stands out: all that was refused, lost or late belongs to such a run.</p>\n";
  std::string out = "<ul>\n";
  for (const Told& one : m.told) out += "<li>" + escaped(brief(one.t_s) + " s: " + one.text) + "</li>\n";
  return out + "</ul>\n";
}

std::string service_table(const Material& m) {
  std::string out =
      "<table><tr><th>service</th><th>host</th><th>life signs from</th><th>to</th><th>starts</th>"
      "<th>longest silence</th><th>clock set by</th><th>not healthy</th></tr>\n";
  for (const ServiceRow& one : m.services) {
    out += "<tr><td>" + escaped(one.name) + "</td><td>" + escaped(one.host) + "</td><td>" +
           brief(one.first_s) + " s</td><td>" + brief(one.last_s) + " s" +
           (one.ended_early ? " (silent since)" : "") + "</td><td>" + std::to_string(one.processes) +
           "</td><td>" + (one.longest_silence_s > 0.0 ? brief(one.longest_silence_s) + " s" : std::string()) +
           "</td><td>" + (std::abs(one.clock_set_s) > 1e-3 ? brief(one.clock_set_s) + " s" : std::string()) +
           "</td><td class=\"words\">" + escaped(one.complaint) + "</td></tr>\n";
  }
  return out + "</table>\n";
}

}  // namespace

std::string page(const Material& m) {
  std::string out = page_begin(m.title);
  out += "<p class=\"soft\">" + escaped(m.source) + " with " + escaped(m.config) + " (" +
         escaped(m.config_hash.substr(0, 12)) + "), " + escaped(m.version) + "</p>\n";
  out += tiles(m);
  out += section("verdict", "What to look at first", verdict(m));
  out += section("track", "Track", track_plot(m));
  if (m.score.count > 0) {
    out +=
        section("errors", "Errors against the reference",
                "<p class=\"soft\">Bands are two sigmas of navigation's own: about 95 % of the errors belong "
                "inside.</p>\n" +
                    error_plots(m) + error_table(m));
    out += section("nees", "Consistency (NEES)", nees_plot(m));
  }
  out += section("sigmas", "Sigmas", sigma_plots(m));
  out += section(
      "innovations", "Innovations",
      "<p class=\"soft\">What measurements differed from what navigation expected, divided by the sigma "
      "of that difference. About 95 % belong between -2 and 2; crosses were rejected.</p>\n" +
          source_table(m) + innovation_plots(m));
  out += section("outages", "Without GPS, and the forecast against what came",
                 outage_table(m) + forecast_plot(m));
  out += section("alignment", "Alignment", phase_table(m) + alignment_plot(m));
  if (!m.services.empty()) {
    out += section("told", "What the vehicle itself tells", told_list(m));
    out += section("services", "Services and clocks", service_table(m));
  }
  return out + page_end();
}

}  // namespace fathom::report
