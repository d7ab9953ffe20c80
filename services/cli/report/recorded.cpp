#include "cli/report/recorded.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "cli/explain/read.hpp"
#include "cli/recording.hpp"
#include "explain/account.hpp"
#include "explain/sentence.hpp"

namespace fathom::cli {
namespace {

using report::ServiceRow;

std::vector<ServiceRow> services_of(const explain::History& history, TimeNs epoch_ns) {
  std::map<std::uint32_t, ServiceRow> rows;
  std::map<std::uint32_t, std::set<std::pair<std::uint32_t, TimeNs>>> processes;
  for (const explain::LifeSign& sign : history.life_signs()) {
    const auto [found, is_new] = rows.try_emplace(sign.service);
    ServiceRow& row = found->second;
    if (is_new) {
      row.name = history.name(sign.service);
      row.first_s = to_seconds(sign.log_ns - epoch_ns);
    }
    row.host = sign.host;
    processes[sign.service].insert({sign.pid, sign.started_ns});
    if (sign.before_ns != 0)
      row.longest_silence_s = std::max(row.longest_silence_s, to_seconds(sign.log_ns - sign.before_ns));
    if (std::abs(to_seconds(sign.utc_offset_ns)) > std::abs(row.clock_set_s))
      row.clock_set_s = to_seconds(sign.utc_offset_ns);
    if (sign.state == ServiceState::degraded && row.complaint.empty())
      row.complaint = sign.text.empty() ? "degraded" : sign.text;
  }
  std::vector<ServiceRow> out;
  for (auto& [number, row] : rows) {
    row.processes = processes[number].size();
    const auto last = history.last_life_ns().find(number);
    if (last != history.last_life_ns().end()) {
      row.last_s = to_seconds(last->second - epoch_ns);
      const double silent_s = to_seconds(history.to_ns() - last->second);
      row.ended_early = silent_s > to_seconds(explain::LifeSign::kSilence_ns);
    }
    out.push_back(std::move(row));
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return out;
}

}  // namespace

void add_recorded(const std::string& file, const std::string& vehicle, TimeNs epoch_ns,
                  report::Material& material) {
  explain::History history({}, Name(vehicle));
  record::Reader reader = open_recording(file);
  (void)read_into(history, reader, {});  // what is damaged was named when the samples were read
  if (history.empty()) return;
  material.services = services_of(history, epoch_ns);
  const explain::Answer answer = explain::answer(history, {});
  for (const std::size_t root : answer.roots) {
    const explain::Finding& one = answer.findings[root];
    if (!explain::named(one)) continue;
    const std::string what = explain::advice(one);
    material.told.push_back(
        {to_seconds(one.begin_ns - epoch_ns), explain::sentence(one) + (what.empty() ? "" : " " + what)});
  }
}

}  // namespace fathom::cli
