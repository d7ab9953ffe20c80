#include "study/runner.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "sim/random.hpp"

namespace fathom::study {
namespace {

/// The names asked for, in the study's order.
std::vector<std::string_view> chosen(const char* what, const std::vector<std::string_view>& known,
                                     const std::vector<std::string>& wanted) {
  std::vector<std::string_view> out;
  for (const std::string_view name : known)
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end()) out.push_back(name);
  for (const std::string& name : wanted) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string text = std::string(what) + ": " + name + ": expected one of";
    for (const std::string_view one : known) text += " " + std::string(one);
    throw std::invalid_argument(text);
  }
  return out;
}

/// The values of one metric of one method over the runs of one case.
bool collect(const std::vector<Scores>& runs, std::string_view method, std::string_view metric,
             std::vector<double>& values) {
  values.clear();
  for (const Scores& run : runs)
    for (const Score& score : run.all())
      if (score.method == method && score.metric == metric) values.push_back(score.value);
  return !values.empty();
}

/// Whether this run lacks a finite value of a metric that it should have.
bool failed(const Scores& run, std::string_view method, const std::vector<std::string_view>& required) {
  return std::any_of(required.begin(), required.end(), [&](std::string_view metric) {
    bool any = false;
    for (const Score& score : run.all()) {
      if (score.method != method || score.metric != metric) continue;
      if (!std::isfinite(score.value)) return true;
      any = true;
    }
    return !any;
  });
}

Statistics summary_of(const Metric& metric, const std::vector<double>& values) {
  Statistics all = statistics_of(values);
  if (metric.summary == Summary::root_mean_square) {
    all.mean = all.median = all.p05 = all.p95 = all.max = all.rms;
    if (all.n > 0) all.std = 0.0;
  }
  return all;
}

}  // namespace

std::uint64_t seed_of_run(std::uint64_t seed, int run) {
  return sim::Random(seed, "run " + std::to_string(run)).next();
}

std::vector<Row> run_study(const Study& study, const RunOptions& options) {
  const auto cases = chosen("case", study.cases(), options.cases);
  const auto methods = chosen("method", study.methods(), options.methods);
  const auto runs = static_cast<std::size_t>(std::max(options.runs, 0));
  const std::size_t total = cases.size() * runs;
  std::vector<std::vector<Scores>> scores(cases.size(), std::vector<Scores>(runs));

  // Each job writes to its own place; the order in which they are done is of no consequence.
  std::atomic<std::size_t> next{0};
  std::mutex guard;
  std::size_t done = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t job = next++; job < total; job = next++) {
      try {
        RunRequest request;
        request.case_name = cases[job / runs];
        request.seed = seed_of_run(options.seed, static_cast<int>(job % runs));
        request.methods.assign(methods.begin(), methods.end());
        study.run(request, scores[job / runs][job % runs]);
      } catch (...) {
        const std::lock_guard lock(guard);
        if (!failure) failure = std::current_exception();
        next = total;
        return;
      }
      const std::lock_guard lock(guard);
      ++done;
      if (options.progress) options.progress(done, total);
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (int i = 1; i < options.threads; ++i) helpers.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);

  std::vector<Row> rows;
  std::vector<double> values;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    for (const std::string_view method : methods) {
      std::vector<std::string_view> required;
      const std::size_t before = rows.size();
      for (const Metric& metric : study.metrics()) {
        if (!collect(scores[c], method, metric.name, values)) continue;
        if (metric.presence == Presence::always) required.push_back(metric.name);
        const Statistics statistics = summary_of(metric, values);
        rows.push_back(
            {cases[c], method, metric.name, metric.unit, statistics, values.size() - statistics.n});
      }
      if (rows.size() == before) continue;
      values.clear();
      for (const Scores& run : scores[c]) values.push_back(failed(run, method, required) ? 1.0 : 0.0);
      rows.push_back({cases[c], method, kFailedMetric, "fraction", statistics_of(values), 0});
    }
  }
  return rows;
}

}  // namespace fathom::study
