#include "cli/decode/json.hpp"

#include "cli/decode/fields.hpp"
#include "samples/kinds.hpp"

namespace fathom::cli {
namespace {

// Any calendar clock is past 1980, no count since start ever gets there.
constexpr TimeNs kCalendarFrom_ns = 315'532'800 * kNsPerSecond;

/// Names come from the device: bytes that are not UTF-8 are replaced.
std::string text(const Json& line) {
  return line.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

TimeNs utc_of(const codec::DeviceTime& time) {
  if (time.utc_ns) return *time.utc_ns;
  if (time.clock_ns && *time.clock_ns >= kCalendarFrom_ns) return *time.clock_ns;
  return 0;
}

std::string to_json(const codec::Decoded& decoded) {
  Json line;
  line["kind"] = to_string(source_of(decoded.sample));
  const TimeNs utc = utc_of(decoded.time);
  line["stamp_utc"] = utc != 0 ? Json(to_iso8601(utc, 6)) : Json();
  line["offset"] = decoded.offset;
  line["length"] = decoded.length;
  std::visit([&](const auto& sample) { add_fields(line, sample); }, decoded.sample);
  const auto optional = [](const std::optional<std::int64_t>& ns) { return ns ? Json(*ns) : Json(); };
  line["device_utc_ns"] = optional(decoded.time.utc_ns);
  line["device_clock_ns"] = optional(decoded.time.clock_ns);
  line["device_time_of_day_ns"] = optional(decoded.time.time_of_day_ns);
  line["device_age_ns"] = optional(decoded.time.age_ns);
  return text(line);
}

std::string to_json(const RejectionRun& run) {
  Json line;
  line["rejected"] = codec::to_string(run.first.reason);
  line["offset"] = run.first.offset;
  line["length"] = run.first.length;
  if (run.count > 1) line["count"] = run.count;
  return text(line);
}

std::string to_json(const codec::Totals& totals) {
  Json sums;
  sums["bytes"] = totals.bytes;
  sums["samples"] = totals.samples;
  sums["rejected"] = totals.rejected;
  sums["skipped_bytes"] = totals.skipped_bytes;
  sums["frames_ignored"] = totals.frames_ignored;
  Json line;
  line["totals"] = std::move(sums);
  return text(line);
}

}  // namespace fathom::cli
