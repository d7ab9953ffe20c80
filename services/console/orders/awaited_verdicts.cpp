#include "console/orders/awaited_verdicts.hpp"

namespace fathom::console {

AwaitedVerdicts::Wait::Wait(AwaitedVerdicts& all, const SampleHeader& told) : all_(all), told_(told) {
  const std::lock_guard lock(all_.mutex_);
  place_ = all_.waits_.insert(all_.waits_.end(), this);
}

AwaitedVerdicts::Wait::~Wait() {
  const std::lock_guard lock(all_.mutex_);
  all_.waits_.erase(place_);
}

std::optional<Verdict> AwaitedVerdicts::Wait::verdict(std::chrono::milliseconds patience) {
  std::unique_lock lock(all_.mutex_);
  (void)all_.changed_.wait_for(lock, patience, [this] { return verdict_.has_value(); });
  return verdict_;
}

void AwaitedVerdicts::heard(const Verdict& verdict) {
  if (verdict.source != SourceKind::fix) return;
  {
    const std::lock_guard lock(mutex_);
    for (Wait* one : waits_) {
      const SampleHeader& told = one->told_;
      if (verdict.header.vehicle == told.vehicle && verdict.header.sensor == told.sensor &&
          verdict.header.sequence == told.sequence)
        one->verdict_ = verdict;
    }
  }
  changed_.notify_all();
}

}  // namespace fathom::console
