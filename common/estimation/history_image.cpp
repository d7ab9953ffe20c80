#include <cstring>
#include <variant>

#include "estimation/history.hpp"

namespace fathom::estimation {
namespace {

/// Says what follows. The sizes of what is held tell an image of a build that held it otherwise.
struct Head {
  std::uint64_t core_bytes = sizeof(Core);
  std::uint64_t step_bytes = sizeof(ImuStep);
  std::uint64_t event_bytes = sizeof(Measurement);
  std::uint64_t base_step = 0;   ///< steps that the navigator has taken
  std::uint64_t steps_done = 0;  ///< those from base_step on follow it
  std::uint64_t events = 0;      ///< and behind them as many events, in their order
};

bool is_bool(const bool& value) {
  unsigned char byte = 0;
  std::memcpy(&byte, &value, 1);
  return byte <= 1;
}

/// Whether it can be what it says it is: bytes from the network may be anything.
bool sound(const Measurement& event, std::size_t sensors) {
  return is_bool(event.command) && is_bool(event.judged) && is_bool(event.settled) &&
         static_cast<std::size_t>(event.said) < kVerdictKinds && event.writer.sound() &&
         event.sample.index() < std::variant_size_v<AnySample> && event.sensor >= (event.command ? -1 : 0) &&
         event.sensor < static_cast<int>(sensors) && event.header().vehicle.sound() &&
         event.header().sensor.sound();
}

}  // namespace

void History::write(ImageWriter& image) const {
  // Snapshots behind the second navigator are the first one's, and lack what the second is making up for.
  const bool second = catching_up_ && catching_.now_ns() < marks_[0].now_ns;
  Head head;
  head.base_step = second ? caught_up_step_ : marks_[0].after_step;
  head.steps_done = steps_done_;
  head.events = event_count_;
  image.put(head);
  image.put(second ? catching_ : snapshot(0));
  for (std::uint64_t step = head.base_step; step < head.steps_done; ++step) {
    image.put(steps_[step % steps_.size()]);
  }
  for (std::size_t rank = 0; rank < event_count_; ++rank) image.put(pool_[order_[rank]]);
}

bool History::read(ImageReader& image, VerdictSink& sink) {
  if (image.left() < sizeof(Head) + sizeof(Core)) return false;
  Head head;
  image.get(head);
  const Head own;
  if (head.core_bytes != own.core_bytes || head.step_bytes != own.step_bytes ||
      head.event_bytes != own.event_bytes || head.steps_done < head.base_step ||
      head.steps_done - head.base_step > steps_.size() || head.events > order_.size()) {
    return false;
  }
  const std::uint64_t steps = head.steps_done - head.base_step;
  if (image.left() != sizeof(Core) + steps * sizeof(ImuStep) + head.events * sizeof(Measurement))
    return false;
  ImageReader events = image;
  events.skip(sizeof(Core) + steps * sizeof(ImuStep));
  for (std::uint64_t i = 0; i < head.events; ++i) {
    Measurement event;
    events.get(event);
    if (!sound(event, setup_->config.sensors.size())) return false;
  }
  forget_past(sink, VerdictKind::not_aligned);
  core_.read(image);
  for (std::uint64_t step = head.base_step; step < head.steps_done; ++step) {
    image.get(steps_[step % steps_.size()]);
  }
  for (std::size_t rank = 0; rank < order_.size(); ++rank) order_[rank] = static_cast<std::uint16_t>(rank);
  event_count_ = head.events;
  for (std::size_t rank = 0; rank < event_count_; ++rank) {
    image.get(pool_[rank]);
    judgements_[rank] = {};  // until it acts again
    judgements_[rank].kind = pool_[rank].said;
    // Those that have their final verdict are the oldest.
    if (settled_count_ == rank && (pool_[rank].settled || pool_[rank].command)) ++settled_count_;
  }
  steps_done_ = head.base_step;
  started_ = true;
  save(sink);
  repeat_until(head.steps_done, sink);
  return true;
}

}  // namespace fathom::estimation
