#include "report/page_plots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "base/units.hpp"
#include "report/plot.hpp"

namespace fathom::report {
namespace {

constexpr double kChi95 = 2.4477;  // radius that holds 95 % of a plane's normal distribution
constexpr std::array<const char*, 3> kAxes{"north", "east", "down"};

std::vector<Span> without_gps(const Material& m) {
  std::vector<Span> spans;
  for (const Outage& one : m.outages) spans.push_back({one.begin_s, one.end_s});
  return spans;
}

std::vector<double> times(const Material& m) {
  std::vector<double> out;
  for (const StateRow& row : m.states) out.push_back(row.t_s);
  return out;
}

std::vector<double> values(const Material& m, const std::function<double(const StateRow&)>& of) {
  std::vector<double> out;
  for (const StateRow& row : m.states) out.push_back(of(row));
  return out;
}

Plot over_time(const Material& m, const std::string& title, const std::string& unit) {
  Plot plot;
  plot.title = title;
  plot.y_label = unit;
  plot.spans = without_gps(m);
  plot.span_name = "without GPS";
  plot.x_from = m.begin_s;
  plot.x_to = m.end_s;
  return plot;
}

template <class Row>
Curve places(const std::string& name, const std::vector<Row>& rows, const StateRow& origin, int colour) {
  Curve curve;
  curve.name = name;
  curve.colour = colour;
  for (const Row& row : rows) {
    const auto d = dataset::ned_difference_m(row.latitude_rad, row.longitude_rad, 0.0, origin.latitude_rad,
                                             origin.longitude_rad, 0.0);
    curve.x.push_back(d[1]);
    curve.y.push_back(d[0]);
  }
  return curve;
}

Ellipse ellipse_of(const StateRow& row, double north_m, double east_m) {
  const auto& p = row.covariance_NE_m2;
  const double mean = (p[0] + p[3]) / 2.0;
  const double half = std::hypot((p[0] - p[3]) / 2.0, p[1]);
  Ellipse out;
  out.x = east_m;
  out.y = north_m;
  out.major = kChi95 * std::sqrt(std::max(0.0, mean + half));
  out.minor = kChi95 * std::sqrt(std::max(0.0, mean - half));
  // From east towards north, as the map has them.
  out.angle_rad = 0.5 * std::atan2(2.0 * p[1], p[3] - p[0]);
  return out;
}

// Dots of a picture, at most: all that were not used, and of the others an even choice.
constexpr std::size_t kMostDots = 2500;

std::string innovation_plot(const Material& m, const Source& source) {
  Plot plot = over_time(m, source.sensor + ", " + source.model, "sigmas");
  plot.most = 6.0;
  plot.height = 190;
  plot.levels = {{2.0, ""}, {-2.0, ""}};
  std::array<Curve, 3> dots;
  Curve rejected{"rejected", {}, {}, 0, Curve::Shape::crosses, false};
  const std::size_t stride = std::max<std::size_t>(1, source.judged.size() / kMostDots);
  std::size_t dimensions = 0;
  std::size_t number = 0;
  std::size_t crosses = 0;
  for (const Judged& one : source.judged) {
    dimensions = std::max<std::size_t>(dimensions, one.dimensions);
    const bool used = one.kind == VerdictKind::used;
    const bool refused = one.kind == VerdictKind::rejected || one.kind == VerdictKind::disputed;
    if (used && number++ % stride != 0) continue;
    if (refused && crosses++ > kMostDots) continue;
    for (std::size_t i = 0; i < one.dimensions; ++i) {
      if (used) {
        dots[i].x.push_back(one.t_s);
        dots[i].y.push_back(static_cast<double>(one.normalised[i]));
      } else if (refused && std::abs(one.normalised[i]) > 2.0F) {
        rejected.x.push_back(one.t_s);
        rejected.y.push_back(static_cast<double>(one.normalised[i]));
      }
    }
  }
  if (dimensions == 0) return {};  // nothing was compared with navigation
  for (std::size_t i = 0; i < dimensions; ++i) {
    dots[i].name = dimensions == 1 ? "used" : "component " + std::to_string(i + 1);
    dots[i].colour = static_cast<int>(i) + 1;
    dots[i].shape = Curve::Shape::dots;
    plot.curves.push_back(std::move(dots[i]));
  }
  if (!rejected.x.empty()) plot.curves.push_back(std::move(rejected));
  return to_svg(plot);
}

}  // namespace

std::string track_plot(const Material& m) {
  const auto first = std::find_if(m.states.begin(), m.states.end(),
                                  [](const StateRow& row) { return known(row.latitude_rad); });
  if (first == m.states.end()) return "<p>There is no position to draw.</p>\n";
  Map map;
  map.title = "Track, metres from the first position";
  if (!m.fixes.empty()) {
    Curve fixes = places("GPS fixes", m.fixes, *first, 6);
    fixes.shape = Curve::Shape::dots;
    map.curves.push_back(std::move(fixes));
  }
  if (!m.reference.empty()) {
    Curve reference = places("reference", m.reference, *first, 2);
    reference.dashed = true;
    map.curves.push_back(std::move(reference));
  }
  Curve track = places("navigation", m.states, *first, 1);
  double extent_m = 1.0;
  for (std::size_t i = 0; i < track.x.size(); ++i)
    if (std::isfinite(track.x[i]))
      extent_m = std::max({extent_m, std::abs(track.x[i]), std::abs(track.y[i])});
  std::vector<double> sizes;
  const std::size_t stride = std::max<std::size_t>(1, m.states.size() / 14);
  for (std::size_t i = stride / 2; i < m.states.size(); i += stride) {
    if (!known(track.x[i]) || !known(m.states[i].covariance_NE_m2[0])) continue;
    map.ellipses.push_back(ellipse_of(m.states[i], track.y[i], track.x[i]));
    sizes.push_back(map.ellipses.back().major);
  }
  if (!sizes.empty()) {
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2),
                     sizes.end());
    // Large enough to be seen: a power of ten, and 1 where they are.
    const double wanted = extent_m / 60.0 / std::max(1e-6, sizes[sizes.size() / 2]);
    // The largest stays within the picture.
    const double most = extent_m / 5.0 / std::max(1e-6, *std::max_element(sizes.begin(), sizes.end()));
    map.enlarged = std::max(
        1.0, std::pow(10.0, std::min(std::ceil(std::log10(wanted) - 0.5), std::floor(std::log10(most)))));
  }
  map.curves.push_back(std::move(track));
  std::string note = "<p class=\"soft\">Ellipses hold 95 % of where the vehicle may be";
  if (map.enlarged > 1.0) note += ", drawn " + brief(map.enlarged) + " times as large";
  return to_svg(map) + note + ".</p>\n";
}

