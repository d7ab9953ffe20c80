#include "blackbox/tap.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <thread>
#include <utility>

#include "blackbox/enclosures.hpp"
#include "blackbox/surroundings.hpp"
#include "bus/cdr.hpp"
#include "bus/foreign.hpp"
#include "bus/raw.hpp"
#include "bus/topics.hpp"
#include "samples/command.hpp"
#include "samples/status/health.hpp"

namespace fathom::blackbox {
namespace {

constexpr std::size_t kMostOrigins = 4096;  // writers come from the network: bounded
constexpr std::size_t kMostNamed = 512;     // alarms and services
constexpr std::size_t kMostForeign = 256;   // topics of others

constexpr DurationNs kClockWasSet_ns = kNsPerSecond / 100;

/// Who listens to a thousand samples a second mostly wakes up and goes to sleep again. A thread that had to
/// wait for a sample rests, and takes what has come meanwhile at once: the socket has room for it, and nobody
/// waits for a recorder. It never rests twice within kAwake, nor while it is behind, as when others want the
/// processor.
class Rest {
 public:
  /// Before a sample is taken that was written so long ago.
  void begin(DurationNs age_ns) {
    const auto now = Clock::now();
    if (now - done_ <= kWaited || now - rested_ <= kAwake || age_ns > kBehind_ns) return;
    std::this_thread::sleep_for(kRest);
    rested_ = Clock::now();
  }
  void end() { done_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::microseconds kWaited{300};
  static constexpr std::chrono::milliseconds kAwake{3};
  static constexpr std::chrono::milliseconds kRest{10};
  static constexpr DurationNs kBehind_ns = 15 * kNsPerMillisecond;

  Clock::time_point done_{};
  Clock::time_point rested_{};
};

std::string hexadecimal(const WriterGuid& guid) {
  std::string out;
  for (const std::uint8_t byte : guid) {
    std::array<char, 3> digits{};
    std::snprintf(digits.data(), digits.size(), "%02x", byte);
    out += digits.data();
  }
  return out;
}

bool is_of(const std::string& topic, const std::string& pattern) {
  if (!pattern.ends_with('*')) return topic == pattern;
  return topic.starts_with(std::string_view(pattern).substr(0, pattern.size() - 1));
}

std::string in_words(const Command& order) {
  std::string text = order.header.sensor.str() + " ordered " + std::string(to_string(order.kind));
  if (!order.target.view().empty()) text += " of " + order.target.str();
  return text;
}

}  // namespace

/// Which process a service is, and how its host's clock stands.
struct Process {
  std::string host;
  std::uint32_t pid = 0;
  TimeNs started_ns = 0;
  DurationNs utc_offset_ns = 0;

  [[nodiscard]] bool is(const Process& other) const {
    return host == other.host && pid == other.pid && started_ns == other.started_ns;
  }
};

struct Tap::Impl {
  Impl(bus::Participant& participant_in, Queue& queue_in, const Clock& clock_in,
       const std::vector<std::string>& topics, std::string host_in, std::string catalogue_in)
      : participant(participant_in),
        queue(queue_in),
        clock(clock_in),
        host(std::move(host_in)),
        catalogue(std::move(catalogue_in)) {
    for (const bus::TopicInfo& topic : bus::all_topics()) {
      const bool named = std::find(topics.begin(), topics.end(), topic.topic) != topics.end();
      // The engine's state is for those who may take over, unless it is asked for.
      const bool usual = topics.empty() && topic.topic != std::string_view("fathom/v1/engine_state");
      if (named || usual) listen(topic);
    }
  }

  /// All topics end at one instant, not one after the other: what was said of a sample is not there without
  /// it.
  ~Impl() { ending = true; }

  void listen(const bus::TopicInfo& topic) {
    bus::ReaderOptions options;
    options.profile_suffix = "deep";
    try {
      auto reader = std::make_unique<bus::RawReader>(
          participant, topic.topic,
          [this, topic, latched = bus::is_latched(participant, topic.topic)](
              std::span<const std::uint8_t> bytes, const bus::SampleInfo& info) {
            if (ending) return;
            thread_local Rest rest;
            rest.begin(SystemClock().utc_ns() - info.source_ns);
            take(topic, latched, bytes, info);
            rest.end();
          },
          options);
      readers.push_back(std::move(reader));
    } catch (const bus::BusError& error) {  // e.g. without permission for it
      refused.push_back(error.what());
    }
  }

  std::vector<std::string> look_around(const std::vector<std::string>& patterns) {
    std::vector<std::string> troubles;
    for (const bus::ForeignTopic& topic : bus::foreign_topics(participant)) {
      const bool wanted = std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
        return is_of(topic.topic, pattern);
      });
      if (!wanted || foreign.size() >= kMostForeign) continue;
      const auto [at, is_new] = foreign.try_emplace({topic.topic, topic.type});
      if (!is_new) continue;
      at->second.name = topic;
      try {
        at->second.reader = std::make_unique<bus::ForeignReader>(
            participant, topic,
            [this, name = &at->second.name](std::span<const std::uint8_t> bytes,
                                            const bus::SampleInfo& info) {
              if (!ending) (void)put(name->topic.c_str(), name->type.c_str(), name->latched, "", bytes, info);
            });
      } catch (const bus::BusError& error) {
        troubles.emplace_back(error.what());
      }
    }
    return troubles;
  }

