#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "cli/solve/compare/compare.hpp"
#include "cli/solve/score_text.hpp"
#include "dataset/csv_writer.hpp"

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;
using report::ComparedSolution;
using report::Comparison;

constexpr std::size_t kMostRuns = 15;          // on the terminal
constexpr std::size_t kMostChanges = 100'000;  // in JSON

Json score(const dataset::Score& s) {
  return {{"count", s.count},
          {"horizontal_m", figures<Json>(s.horizontal_m)},
          {"north_m", figures<Json>(s.position_N_m[0])},
          {"east_m", figures<Json>(s.position_N_m[1])},
          {"down_m", figures<Json>(s.position_N_m[2])},
          {"velocity_north_m_s", figures<Json>(s.velocity_N_m_s[0])},
          {"velocity_east_m_s", figures<Json>(s.velocity_N_m_s[1])},
          {"velocity_down_m_s", figures<Json>(s.velocity_N_m_s[2])},
          {"roll_deg", figures<Json>(s.rpy_rad[0], kDegPerRad)},
          {"pitch_deg", figures<Json>(s.rpy_rad[1], kDegPerRad)},
          {"yaw_deg", figures<Json>(s.rpy_rad[2], kDegPerRad)}};
}

Json solution(const ComparedSolution& s) {
  Json out = {
      {"settings", s.settings},
      {"config_hash", s.config_hash},
      {"positions", s.positions},
      {"alignment", std::string(to_string(s.alignment))},
      {"aligned_after_s", number<Json>(s.aligned_after_s)},
      {"horizontal_sigma_m",
       {{"rms", number<Json>(s.horizontal_sigma_rms_m)}, {"end", number<Json>(s.horizontal_sigma_end_m)}}}};
  out["error"] = score(s.score);
  out["error"]["nees_horizontal"] = number<Json>(s.score.nees_horizontal.mean);
  return out;
}

Json word(const std::optional<VerdictKind>& kind) {
  return kind ? Json(std::string(to_string(*kind))) : Json(nullptr);
}

void add_number(std::string& out, const char* name, double first, double second) {
  if (!known(first) && !known(second)) return;
  const auto text = [](double value) {
    std::array<char, 40> digits{};
    std::snprintf(digits.data(), digits.size(), "%.3f", value);
    return known(value) ? std::string(digits.data()) : std::string("unknown");
  };
  out += line("  %-28s %14s %14s", name, text(first).c_str(), text(second).c_str());
}

// Stretches that are alike, from the first to the last of them.
struct Pooled {
  report::ChangedRun run;
  std::size_t stretches = 1;
};

std::vector<Pooled> one_by_one(const std::vector<report::ChangedRun>& runs) {
  std::vector<Pooled> out;
  for (const report::ChangedRun& run : runs) out.push_back({run, 1});
  return out;
}

std::vector<Pooled> pooled(const std::vector<report::ChangedRun>& runs) {
  std::vector<Pooled> out;
  for (const report::ChangedRun& run : runs) {
    const auto alike = std::find_if(out.begin(), out.end(), [&run](const Pooled& one) {
      return one.run.sensor == run.sensor && one.run.model == run.model && one.run.first == run.first &&
             one.run.second == run.second;
    });
    if (alike == out.end()) {
      out.push_back({run, 1});
    } else {
      alike->run.end_s = std::max(alike->run.end_s, run.end_s);
      alike->run.count += run.count;
      ++alike->stretches;
    }
  }
  return out;
}

}  // namespace

