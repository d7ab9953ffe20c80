#include "nmea_out/schedule.hpp"

namespace fathom::nmea_out {
namespace {

std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
  return a / b - (a % b != 0 && a < 0 ? 1 : 0);
}

}  // namespace

Schedule::Schedule(const config::NmeaOutputConfig& output) : talker_(output.talker) {
  for (const config::NmeaSentenceConfig& one : output.sentences)
    entries_.push_back({one.sentence, from_seconds(1.0 / one.rate_hz)});
}

std::string Schedule::due(const Report& report) {
  std::string out;
  for (Entry& entry : entries_) {
    const std::int64_t period = floor_divide(report.point.utc_ns, entry.period_ns);
    if (period == entry.said_in) continue;  // another one, also an earlier one where the clock was set back
    entry.said_in = period;
    out += sentence_of(report, entry.sentence, talker_);
  }
  return out;
}

}  // namespace fathom::nmea_out
