#include "console/view/beacon_book.hpp"

#include <cmath>

namespace fathom::console {
namespace {

bool can_be_drawn(const RangeSample& sample) {
  return std::isfinite(sample.beacon_latitude_rad) && std::isfinite(sample.beacon_longitude_rad) &&
         std::isfinite(sample.range_m) && sample.range_m >= 0.0;
}

}  // namespace

void BeaconBook::add(const RangeSample& sample, const health::Instant& at) {
  if (!can_be_drawn(sample)) return;
  forget(at.monotonic_ns);
  const std::pair key{sample.header.sensor, sample.beacon};
  if (beacons_.size() >= kMostBeacons && !beacons_.contains(key)) return;
  Heard heard{sample, std::nullopt, at.monotonic_ns};
  for (std::size_t i = 0; i < judged_.size(); ++i) {
    const Judged& judged = judged_[i];
    if (judged.sensor == sample.header.sensor && judged.stamp_ns == sample.header.stamp_ns)
      heard.verdict = judged.kind;
  }
  beacons_[key] = heard;
}

void BeaconBook::judge(const Verdict& verdict) {
  if (verdict.source != SourceKind::range) return;
  judged_.push({verdict.header.sensor, verdict.header.stamp_ns, verdict.kind});
  for (auto& [key, heard] : beacons_) {
    const SampleHeader& header = heard.range.header;
    if (header.sensor == verdict.header.sensor && header.stamp_ns == verdict.header.stamp_ns)
      heard.verdict = verdict.kind;
  }
}

std::vector<BeaconLine> BeaconBook::lines(const health::Instant& at) {
  forget(at.monotonic_ns);
  std::vector<BeaconLine> out;
  for (const auto& [key, heard] : beacons_)
    out.push_back({heard.range, to_seconds(at.monotonic_ns - heard.at_ns), heard.verdict});
  return out;
}

void BeaconBook::forget(TimeNs monotonic_ns) {
  std::erase_if(beacons_, [&](const auto& entry) {
    return monotonic_ns - entry.second.at_ns > from_seconds(kForgottenS);
  });
}

}  // namespace fathom::console