std::string error_plots(const Material& m) {
  std::string out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Plot plot = over_time(m, std::string("Position error ") + kAxes[axis], "m");
    plot.height = 190;
    Curve curve{"error", {}, {}, 1, Curve::Shape::line, false};
    Band band{"2 sigma", {}, {}, {}, 1};
    for (const ErrorRow& row : m.errors) {
      curve.x.push_back(row.t_s);
      curve.y.push_back(row.error.position_N_m[axis]);
      band.x.push_back(row.t_s);
      band.high.push_back(2.0 * row.position_sigma_N_m[axis]);
      band.low.push_back(-2.0 * row.position_sigma_N_m[axis]);
    }
    plot.curves.push_back(std::move(curve));
    plot.bands.push_back(std::move(band));
    out += to_svg(plot);
  }
  Plot attitude = over_time(m, "Attitude error", "degrees");
  attitude.height = 190;
  for (std::size_t i = 0; i < 3; ++i) {
    Curve curve{std::array<const char*, 3>{"roll", "pitch", "yaw"}[i],
                {},
                {},
                static_cast<int>(i) + 1,
                Curve::Shape::line,
                false};
    for (const ErrorRow& row : m.errors) {
      curve.x.push_back(row.t_s);
      curve.y.push_back(row.error.rpy_rad[i] * kDegPerRad);
    }
    attitude.curves.push_back(std::move(curve));
  }
  // A reference may know no attitude.
  const bool any = std::any_of(m.errors.begin(), m.errors.end(),
                               [](const ErrorRow& row) { return known(row.error.rpy_rad[2]); });
  return any ? out + to_svg(attitude) : out;
}

