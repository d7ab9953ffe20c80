#include "cli/commission/page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace fathom::cli {
namespace {

using commission::AllanPoint;
using commission::Finding;
using commission::Severity;

constexpr const char* kStyle = R"(<style>
:root{--ink:#1c2430;--paper:#fff;--soft:#5b6675;--line:#d5dbe3;--bad:#b3261e;--warn:#8a5a00;--good:#1b6e3c;--a:#1f5fbf;--b:#b3541e;--c:#2b7a4b}
@media(prefers-color-scheme:dark){:root{--ink:#e4e9f0;--paper:#14181e;--soft:#9aa5b4;--line:#343c48;--bad:#ff8a80;--warn:#f2c14e;--good:#7fd19b;--a:#7fb0ff;--b:#ffb07f;--c:#7fd19b}}
@media print{:root{--ink:#000;--paper:#fff;--soft:#444;--line:#bbb}section{break-inside:avoid}}
body{font:16px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:62rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.6rem}h2{font-size:1.15rem;border-bottom:1px solid var(--line);padding-bottom:.2rem;margin-top:2rem}
li{margin:.3rem 0}b{font-weight:600}.bad{color:var(--bad)}.warn{color:var(--warn)}.good{color:var(--good)}.soft{color:var(--soft)}
table{border-collapse:collapse;width:100%;font-size:.9rem}th,td{text-align:left;padding:.25rem .5rem;border-bottom:1px solid var(--line)}td.n{text-align:right;font-variant-numeric:tabular-nums}
svg{width:100%;height:auto;max-width:40rem}svg text{fill:var(--soft);font:12px system-ui,sans-serif}svg .grid{stroke:var(--line);stroke-width:1}
svg .curve{fill:none;stroke-width:2}
</style>)";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string figure(double value, int digits = 4) {
  if (!std::isfinite(value)) return "–";
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

std::string plot(const std::array<std::vector<AllanPoint>, 3>& curves, double scale, const char* title,
                 const char* unit) {
  double low_x = 1e300, high_x = 0.0, low_y = 1e300, high_y = 0.0;
  for (const auto& curve : curves) {
    for (const AllanPoint& point : curve) {
      if (!(point.deviation > 0.0)) continue;
      low_x = std::min(low_x, point.tau_s);
      high_x = std::max(high_x, point.tau_s);
      low_y = std::min(low_y, point.deviation * scale);
      high_y = std::max(high_y, point.deviation * scale);
    }
  }
  if (!(high_x > low_x) || !(high_y > 0.0)) return {};
  const double x0 = std::floor(std::log10(low_x)), x1 = std::ceil(std::log10(high_x));
  const double y0 = std::floor(std::log10(low_y)), y1 = std::max(y0 + 1.0, std::ceil(std::log10(high_y)));
  constexpr double kLeft = 60, kTop = 24, kWide = 560, kHigh = 280;
  const auto px = [&](double tau) { return kLeft + kWide * (std::log10(tau) - x0) / (x1 - x0); };
  const auto py = [&](double y) { return kTop + kHigh * (y1 - std::log10(y)) / (y1 - y0); };
  std::string out = "<figure><svg viewBox=\"0 0 640 350\" role=\"img\" aria-label=\"" + escaped(title) +
                    "\"><text x=\"60\" y=\"14\">" + escaped(title) + ", " + escaped(unit) + "</text>";
  for (double d = x0; d <= x1 + 0.5; d += 1.0) {
    const std::string x = figure(px(std::pow(10.0, d)), 5);
    out += "<line class=\"grid\" x1=\"" + x + "\" x2=\"" + x + "\" y1=\"24\" y2=\"304\"/><text x=\"" + x +
           "\" y=\"320\" text-anchor=\"middle\">" + figure(std::pow(10.0, d)) + " s</text>";
  }
  for (double d = y0; d <= y1 + 0.5; d += 1.0) {
    const std::string y = figure(py(std::pow(10.0, d)), 5);
    out += "<line class=\"grid\" x1=\"60\" x2=\"620\" y1=\"" + y + "\" y2=\"" + y +
           "\"/><text x=\"54\" y=\"" + y + "\" text-anchor=\"end\">" + figure(std::pow(10.0, d)) + "</text>";
  }
  static constexpr std::array<const char*, 3> kColours{"var(--a)", "var(--b)", "var(--c)"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::string points;
    for (const AllanPoint& point : curves[axis])
      if (point.deviation > 0.0)
        points += figure(px(point.tau_s), 5) + "," + figure(py(point.deviation * scale), 5) + " ";
    out += "<polyline class=\"curve\" style=\"stroke:" + std::string(kColours[axis]) + "\" points=\"" +
           points + "\"/><text style=\"fill:" + std::string(kColours[axis]) + "\" x=\"" +
           std::to_string(560 + 20 * axis) + "\" y=\"14\">" + std::string(1, static_cast<char>('x' + axis)) +
           "</text>";
  }
  return out + "<text x=\"340\" y=\"342\" text-anchor=\"middle\">cluster time</text></svg></figure>\n";
}

}  // namespace

std::string page_of(const commission::Commissioning& found, const std::string& log) {
  std::string out =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>Commissioning of " +
      escaped(log) + "</title>\n" + kStyle +
      "</head><body>\n<h1>What the log tells about the instruments</h1>\n<p class=\"soft\">" + escaped(log) +
      ": " + figure(std::round(found.duration_s), 6) + " s, " + figure(std::round(found.rest_s), 6) +
      " s of it at rest in one piece.</p>\n";
  const auto group = [&](const char* title, const char* style, auto&& belongs) {
    std::string items;
    for (const Finding& finding : found.findings)
      if (belongs(finding))
        items += "<li><b>" + escaped(finding.sensor) + "</b> " + escaped(finding.text) + "</li>\n";
    if (!items.empty())
      out += "<section><h2 class=\"" + std::string(style) + "\">" + title + "</h2>\n<ul>\n" + items +
             "</ul></section>\n";
  };
  group("Wrong", "bad", [](const Finding& f) { return f.severity == Severity::wrong; });
  group("To look at", "warn", [](const Finding& f) { return f.severity == Severity::note; });
  group("As it should be", "good", [](const Finding& f) { return f.severity == Severity::ok && f.known; });
  group("What the log cannot tell", "soft",
        [](const Finding& f) { return f.severity != Severity::wrong && !f.known; });
  const std::string gyro =
      plot(found.gyro_allan, 180.0 / 3.14159265358979323846 * 3600.0, "Allan deviation of the gyro", "deg/h");
  const std::string force = plot(found.force_allan, 1.0, "Allan deviation of the accelerometer", "m/s²");
  if (!gyro.empty() || !force.empty())
    out += "<section><h2>Noise at rest</h2>\n" + gyro + force + "</section>\n";
  out +=
      "<section><h2>Figures</h2>\n<table><tr><th>instrument</th><th>quantity</th><th>value</th><th>one "
      "sigma</th><th>unit</th><th></th></tr>\n";
  for (const Finding& finding : found.findings) {
    if (!std::isfinite(finding.value)) continue;
    out += "<tr><td>" + escaped(finding.sensor) + "</td><td>" + escaped(finding.what) +
           "</td><td class=\"n\">" + figure(finding.value) + "</td><td class=\"n\">" +
           figure(finding.sigma, 2) + "</td><td>" + escaped(finding.unit) + "</td><td>" +
           (finding.known ? "" : "cannot be told") + "</td></tr>\n";
  }
  return out + "</table></section>\n</body></html>\n";
}

}  // namespace fathom::cli
