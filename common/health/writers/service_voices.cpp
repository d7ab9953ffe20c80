#include "health/writers/service_voices.hpp"

#include <algorithm>
#include <utility>

#include "health/text.hpp"

namespace fathom::health {
namespace {

constexpr std::size_t kMaxVoices = 8;
// One that ends may be heard once more after its successor, and the successor then: two turns. Two that live
// go on.
constexpr int kTurnsOfTwoThatLive = 3;

}  // namespace

bool ServiceVoices::hear(const ServiceStatus& status, TimeNs now_ns) {
  const auto found = std::find_if(voices_.begin(), voices_.end(), [&](const Voice& one) {
    return one.pid == status.pid && one.started_ns == status.started_ns && one.host == status.host;
  });
  if (found == voices_.end()) {
    if (voices_.size() == kMaxVoices) voices_.erase(voices_.begin());
    voices_.push_back({status.pid, status.started_ns, status.host, now_ns});
    return true;
  }
  if (found + 1 != voices_.end()) ++returns_;
  found->heard_ns = now_ns;
  std::rotate(found, found + 1, voices_.end());
  return false;
}

void ServiceVoices::forget(TimeNs now_ns, double after_s) {
  while (voices_.size() > 1 && to_seconds(now_ns - voices_.front().heard_ns) > after_s)
    voices_.erase(voices_.begin());
  if (voices_.size() < 2) returns_ = 0;
}

bool ServiceVoices::several() const {
  return voices_.size() > 1 && returns_ >= kTurnsOfTwoThatLive;
}

std::string ServiceVoices::sentence_about(const char* service) const {
  const Voice* one = &voices_[voices_.size() - 2];
  const Voice* other = &voices_.back();
  if (other->pid < one->pid) std::swap(one, other);
  return sentence("Several processes call themselves %s: process %u on host %s and process %u on host %s.",
                  service, one->pid, one->host.c_str(), other->pid, other->host.c_str());
}

}  // namespace fathom::health