std::string nees_plot(const Material& m) {
  Plot plot = over_time(m, "NEES of the horizontal position", "e' P^-1 e");
  plot.logarithmic = true;
  Curve curve{"NEES", {}, {}, 1, Curve::Shape::line, false};
  for (const ErrorRow& row : m.errors) {
    curve.x.push_back(row.t_s);
    curve.y.push_back(std::max(row.error.nees_horizontal, 1e-3));
  }
  plot.curves.push_back(std::move(curve));
  const dataset::Nees& nees = m.score.nees_horizontal;
  plot.levels = {{nees.band_95[0], ""}, {nees.band_95[1], "95 % of a true filter lie between the lines"}};
  return to_svg(plot) + "<p>Mean " + brief(nees.mean) + ", expected about " + std::to_string(nees.dof) +
         "; " + brief(100.0 * nees.inside) +
         " % lie in the band of 95 %. Errors of one run hang together, so a share "
         "other than 95 % is no proof by itself.</p>\n";
}

std::string sigma_plots(const Material& m) {
  const std::vector<double> t = times(m);
  Plot position = over_time(m, "Sigma of the position", "m");
  Plot velocity = over_time(m, "Sigma of the velocity", "m/s");
  Plot attitude = over_time(m, "Sigma of the attitude", "degrees");
  position.logarithmic = velocity.logarithmic = attitude.logarithmic = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const int colour = static_cast<int>(i) + 1;
    position.curves.push_back({kAxes[i], t,
                               values(m, [i](const StateRow& r) { return r.position_sigma_N_m[i]; }), colour,
                               Curve::Shape::line, false});
    velocity.curves.push_back({kAxes[i], t,
                               values(m, [i](const StateRow& r) { return r.velocity_sigma_N_m_s[i]; }),
                               colour, Curve::Shape::line, false});
    attitude.curves.push_back({std::array<const char*, 3>{"roll", "pitch", "yaw"}[i], t,
                               values(m, [i](const StateRow& r) { return r.rpy_sigma_rad[i] * kDegPerRad; }),
                               colour, Curve::Shape::line, false});
  }
  return to_svg(position) + to_svg(velocity) + to_svg(attitude);
}

std::string innovation_plots(const Material& m) {
  std::string out;
  for (const Source& source : m.sources) out += innovation_plot(m, source);
  return out;
}

std::string forecast_plot(const Material& m) {
  Plot plot = over_time(m, "At the end of each outage: what was forecast, what came", "m");
  Curve forecast{"95 % forecast", {}, {}, 1, Curve::Shape::dots, false};
  Curve error{"error", {}, {}, 2, Curve::Shape::crosses, false};
  for (const Outage& one : m.outages) {
    if (known(one.forecast_95_m)) {
      forecast.x.push_back(one.end_s);
      forecast.y.push_back(one.forecast_95_m);
    }
    if (known(one.error_m)) {
      error.x.push_back(one.end_s);
      error.y.push_back(one.error_m);
    }
  }
  if (forecast.x.empty() || error.x.empty()) return {};
  plot.curves = {forecast, error};
  return to_svg(plot);
}

std::string alignment_plot(const Material& m) {
  const std::vector<double> t = times(m);
  Plot plot = over_time(m, "Attitude", "degrees");
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<double> y = values(m, [i](const StateRow& r) { return r.rpy_rad[i] * kDegPerRad; });
    // No line across the page where yaw passes south.
    std::vector<double> x = t;
    for (std::size_t k = y.size(); i == 2 && k > 1; --k) {
      if (!(std::abs(y[k - 1] - y[k - 2]) > 180.0)) continue;
      x.insert(x.begin() + static_cast<std::ptrdiff_t>(k - 1), x[k - 1]);
      y.insert(y.begin() + static_cast<std::ptrdiff_t>(k - 1), kUnknown);
    }
    plot.curves.push_back({std::array<const char*, 3>{"roll", "pitch", "yaw"}[i], std::move(x), std::move(y),
                           static_cast<int>(i) + 1, Curve::Shape::line, false});
  }
  return to_svg(plot);
}

}  // namespace fathom::report
