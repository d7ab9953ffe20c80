#include "report/plot.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/command.hpp"
#include "cli/outputs.hpp"
#include "dataset/csv_reader.hpp"
#include "dataset/dataset.hpp"
#include "dataset/nav_rows.hpp"
#include "dataset/score.hpp"

namespace fathom::cli {
namespace {

struct PlotOptions {
  std::string file;
  std::vector<std::string> columns;
  std::string out;
  bool logarithmic = false;
};

std::string track(const PlotOptions& options) {
  report::Map map;
  map.title = options.file;
  report::Curve curve;
  dataset::NavRow first;
  dataset::read_nav_rows(options.file, [&](const dataset::NavRow& row) {
    if (!known(row.latitude_rad) || !known(row.longitude_rad)) return;
    if (!known(first.latitude_rad)) first = row;
    const auto d = dataset::ned_difference_m(row.latitude_rad, row.longitude_rad, 0.0, first.latitude_rad,
                                             first.longitude_rad, 0.0);
    curve.x.push_back(d[1]);
    curve.y.push_back(d[0]);
  });
  if (curve.x.empty())
    throw Failure(ExitCode::bad_input, options.file + ": no positions, expected lat_deg and lon_deg");
  map.curves.push_back(std::move(curve));
  return report::to_svg(map);
}

std::string quantities(const PlotOptions& options) {
  dataset::CsvReader csv(options.file);
  const auto t = csv.column("t_s");
  report::Plot plot;
  plot.title = options.file;
  plot.logarithmic = options.logarithmic;
  plot.height = 320;
  std::vector<dataset::CsvReader::Column> places;
  for (std::size_t i = 0; i < options.columns.size(); ++i) {
    places.push_back(csv.column(options.columns[i]));
    plot.curves.push_back({options.columns[i], {}, {}, static_cast<int>(i % 6) + 1, {}, false});
  }
  if (options.columns.size() == 1) plot.y_label = options.columns[0];
  std::size_t known_values = 0;
  while (csv.next()) {
    const double t_s = csv.number(t);
    if (!std::isfinite(t_s)) csv.fail("column t_s: '" + std::string(csv.text(t)) + "', expected seconds");
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double value = csv.number(places[i]);
      known_values += std::isfinite(value) ? 1U : 0U;
      plot.curves[i].x.push_back(t_s);
      plot.curves[i].y.push_back(value);
    }
  }
  if (known_values == 0)
    throw Failure(ExitCode::bad_input, options.file + ": no row knows a value of these columns");
  return report::to_svg(plot);
}

}  // namespace

void add_plot(CLI::App& app, ExitCode&) {
  auto options = std::make_shared<PlotOptions>();
  CLI::App* command =
      app.add_subcommand("plot", "Draws columns of nav.csv, or of any file with t_s, as SVG.");
  command->footer(
      "\"track\" instead of a column draws the way over ground. fathom plot nav.csv sigma_n_m sigma_e_m");
  command->add_option("file", options->file, "nav.csv, or a file of a data set, plain or .gz")->required();
  command->add_option("columns", options->columns, "one column or more, or \"track\"")->required();
  command->add_option("--out", options->out, "the drawing (SVG)")->required();
  command->add_flag("--log", options->logarithmic, "logarithmic scale of the values");
  command->callback([options] {
    refuse_same_files({{"the input", options->file}}, {{"--out", options->out}});
    std::string svg;
    try {
      svg = options->columns == std::vector<std::string>{"track"} ? track(*options) : quantities(*options);
    } catch (const dataset::DatasetError& error) {
      throw Failure(ExitCode::bad_input, error.what());
    }
    write_text(options->out, report::standalone(svg));
  });
}

}  // namespace fathom::cli
