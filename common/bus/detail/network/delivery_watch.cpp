#include "bus/detail/network/delivery_watch.hpp"

#include <algorithm>
#include <utility>

#include "base/clock.hpp"

namespace fathom::bus::detail {

EntityId to_entity_id(std::span<const std::uint8_t> bytes) {
  EntityId id = 0;
  for (const std::uint8_t byte : bytes.first(4)) id = id << 8U | byte;
  return id;
}

DeliveryWatch::DeliveryWatch(std::function<TimeNs()> now_ns) : now_ns_(std::move(now_ns)) {
  if (!now_ns_) now_ns_ = [] { return SystemClock().monotonic_ns(); };
}

DeliveryWatch::Reader* DeliveryWatch::find(const void* reader) {
  const auto found =
      std::find_if(readers_.begin(), readers_.end(), [&](const Reader& one) { return one.who == reader; });
  return found == readers_.end() ? nullptr : &*found;
}

void DeliveryWatch::join(const void* reader, bool one_at_a_time, std::function<void()> deaf) {
  const std::lock_guard lock(mutex_);
  readers_.push_back({reader, one_at_a_time, std::move(deaf)});
}

void DeliveryWatch::is_entity(const void* reader, EntityId id) {
  const std::lock_guard lock(mutex_);
  Reader* const known = find(reader);
  if (known != nullptr) known->id = id;
}

void DeliveryWatch::leave(const void* reader) {
  const std::lock_guard lock(mutex_);
  std::erase_if(readers_, [&](const Reader& one) { return one.who == reader; });
}

void DeliveryWatch::matched(const void* reader, const WriterGuid& writer) {
  const std::lock_guard lock(mutex_);
  Reader* const known = find(reader);
  if (known == nullptr) return;
  std::erase_if(known->writers, [&](const Writer& one) { return one.guid == writer; });
  known->writers.push_back({writer});
}

void DeliveryWatch::unmatched(const void* reader, const WriterGuid& writer) {
  const std::lock_guard lock(mutex_);
  Reader* const known = find(reader);
  if (known == nullptr) return;
  std::erase_if(known->writers, [&](const Writer& one) { return one.guid == writer; });
}

bool DeliveryWatch::arrived(const Claim& claim) {
  constexpr std::uint8_t kBuiltin = 0xC0;  // in the last byte of an entity id
  if ((claim.writer[15] & kBuiltin) == kBuiltin) return claim.number <= kDiscovery;
  const std::lock_guard lock(mutex_);
  for (Reader& reader : readers_) {
    if (claim.reader != 0 && claim.reader != reader.id) continue;  // for another reader of this topic
    for (Writer& writer : reader.writers) {
      if (writer.guid != claim.writer) continue;
      if (writer.highest != 0 && claim.number > writer.highest + kLeap) return false;
      writer.highest = std::max(writer.highest, claim.number);
      if (!claim.carries_sample) continue;
      const TimeNs now_ns = now_ns_();
      if (writer.waiting++ == 0) {
        writer.since_ns = now_ns;
      } else {
        writer.since_ns += std::max<DurationNs>(0, now_ns - writer.last_ns - kSilence);
      }
      writer.last_ns = now_ns;
      if (writer.waiting < kSamples || now_ns - writer.since_ns < kPatience) continue;
      writer.waiting = 0;
      reader.deaf();
    }
  }
  return true;
}

void DeliveryWatch::heard(const void* reader, const WriterGuid& writer) {
  const std::lock_guard lock(mutex_);
  Reader* const known = find(reader);
  if (known == nullptr) return;
  for (Writer& one : known->writers) {
    if (known->one_at_a_time || one.guid == writer) one.waiting = 0;
  }
}

void DeliveryWatch::refused(const void* reader) {
  const std::lock_guard lock(mutex_);
  Reader* const known = find(reader);
  if (known == nullptr) return;
  for (Writer& one : known->writers) one.waiting = 0;
}

void DeliveryWatch::arrived_from(std::span<const std::uint8_t> datagram) {
  constexpr std::size_t kPrefix = 8;  // behind "RTPS", version and vendor
  GuidPrefix from{};
  if (!somebody_asked_ || datagram.size() < kPrefix + from.size()) return;
  std::copy_n(datagram.begin() + kPrefix, from.size(), from.begin());
  const std::lock_guard lock(mutex_of_participants_);
  const auto known = last_.find(from);
  if (known != last_.end()) known->second = now_ns_();
}

bool DeliveryWatch::is_heard(const GuidPrefix& participant, DurationNs age_ns) {
  somebody_asked_ = true;
  const std::lock_guard lock(mutex_of_participants_);
  const TimeNs last_ns = last_.try_emplace(participant, 0).first->second;
  return last_ns != 0 && now_ns_() - last_ns <= age_ns;
}

void DeliveryWatch::gone(const GuidPrefix& participant) {
  const std::lock_guard lock(mutex_of_participants_);
  last_.erase(participant);
}

}  // namespace fathom::bus::detail