std::string to_text(const Comparison& c) {
  const ComparedSolution& a = c.solutions[0];
  const ComparedSolution& b = c.solutions[1];
  std::string out = c.source + "\n  first:  " + a.settings + "\n  second: " + b.settings + "\n";
  out += line("  %-28s %14s %14s", "", "first", "second");
  out += line("  %-28s %14llu %14llu", "states with a position", static_cast<unsigned long long>(a.positions),
              static_cast<unsigned long long>(b.positions));
  out += line("  %-28s %14s %14s", "alignment at the end", std::string(to_string(a.alignment)).c_str(),
              std::string(to_string(b.alignment)).c_str());
  add_number(out, "aligned after, s", a.aligned_after_s, b.aligned_after_s);
  add_number(out, "horizontal sigma rms, m", a.horizontal_sigma_rms_m, b.horizontal_sigma_rms_m);
  add_number(out, "horizontal sigma at end, m", a.horizontal_sigma_end_m, b.horizontal_sigma_end_m);
  if (c.against.empty()) {
    out += "  no errors: there is neither a reference nor a smoothed solution\n";
  } else {
    out += "  errors against " + c.against + ":\n";
    add_number(out, "horizontal rms, m", a.score.horizontal_m.rms, b.score.horizontal_m.rms);
    add_number(out, "horizontal 95 %, m", a.score.horizontal_m.p95, b.score.horizontal_m.p95);
    add_number(out, "horizontal most, m", a.score.horizontal_m.max, b.score.horizontal_m.max);
    add_number(out, "down rms, m", a.score.position_N_m[2].rms, b.score.position_N_m[2].rms);
    add_number(out, "yaw rms, deg", a.score.rpy_rad[2].rms * kDegPerRad, b.score.rpy_rad[2].rms * kDegPerRad);
    add_number(out, "horizontal NEES", a.score.nees_horizontal.mean, b.score.nees_horizontal.mean);
  }
  if (c.compared == 0) {
    out += "there is no instant at which both have a position\n";
  } else if (report::equal(c)) {
    out += line("equal at all of %llu instants, and in the verdicts of all %llu measurements",
                static_cast<unsigned long long>(c.compared), static_cast<unsigned long long>(c.measurements));
    return out;
  } else {
    out +=
        line("second minus first: horizontal rms %.3f m, most %.3f m at %.2f s, end %.3f m; yaw rms %.3f deg",
             c.difference.horizontal_m.rms, c.difference.horizontal_m.max, c.farthest_s,
             c.difference.horizontal_m.end, c.difference.rpy_rad[2].rms * kDegPerRad);
  }
  out += line("verdicts that changed: %zu of %llu", c.changes.size(),
              static_cast<unsigned long long>(c.measurements));
  const bool few = c.runs.size() <= kMostRuns;
  for (const Pooled& one : few ? one_by_one(c.runs) : pooled(c.runs)) {
    const report::ChangedRun& run = one.run;
    out += line("  %10.2f to %.2f s  %s%s%s: %llu %s -> %s%s", run.begin_s, run.end_s, run.sensor.c_str(),
                run.model.empty() ? "" : " ", run.model.c_str(), static_cast<unsigned long long>(run.count),
                report::word_of(run.first).c_str(), report::word_of(run.second).c_str(),
                one.stretches > 1 ? (" in " + std::to_string(one.stretches) + " stretches").c_str() : "");
  }
  if (!few) out += "  --json and --page list each stretch\n";
  return out;
}

std::string to_json(const Comparison& c) {
  Json out;
  out["dataset"] = c.source;
  out["version"] = c.version;
  out["first"] = solution(c.solutions[0]);
  out["second"] = solution(c.solutions[1]);
  out["errors_against"] = c.against.empty() ? Json(nullptr) : Json(c.against);
  out["compared"] = c.compared;
  out["equal"] = report::equal(c);
  out["difference"] = score(c.difference);
  out["farthest_s"] = number<Json>(c.farthest_s);
  out["measurements"] = c.measurements;
  out["changed"] = c.changes.size();
  out["runs"] = Json::array();
  for (const report::ChangedRun& run : c.runs)
    out["runs"].push_back({{"sensor", run.sensor},
                           {"model", run.model},
                           {"begin_s", run.begin_s},
                           {"end_s", run.end_s},
                           {"count", run.count},
                           {"first", word(run.first)},
                           {"second", word(run.second)}});
  out["changes"] = Json::array();
  for (std::size_t i = 0; i < std::min(kMostChanges, c.changes.size()); ++i) {
    const report::VerdictChange& one = c.changes[i];
    out["changes"].push_back(
        {{"t_s", one.t_s},
         {"sensor", one.sensor},
         {"sequence", one.sequence},
         {"model", one.model},
         {"first", word(one.first)},
         {"second", word(one.second)},
         {"test_ratio", {number<Json>(one.test_ratio[0]), number<Json>(one.test_ratio[1])}}});
  }
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

struct CompareCsv::Inside {
  dataset::CsvWriter csv;
};

CompareCsv::CompareCsv(const std::string& path) : inside_(new Inside{dataset::CsvWriter(path)}) {
  inside_->csv.line(
      "t_s,d_n_m,d_e_m,d_d_m,d_vn_m_s,d_ve_m_s,d_vd_m_s,d_roll_deg,d_pitch_deg,d_yaw_deg,"
      "first_sigma_n_m,first_sigma_e_m,first_sigma_d_m,second_sigma_n_m,second_sigma_e_m,second_sigma_d_m,"
      "first_error_n_m,first_error_e_m,first_error_d_m,second_error_n_m,second_error_e_m,second_error_d_m,"
      "first_mode,second_mode");
}

CompareCsv::~CompareCsv() = default;

void CompareCsv::add(const report::ComparedRow& row) {
  dataset::CsvWriter& csv = inside_->csv;
  csv.fixed(row.t_s, 6);
  for (const double v : row.difference.position_N_m) csv.fixed(v, 6);
  for (const double v : row.difference.velocity_N_m_s) csv.fixed(v, 6);
  for (const double v : row.difference.rpy_rad) csv.fixed(v * kDegPerRad, 9);
  for (const auto& sigmas : row.position_sigma_N_m)
    for (const double v : sigmas) csv.fixed(v, 6);
  for (const auto& error : row.error)
    for (const double v : error.position_N_m) csv.fixed(v, 6);
  for (const NavMode mode : row.mode) csv.text(to_string(mode));
  csv.end_row();
}

void CompareCsv::close() {
  inside_->csv.close();
}

}  // namespace fathom::cli
