#include "blackbox/player.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "base/clock.hpp"
#include "bus/raw.hpp"
#include "bus/topics.hpp"

namespace fathom::blackbox {
namespace {

using std::chrono::steady_clock;

// Readers that are there find the writers within this time.
constexpr std::chrono::milliseconds kToBeMet(1000);
constexpr std::chrono::milliseconds kLook(50);

bool is_known(const std::string& topic) {
  const auto all = bus::all_topics();
  return std::any_of(all.begin(), all.end(), [&](const bus::TopicInfo& one) { return topic == one.topic; });
}

class Pace {
 public:
  Pace(double speed, const std::function<bool()>& go_on) : speed_(speed), go_on_(go_on) {}

  /// Waits until it is time for a message. False: enough.
  bool wait_for(TimeNs log_ns) {
    if (!first_ns_) {
      first_ns_ = log_ns;
      began_ = steady_clock::now();
    }
    if (speed_ <= 0.0) return go_on_();
    const auto due = began_ + std::chrono::nanoseconds(static_cast<std::int64_t>(
                                  static_cast<double>(log_ns - *first_ns_) / speed_));
    while (steady_clock::now() < due) {
      if (!go_on_()) return false;
      std::this_thread::sleep_until(std::min(due, steady_clock::now() + kLook));
    }
    return go_on_();
  }

 private:
  double speed_;
  const std::function<bool()>& go_on_;
  std::optional<TimeNs> first_ns_;
  steady_clock::time_point began_;
};

}  // namespace

Played play(record::Reader& reader, bus::Participant& participant, const PlayOptions& options,
            const std::function<bool()>& go_on) {
  Played out;
  std::map<std::string, std::unique_ptr<bus::RawWriter>> writers;
  const auto& chosen = options.selection.topics;
  for (const auto& [id, channel] : reader.contents().channels) {
    const bool wanted =
        chosen.empty() || std::find(chosen.begin(), chosen.end(), channel.topic) != chosen.end();
    if (!wanted || !is_known(channel.topic) || channel.message_encoding != "cdr" ||
        writers.contains(channel.topic))
      continue;
    bus::WriterOptions silent;
    silent.may_rest = true;  // a recording has gaps
    try {
      writers[channel.topic] = std::make_unique<bus::RawWriter>(participant, channel.topic, silent);
    } catch (const bus::BusError& error) {  // e.g. without permission for it
      writers[channel.topic] = nullptr;
      out.problems.push_back(channel.topic + " is not played: " + error.what());
    }
  }
  std::this_thread::sleep_for(kToBeMet);
  Pace pace(options.speed, go_on);
  std::optional<DurationNs> shift_ns;
  const record::Outcome outcome = reader.read(options.selection, [&](const record::Channel& channel,
                                                                     const record::Message& message) {
    const auto writer = writers.find(channel.topic);
    if (writer == writers.end() || !writer->second) return true;
    if (!pace.wait_for(message.log_time)) return false;
    if (!shift_ns) shift_ns = options.now ? SystemClock().utc_ns() - message.log_time : 0;
    std::optional<std::vector<std::uint8_t>> bytes(std::in_place, message.data.begin(), message.data.end());
    if (options.now || !options.vehicles.empty()) {
      bytes = bus::with_header(channel.topic, message.data, [&](SampleHeader& header) {
        header.stamp_ns += *shift_ns;
        header.received_ns += *shift_ns;
        const auto renamed = options.vehicles.find(header.vehicle.str());
        if (renamed != options.vehicles.end()) header.vehicle = Name(renamed->second);
      });
    }
    const bool written = bytes && writer->second->write(std::move(*bytes));
    ++(written ? out.samples : out.refused);
    return true;
  });
  out.problems.insert(out.problems.end(), outcome.problems.begin(), outcome.problems.end());
  return out;
}

}  // namespace fathom::blackbox
