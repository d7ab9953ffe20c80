#include "fusion/verdict_publisher.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace fathom::fusion {
namespace {

/// How long verdicts are kept for a takeover: longer than it takes to notice that the leader is gone. In
/// vehicle time, as the clock runs.
DurationNs relayed_ns(const Clock& clock) {
  return 5 * kNsPerSecond * static_cast<DurationNs>(std::ceil(std::max(1.0, clock.rate())));
}

}  // namespace

VerdictPublisher::VerdictPublisher(host::ServiceHost& host, std::mutex& mutex,
                                   estimation::FusionEngine& engine, std::function<bool()> speaks)
    : host_(host),
      mutex_(mutex),
      engine_(engine),
      speaks_(std::move(speaks)),
      relay_(relayed_ns(host.clock())),
      verdicts_(host.participant()) {
  if (!speaks_) return;
  others_.emplace(host.participant(), [this](const Verdict& verdict, const bus::SampleInfo& info) {
    if (verdict.header.vehicle.view() != host_.common().vehicle || info.writer_guid == verdicts_.guid())
      return;
    const std::lock_guard lock(mutex_);
    relay_.heard(verdict, host_.clock().monotonic_ns());
  });
}

void VerdictPublisher::publish() {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(publishing_, true)) return;
  }
  std::array<Verdict, 32> batch;
  for (std::size_t taken = batch.size(); taken > 0;) {
    const bool heard = aloud();
    {
      const std::lock_guard lock(mutex_);
      taken = take(batch, heard);
      publishing_ = taken > 0;
    }
    for (const Verdict& verdict : std::span(batch).first(taken)) verdicts_.write(verdict);
  }
}

std::size_t VerdictPublisher::take(std::span<Verdict> batch, bool aloud) {
  const TimeNs now_ns = host_.clock().monotonic_ns();
  std::size_t taken = 0;
  while (aloud && taken < batch.size() && relay_.next_unsaid(batch[taken], now_ns)) ++taken;
  while (taken < batch.size() && engine_.next_verdict(batch[taken])) {
    Verdict& verdict = batch[taken];
    count(verdict);
    if (verdict.source == SourceKind::imu) verdict.writer = imu_writer_;
    if (!aloud)
      relay_.own(verdict, now_ns);
    else if (!relay_.was_heard(verdict, now_ns))
      ++taken;
  }
  return taken;
}

void VerdictPublisher::publish(const Verdict& verdict) {
  bool heard = aloud();
  {
    const std::lock_guard lock(mutex_);
    const TimeNs now_ns = host_.clock().monotonic_ns();
    count(verdict);
    if (!heard)
      relay_.own(verdict, now_ns);
    else
      heard = !relay_.was_heard(verdict, now_ns);
  }
  if (heard) verdicts_.write(verdict);
}

void VerdictPublisher::count(const Verdict& verdict) {
  figures_.tally.add(verdict);
  if (verdict.is_final) ++figures_.final_ones;
  if (verdict.revision > 0 && is_news(verdict)) ++figures_.revised;
}

VerdictFigures VerdictPublisher::figures() const {
  VerdictFigures out = figures_;
  out.dropped = engine_.verdicts_dropped();
  return out;
}

}  // namespace fathom::fusion
