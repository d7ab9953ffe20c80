#include "cli/commission/page.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "base/markup.hpp"
#include "report/frame.hpp"
#include "report/plot.hpp"

namespace fathom::cli {
namespace {

using commission::AllanPoint;
using commission::Finding;
using commission::Severity;

std::string figure(double value) {
  return std::isfinite(value) ? report::brief(value) : "–";
}

std::string allan(const std::array<std::vector<AllanPoint>, 3>& axes, double scale, const char* title,
                  const char* unit) {
  report::Plot plot;
  plot.title = title;
  plot.x_label = "cluster time, s";
  plot.y_label = unit;
  plot.logarithmic = plot.logarithmic_x = true;
  plot.height = 320;
  bool any = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    report::Curve curve;
    curve.name = std::string(1, static_cast<char>('x' + axis));
    curve.colour = static_cast<int>(axis) + 1;
    for (const AllanPoint& point : axes[axis]) {
      curve.x.push_back(point.tau_s);
      curve.y.push_back(scale * point.deviation);
      any = any || point.deviation > 0.0;
    }
    plot.curves.push_back(std::move(curve));
  }
  return any ? report::to_svg(plot) : std::string();
}

}  // namespace

std::string page_of(const commission::Commissioning& found, const std::string& log) {
  std::string out = report::page_begin("What the log tells about the instruments") + "<p class=\"soft\">" +
                    escaped(log) + ": " + figure(found.duration_s) + " s, " + figure(found.rest_s) +
                    " s of it at rest in one piece.</p>\n";
  const auto group = [&](const char* id, const char* title, const char* style, auto&& belongs) {
    std::string items;
    for (const Finding& finding : found.findings)
      if (belongs(finding))
        items += std::string("<li class=\"") + style + "\"><b>" + escaped(finding.sensor) + "</b> " +
                 escaped(finding.text) + "</li>\n";
    if (!items.empty()) out += report::section(id, title, "<ul class=\"findings\">\n" + items + "</ul>\n");
  };
  group("wrong", "Wrong", "bad", [](const Finding& f) { return f.severity == Severity::wrong; });
  group("look", "To look at", "caution", [](const Finding& f) { return f.severity == Severity::note; });
  group("right", "As it should be", "good",
        [](const Finding& f) { return f.severity == Severity::ok && f.known; });
  group("untold", "What the log cannot tell", "soft",
        [](const Finding& f) { return f.severity != Severity::wrong && !f.known; });
  constexpr double kDegreesPerHour = 180.0 / std::numbers::pi * 3600.0;
  const std::string noise = allan(found.gyro_allan, kDegreesPerHour, "Allan deviation of the gyro", "deg/h") +
                            allan(found.force_allan, 1.0, "Allan deviation of the accelerometer", "m/s²");
  if (!noise.empty()) out += report::section("noise", "Noise at rest", noise);
  std::string table =
      "<table><tr><th>instrument</th><th>quantity</th><th>value</th><th>one sigma</th><th>unit</th><th></th>"
      "</tr>\n";
  for (const Finding& finding : found.findings) {
    if (!std::isfinite(finding.value)) continue;
    table += "<tr><td>" + escaped(finding.sensor) + "</td><td>" + escaped(finding.what) + "</td><td>" +
             figure(finding.value) + "</td><td>" + figure(finding.sigma) + "</td><td>" +
             escaped(finding.unit) + "</td><td>" + (finding.known ? "" : "cannot be told") + "</td></tr>\n";
  }
  return out + report::section("figures", "Figures", table + "</table>\n") + report::page_end();
}

}  // namespace fathom::cli
