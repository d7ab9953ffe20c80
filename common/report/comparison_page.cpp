#include <algorithm>
#include <cmath>
#include <functional>

#include "base/markup.hpp"
#include "base/units.hpp"
#include "report/comparison.hpp"
#include "report/frame.hpp"
#include "report/plot.hpp"

namespace fathom::report {
namespace {

constexpr std::size_t kMostRuns = 200;
constexpr std::size_t kMostCrosses = 2500;

using Pick = std::function<double(const ComparedRow&)>;

Plot over_time(const Comparison& c, const std::string& title, const std::string& unit) {
  Plot plot;
  plot.title = title;
  plot.y_label = unit;
  plot.x_from = c.begin_s;
  plot.x_to = c.end_s;
  return plot;
}

void add_curve(Plot& plot, const Comparison& c, const std::string& name, int colour, const Pick& pick,
               bool dashed = false) {
  Curve curve;
  curve.name = name;
  curve.colour = colour;
  curve.dashed = dashed;
  for (const ComparedRow& row : c.rows) {
    curve.x.push_back(row.t_s);
    curve.y.push_back(pick(row));
  }
  plot.curves.push_back(std::move(curve));
}

std::string difference_plots(const Comparison& c) {
  constexpr std::array<const char*, 3> kAxes{"north", "east", "down"};
  constexpr std::array<const char*, 3> kAngles{"roll", "pitch", "yaw"};
  Plot position = over_time(c, "Position, second minus first", "m");
  Plot velocity = over_time(c, "Velocity, second minus first", "m/s");
  Plot attitude = over_time(c, "Attitude, second minus first", "degrees");
  position.least_height = 1e-3;
  velocity.least_height = 1e-4;
  attitude.least_height = 1e-4;
  for (std::size_t i = 0; i < 3; ++i) {
    const int colour = static_cast<int>(i) + 1;
    add_curve(position, c, kAxes[i], colour,
              [i](const ComparedRow& row) { return row.difference.position_N_m[i]; });
    add_curve(velocity, c, kAxes[i], colour,
              [i](const ComparedRow& row) { return row.difference.velocity_N_m_s[i]; });
    add_curve(attitude, c, kAngles[i], colour,
              [i](const ComparedRow& row) { return row.difference.rpy_rad[i] * kDegPerRad; });
  }
  return to_svg(position) + to_svg(velocity) + to_svg(attitude);
}

std::string pair_plot(const Comparison& c, const std::string& title, const std::string& unit,
                      const std::function<double(const ComparedRow&, std::size_t)>& pick) {
  Plot plot = over_time(c, title, unit);
  add_curve(plot, c, "first", 1, [&](const ComparedRow& row) { return pick(row, 0); });
  add_curve(
      plot, c, "second", 2, [&](const ComparedRow& row) { return pick(row, 1); }, true);
  return to_svg(plot);
}

std::string sigma_plots(const Comparison& c) {
  return pair_plot(c, "Sigma, horizontal", "m",
                   [](const ComparedRow& row, std::size_t which) {
                     const auto& sigma = row.position_sigma_N_m[which];
                     return std::hypot(sigma[0], sigma[1]);
                   }) +
         pair_plot(c, "Sigma, down", "m", [](const ComparedRow& row, std::size_t which) {
           return row.position_sigma_N_m[which][2];
         });
}

std::string error_plots(const Comparison& c) {
  return pair_plot(c, "Horizontal error", "m",
                   [](const ComparedRow& row, std::size_t which) { return row.error[which].horizontal_m; }) +
         pair_plot(c, "Error down", "m", [](const ComparedRow& row, std::size_t which) {
           return row.error[which].position_N_m[2];
         });
}

std::string track_plot(const Comparison& c) {
  const auto origin = std::find_if(c.rows.begin(), c.rows.end(),
                                   [](const ComparedRow& row) { return known(row.difference.horizontal_m); });
  if (origin == c.rows.end()) return "<p>There is no instant at which both have a position.</p>\n";
  Map map;
  map.title = "Tracks, metres from the first position";
  std::array<Curve, 2> tracks;
  tracks[0].name = "first";
  tracks[1].name = "second";
  tracks[1].colour = 2;
  tracks[1].dashed = true;
  for (const ComparedRow& row : c.rows) {
    const auto d = dataset::ned_difference_m(row.latitude_rad, row.longitude_rad, 0.0, origin->latitude_rad,
                                             origin->longitude_rad, 0.0);
    tracks[0].x.push_back(d[1]);
    tracks[0].y.push_back(d[0]);
    tracks[1].x.push_back(d[1] + row.difference.position_N_m[1]);
    tracks[1].y.push_back(d[0] + row.difference.position_N_m[0]);
  }
  map.curves = {std::move(tracks[0]), std::move(tracks[1])};
  return to_svg(map);
}

std::string figure_table(const Comparison& c) {
  const ComparedSolution& a = c.solutions[0];
  const ComparedSolution& b = c.solutions[1];
  std::string out = "<p>First: " + escaped(a.settings) + "<br>Second: " + escaped(b.settings) +
                    "</p>\n<table><tr><th></th><th>first</th><th>second</th></tr>\n";
  const auto row = [&out](const std::string& name, const std::string& first, const std::string& second) {
    out += "<tr><td>" + name + "</td><td>" + escaped(first) + "</td><td>" + escaped(second) + "</td></tr>\n";
  };
  const auto numbers = [&](const std::string& name, double first, double second) {
    if (known(first) || known(second)) row(name, brief(first), brief(second));
  };
  row("states with a position", std::to_string(a.positions), std::to_string(b.positions));
  row("alignment at the end", std::string(to_string(a.alignment)), std::string(to_string(b.alignment)));
  numbers("aligned after, s", a.aligned_after_s, b.aligned_after_s);
  numbers("horizontal sigma, rms, m", a.horizontal_sigma_rms_m, b.horizontal_sigma_rms_m);
  numbers("horizontal sigma at the end, m", a.horizontal_sigma_end_m, b.horizontal_sigma_end_m);
  const dataset::Score& p = a.score;
  const dataset::Score& q = b.score;
  numbers("horizontal error, rms, m", p.horizontal_m.rms, q.horizontal_m.rms);
  numbers("horizontal error, 95 %, m", p.horizontal_m.p95, q.horizontal_m.p95);
  numbers("horizontal error, most, m", p.horizontal_m.max, q.horizontal_m.max);
  numbers("error down, rms, m", p.position_N_m[2].rms, q.position_N_m[2].rms);
  numbers("yaw error, rms, degrees", p.rpy_rad[2].rms * kDegPerRad, q.rpy_rad[2].rms * kDegPerRad);
  numbers("horizontal NEES", p.nees_horizontal.mean, q.nees_horizontal.mean);
  return out + "</table>\n";
}

std::string change_table(const Comparison& c) {
  if (c.runs.empty())
    return "<p>Both judged all of " + std::to_string(c.measurements) + " measurements alike.</p>\n";
  std::string out = "<p>" + std::to_string(c.changes.size()) + " of " + std::to_string(c.measurements) +
                    " measurements were judged differently.</p>\n<table><tr><th>sensor</th><th>model</th>"
                    "<th>from</th><th>to</th><th>measurements</th><th>first</th><th>second</th></tr>\n";
  for (std::size_t i = 0; i < std::min(kMostRuns, c.runs.size()); ++i) {
    const ChangedRun& run = c.runs[i];
    out += "<tr><td>" + escaped(run.sensor) + "</td><td>" + escaped(run.model) + "</td><td>" +
           label_of(run.begin_s, 0.01) + " s</td><td>" + label_of(run.end_s, 0.01) + " s</td><td>" +
           std::to_string(run.count) + "</td><td>" + word_of(run.first) + "</td><td>" + word_of(run.second) +
           "</td></tr>\n";
  }
  out += "</table>\n";
  if (c.runs.size() > kMostRuns)
    out += "<p class=\"soft\">The first " + std::to_string(kMostRuns) + " of " +
           std::to_string(c.runs.size()) + " stretches.</p>\n";
  return out;
}

// Where the test ratios of measurements that changed lay: crosses of each run.
std::string ratio_plot(const Comparison& c) {
  Plot plot =
      over_time(c, "Test ratio of the measurements that were judged differently (above 1 rejected)", "ratio");
  plot.levels = {{1.0, "limit"}};
  plot.logarithmic = true;
  const std::size_t stride = std::max<std::size_t>(1, c.changes.size() / kMostCrosses);
  for (std::size_t which = 0; which < 2; ++which) {
    Curve curve;
    curve.name = which == 0 ? "first" : "second";
    curve.colour = static_cast<int>(which) + 1;
    curve.shape = which == 0 ? Curve::Shape::dots : Curve::Shape::crosses;
    for (std::size_t i = 0; i < c.changes.size(); i += stride) {
      if (!known(c.changes[i].test_ratio[which])) continue;
      curve.x.push_back(c.changes[i].t_s);
      curve.y.push_back(c.changes[i].test_ratio[which]);
    }
    if (!curve.x.empty()) plot.curves.push_back(std::move(curve));
  }
  return plot.curves.empty() ? std::string() : to_svg(plot);
}

std::string answer(const Comparison& c) {
  const auto item = [](const char* cls, const char* word, const std::string& text) {
    return std::string("<li class=\"") + cls + "\"><b>" + word + "</b> " + escaped(text) + "</li>\n";
  };
  std::string out = "<ul class=\"findings\">\n";
  if (c.compared == 0) {
    out += item("bad", "wrong", "There is no instant at which both have a position.");
  } else if (equal(c)) {
    out += item("good", "equal", "The two are equal at all of " + std::to_string(c.compared) + " instants.");
  } else {
    out += item("caution", "apart",
                "The positions differ by " + brief(c.difference.horizontal_m.rms) + " m rms, at most by " +
                    brief(c.difference.horizontal_m.max) + " m at " + label_of(c.farthest_s, 0.01) + " s.");
  }
  const double first = c.solutions[0].score.horizontal_m.rms;
  const double second = c.solutions[1].score.horizontal_m.rms;
  if (known(first) && known(second) && first != second)
    out += item(second < first ? "good" : "caution", second < first ? "better" : "worse",
                "Against " + c.against + " the horizontal error of the second is " + brief(second) +
                    " m rms, of the first " + brief(first) + " m.");
  return out + "</ul>\n";
}

}  // namespace

std::string word_of(const std::optional<VerdictKind>& kind) {
  return kind ? std::string(to_string(*kind)) : std::string("not judged");
}

bool equal(const Comparison& c) {
  const dataset::Score& d = c.difference;
  bool same = c.changes.empty() && c.solutions[0].positions == c.solutions[1].positions;
  for (std::size_t i = 0; i < 3; ++i)
    same = same && !(d.position_N_m[i].max > 0.0) && !(d.velocity_N_m_s[i].max > 0.0) &&
           !(d.rpy_rad[i].max > 0.0);
  return same && c.solutions[0].horizontal_sigma_rms_m == c.solutions[1].horizontal_sigma_rms_m;
}

std::string page(const Comparison& c) {
  std::string out = page_begin(c.title);
  out += "<p class=\"soft\">" + escaped(c.source) + ", " + escaped(c.version) + "</p>\n";
  out += section("answer", "What differs", answer(c) + figure_table(c));
  out += section("track", "Track", track_plot(c));
  out += section("differences", "Differences", difference_plots(c));
  out += section("sigmas", "Sigmas", sigma_plots(c));
  if (!c.against.empty()) out += section("errors", "Errors against " + escaped(c.against), error_plots(c));
  out += section("verdicts", "Verdicts that changed", change_table(c) + ratio_plot(c));
  return out + page_end();
}

}  // namespace fathom::report