  void take(const bus::TopicInfo& topic, bool latched, std::span<const std::uint8_t> bytes,
            const bus::SampleInfo& info) {
    const std::string key = latched ? bus::key_of(topic.topic, bytes).value_or("") : "";
    const auto now_ns = put(topic.topic, topic.type, latched, key, bytes, info);
    if (!now_ns) return;
    if (topic.topic == std::string_view("fathom/v1/alarm")) {
      if (const auto alarm = bus::from_cdr<Alarm>(bytes)) note(*alarm, *now_ns);
    } else if (topic.topic == std::string_view("fathom/v1/command")) {
      if (const auto order = bus::from_cdr<Command>(bytes))
        queue.put(Event{*now_ns, "order", in_words(*order)});
    } else if (topic.topic == std::string_view("fathom/v1/service_status")) {
      if (const auto status = bus::from_cdr<ServiceStatus>(bytes)) enclose(*status, *now_ns);
    }
  }

  /// When it came, the vehicle's time; nothing where there are too many writers to tell apart. `topic` and
  /// `type` are kept as long as this.
  std::optional<TimeNs> put(const char* topic, const char* type, bool latched,
                            const std::string& key_of_sample, std::span<const std::uint8_t> bytes,
                            const bus::SampleInfo& info) {
    Sample sample;
    sample.log_ns = clock.utc_ns();
    // The writer's clock is its host's; the vehicle's may run at another rate.
    const DurationNs age_ns = SystemClock().utc_ns() - info.source_ns;
    const bool sound = age_ns >= 0 && age_ns < 60 * kNsPerSecond;
    sample.publish_ns =
        sample.log_ns - (sound ? static_cast<DurationNs>(static_cast<double>(age_ns) * clock.rate()) : 0);
    sample.bytes.assign(bytes.begin(), bytes.end());
    sample.key = key_of_sample;
    {
      const std::lock_guard lock(mutex);
      const std::pair<const char*, WriterGuid> key(topic, info.writer_guid);
      const auto found = origins.find(key);
      if (found != origins.end()) {
        sample.origin = found->second;
      } else if (origins.size() < kMostOrigins) {
        sample.origin = queue.add(
            {topic, type, participant.writer_name(info.writer_guid), hexadecimal(info.writer_guid), latched});
        origins.emplace(key, sample.origin);
      } else {
        return std::nullopt;
      }
    }
    const TimeNs now_ns = sample.log_ns;
    queue.put(std::move(sample));
    return now_ns;
  }

  /// Alarms are published again and again: an event is what changes.
  void note(const Alarm& alarm, TimeNs now_ns) {
    const std::lock_guard lock(mutex);
    const auto known = alarms.find(alarm.alarm);
    const bool was_active = known != alarms.end() && known->second;
    if (was_active == alarm.active && (known != alarms.end() || !alarm.active)) return;
    if (known == alarms.end() && alarms.size() >= kMostNamed) return;
    alarms[alarm.alarm] = alarm.active;
    queue.put(Event{now_ns, "alarm",
                    alarm.alarm.str() + (alarm.active ? " began: " : " is over: ") + alarm.text,
                    alarm.active});
  }

  void enclose(const ServiceStatus& status, TimeNs now_ns) {
    bool is_new = false;
    {
      const std::lock_guard lock(mutex);
      const auto known = services.find(status.header.sensor);
      if (known == services.end() && services.size() >= kMostNamed) return;
      const Process now{status.host, status.pid, status.started_ns, status.utc_offset_ns};
      is_new = known == services.end() || !known->second.is(now);
      const bool was_set =
          !is_new && std::abs(known->second.utc_offset_ns - now.utc_offset_ns) > kClockWasSet_ns;
      if (!is_new && !was_set) return;
      services[status.header.sensor] = now;
    }
    queue.put(process_of(status, now_ns));
    if (!is_new || status.host != host) return;
    const auto line = command_line_of(status.pid);
    if (!line) return;
    for (Enclosure& one : enclosures_of(status.header.sensor.str(), *line, now_ns, catalogue))
      queue.put(std::move(one));
  }

  bus::Participant& participant;
  Queue& queue;
  const Clock& clock;
  const std::string host;
  const std::string catalogue;
  std::vector<std::string> refused;
  std::atomic<bool> ending = false;

  std::mutex mutex;
  std::map<std::pair<const char*, WriterGuid>, std::uint32_t> origins;
  std::map<Name, bool> alarms;
  std::map<Name, Process> services;

  struct Foreign {
    bus::ForeignTopic name;
    std::unique_ptr<bus::ForeignReader> reader;  ///< none where it cannot be listened to
  };
  std::map<std::pair<std::string, std::string>, Foreign> foreign;  ///< by topic and type
  std::vector<std::unique_ptr<bus::RawReader>> readers;  // these end first: they use everything above
};

Tap::Tap(bus::Participant& participant, Queue& queue, const Clock& clock,
         const std::vector<std::string>& topics, std::string host, std::string catalogue)
    : impl_(
          std::make_unique<Impl>(participant, queue, clock, topics, std::move(host), std::move(catalogue))) {}
Tap::~Tap() = default;
std::vector<std::string> Tap::look_around(const std::vector<std::string>& patterns) {
  return impl_->look_around(patterns);
}
const std::vector<std::string>& Tap::refused() const {
  return impl_->refused;
}

}  // namespace fathom::blackbox
