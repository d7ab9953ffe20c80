#include <algorithm>
#include <cmath>

#include "report/material.hpp"
#include "report/page_plots.hpp"
#include "report/plot.hpp"

namespace fathom::report {
namespace {

constexpr const char* kStyle = R"(
:root{--ground:#eef2f5;--card:#fff;--line:#c3ccd4;--ink:#13202b;--soft:#4a5a67;--accent:#00507a;--good:#0b6b3a;
--good-ground:#ddf2e4;--caution:#7a4a00;--caution-ground:#ffefcf;--bad:#a3121f;--bad-ground:#fde1e2;--s1:#00629b;
--s2:#b34700;--s3:#00744d;--s4:#8a3a86;--s5:#665c00;--s6:#4a5a67;color-scheme:light dark}
@media screen and (prefers-color-scheme:dark){:root{--ground:#0a1016;--card:#121b23;--line:#2c3a46;--ink:#d9e3ea;
--soft:#9db0bd;--accent:#6cc0f0;--good:#6fdc9a;--good-ground:#0f2a1b;--caution:#ffc454;--caution-ground:#30240a;
--bad:#ff8d8d;--bad-ground:#3a1216;--s1:#6cc0f0;--s2:#ffa25c;--s3:#5fd6a4;--s4:#d99ad6;--s5:#d9cc5a;--s6:#9db0bd}}
*{box-sizing:border-box}body{margin:0;background:var(--ground);color:var(--ink);font:15px/1.45 system-ui,sans-serif}
main{max-width:940px;margin:0 auto;padding:16px}h1{font-size:22px;margin:8px 0 2px}h2{font-size:17px;margin:0 0 8px}
p{margin:6px 0}.soft{color:var(--soft)}section{background:var(--card);border:1px solid var(--line);border-radius:6px;
padding:14px;margin:14px 0}svg{max-width:100%;height:auto;display:block;margin:6px 0}a{color:var(--accent)}
ul.findings{list-style:none;margin:0;padding:0}ul.findings li{padding:7px 10px;border-radius:4px;margin:6px 0}
li.bad{background:var(--bad-ground)}li.caution{background:var(--caution-ground)}li.good{background:var(--good-ground)}
li b{display:inline-block;min-width:84px}li.bad b{color:var(--bad)}li.caution b{color:var(--caution)}
li.good b{color:var(--good)}table{border-collapse:collapse;font-size:13px;margin:8px 0;display:block;overflow-x:auto}
th,td{border-bottom:1px solid var(--line);padding:3px 9px;text-align:right;white-space:nowrap}
th:first-child,td:first-child,td.words{text-align:left}td.words,th{white-space:normal}th{color:var(--soft);font-weight:600}
.tiles{display:flex;flex-wrap:wrap;gap:10px;margin:10px 0}.tiles div{background:var(--card);border:1px solid var(--line);
border-radius:6px;padding:8px 12px;min-width:130px}.tiles strong{display:block;font-size:18px}
@media print{body{background:#fff;font-size:11pt}main{max-width:none;padding:0}section{border:0;padding:0;
break-inside:auto}svg,ul.findings li,table{break-inside:avoid}li{border:1px solid var(--line)}nav{display:none}}
)";

std::string section(const std::string& id, const std::string& title, const std::string& content) {
  return "<section id=\"" + id + "\"><h2>" + title + "</h2>\n" + content + "</section>\n";
}

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
  constexpr double kDeg = 57.29577951308232;
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
  row("roll, degrees", m.score.rpy_rad[0], kDeg);
  row("pitch, degrees", m.score.rpy_rad[1], kDeg);
  row("yaw, degrees", m.score.rpy_rad[2], kDeg);
  return out + "</table>\n";
}

std::string source_table(const Material& m) {
  std::string out =
      "<table><tr><th>source</th><th>all</th><th>used</th><th>rejected</th><th>other</th>"
      "<th>within 2 sigma</th><th>rms, sigmas</th><th>mean, sigmas</th></tr>\n";
  for (const Source& source : m.sources) {
    const InnovationFigures figures = figures_of(source);
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
    for (const double mean : figures.mean)
      if (known(mean)) means += (means.empty() ? "" : ", ") + label_of(mean, 0.01);
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
    cell(known(figures.inside) ? brief(100.0 * figures.inside) + " %" : "");
    cell(known(figures.rms) ? brief(figures.rms) : "");
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

}  // namespace

std::string page(const Material& m) {
  std::string out =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"><title>" +
      escaped(m.title) + "</title><style>" + kStyle + plot_style() + "</style></head>\n<body><main>\n";
  out += "<h1>" + escaped(m.title) + "</h1>\n<p class=\"soft\">" + escaped(m.source) + " with " +
         escaped(m.config) + " (" + escaped(m.config_hash.substr(0, 12)) + "), " + escaped(m.version) +
         "</p>\n";
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
  return out + "</main></body></html>\n";
}

}  // namespace fathom::report
