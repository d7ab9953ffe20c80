#include "mavlink_gateway/mavlink_gateway_service.hpp"

#include <array>
#include <cmath>
#include <mutex>
#include <utility>
#include <vector>

#include "base/disk/regular_file.hpp"
#include "base/forward_only.hpp"
#include "bus/reader.hpp"
#include "config/json/error.hpp"
#include "mavlink/frame.hpp"
#include "mavlink/messages.hpp"
#include "mavlink_gateway/messages.hpp"
#include "runtime/byte_link.hpp"
#include "runtime/refusal_log.hpp"
#include "samples/nav_state.hpp"

namespace fathom::mavlink_gateway {
namespace {

constexpr DurationNs kFresh_ns = kNsPerSecond;
constexpr DurationNs kThere_ns = 5 * kNsPerSecond;
constexpr std::size_t kMostKeyFile = 64 * 1024;
constexpr std::uint8_t kTypeGcs = 6;

std::optional<geo::Geodetic> origin_in(const config::MavlinkGatewayConfig& config) {
  if (!config.origin) return std::nullopt;
  return geo::Geodetic{config.origin->latitude_rad, config.origin->longitude_rad, config.origin->altitude_m};
}

/// Every so often by the stamps of states, on whole multiples.
class Pace {
 public:
  explicit Pace(double rate_hz) : period_ns_(rate_hz > 0.0 ? from_seconds(1.0 / rate_hz) : 0) {}
  [[nodiscard]] bool due(TimeNs stamp_ns) {
    if (period_ns_ == 0) return false;
    const std::int64_t period = stamp_ns / period_ns_;
    return std::exchange(last_, period) != period;
  }

 private:
  DurationNs period_ns_;
  std::int64_t last_ = INT64_MIN;
};

}  // namespace

std::optional<mavlink::Key> key_in(const config::MavlinkSigning& signing, const std::string& file) {
  if (signing.key_file.empty()) return std::nullopt;
  const auto text = read_regular_file(signing.key_file, kMostKeyFile);
  const std::string value = "\"" + signing.key_file + "\"";
  if (!text)
    throw config::ConfigError(file, "signing.key_file", value,
                              "a file that can be read; it " + text.error().message);
  const auto key = mavlink::key_of(text.value());
  if (!key)
    throw config::ConfigError(file, "signing.key_file", value,
                              "64 hexadecimal digits; it " + key.error().message);
  return key.value();
}

struct MavlinkGatewayService::Impl {
  Impl(host::ServiceHost& the_host, const config::MavlinkGatewayConfig& the_config)
      : host(the_host),
        config(the_config),
        sender{static_cast<std::uint8_t>(config.system_id), static_cast<std::uint8_t>(config.component_id)},
        key(key_in(config.signing, "")),
        odometry(config.messages.odometry_hz),
        vision(config.messages.vision_position_hz),
        gps_input(config.messages.gps_input_hz),
        link(
            config.link, [this](std::span<const std::uint8_t> bytes) { hear(bytes); },
            [log = &the_host.log()](bool is_trouble, const std::string& text) {
              log->write(is_trouble ? runtime::LogLevel::warning : runtime::LogLevel::info, text);
            }),
        reader(host.participant(), [this](const NavState& state, const bus::SampleInfo&) { take(state); }) {
    host.on_tick(kNsPerSecond, [this] { tick(); });
    host.on_status([this](ServiceStatus& status) { fill(status); });
    link.start();  // last: what comes by it is answered at once, from everything that is here
  }
  ~Impl() {
    host.on_tick(kNsPerSecond, [] {});
    host.on_status([](ServiceStatus&) {});
  }

  /// Under the lock.
  template <class M>
  void say(const M& message) {
    auto frame = mavlink::frame_of(message, sender, sequence++, signer ? mavlink::kFlagSigned : 0);
    if (signer) signer->sign(frame, host.clock().utc_ns());
    link.send(std::move(frame));
    ++said;
  }

  void take(const NavState& state) {
    const std::lock_guard lock(mutex);
    if (!forward.takes(state.header.stamp_ns)) return;
    newest = state;
    heard_ns = host.clock().monotonic_ns();
    const TimeNs stamp_ns = state.header.stamp_ns;
    const bool wants_odometry = odometry.due(stamp_ns);
    const bool wants_vision = vision.due(stamp_ns);
    const bool wants_gps = gps_input.due(stamp_ns);
    if (!wants_odometry && !wants_vision && !wants_gps) return;
    const auto pose = pose_of(state, config);
    is_useful = pose.has_value();
    if (!pose) return;
    const bool is_valid = pose->radius_95_m <= config.valid_95_m;
    if (!origin && is_valid) origin = pose->place;
    if (origin && wants_odometry) say(odometry_of(*pose, *origin, config));
    // It has no field that could say that it is not valid.
    if (origin && wants_vision && is_valid) say(vision_of(*pose, *origin));
    if (wants_gps) say(gps_input_of(*pose, config));
  }

  void tick() {
    const std::lock_guard lock(mutex);
    say(heartbeat_of(newest, is_fresh()));
  }
  /// Under the lock.
  [[nodiscard]] bool is_fresh() const {
    return newest && host.clock().monotonic_ns() - heard_ns <= kFresh_ns;
  }

  /// On the link's thread.
  void hear(std::span<const std::uint8_t> bytes) {
    unread.insert(unread.end(), bytes.begin(), bytes.end());
    std::size_t at = 0;
    while (at < unread.size()) {
      const mavlink::Look look = mavlink::look_at(std::span(unread).subspan(at));
      if (look.kind == mavlink::Look::Kind::need) break;
      if (look.kind == mavlink::Look::Kind::frame) {
        read(look.frame);
        at += look.length;
      } else {
        if (look.kind == mavlink::Look::Kind::checksum) count_refused("has a wrong checksum");
        at += look.kind == mavlink::Look::Kind::skip ? look.length : 1;
      }
    }
    unread.erase(unread.begin(), unread.begin() + static_cast<std::ptrdiff_t>(at));
  }

  void read(const mavlink::Frame& frame) {
    const TimeNs now_ns = host.clock().utc_ns();
    if (verifier) {
      const mavlink::Trust trust = verifier->judge(frame, now_ns);
      if (trust != mavlink::Trust::trusted) return count_refused("is " + std::string(to_string(trust)));
    }
    const std::lock_guard lock(mutex);
    if (frame.system != sender.system) return note_other(frame);
    ++heard_frames;
    if (frame.id == mavlink::Heartbeat::kId) {
      const auto message = mavlink::message_of<mavlink::Heartbeat>(frame.payload);
      if (message.type != kTypeGcs && frame.component != sender.component)
        autopilot_ns = host.clock().monotonic_ns();
    } else if (frame.id == mavlink::Timesync::kId) {
      const auto question = mavlink::message_of<mavlink::Timesync>(frame.payload);
      if (question.tc1 != 0) return;  // an answer
      mavlink::Timesync answer = question;
      answer.tc1 = now_ns;
      answer.target_system = frame.system;
      answer.target_component = frame.component;
      say(answer);
    }
  }
  /// Under the lock. Neighbours may share the link; who looks for the missing autopilot wants to know them.
  void note_other(const mavlink::Frame& frame) {
    if (frame.id != mavlink::Heartbeat::kId) return;
    if (mavlink::message_of<mavlink::Heartbeat>(frame.payload).type == kTypeGcs) return;
    other_system = frame.system;
    other_ns = host.clock().monotonic_ns();
  }
  void count_refused(const std::string& why) {
    const std::string line = "a frame of the other side " + why + ": it is not heard";
    if (const auto now = refusals.add(why, line, host.clock().monotonic_ns())) host.log().warning(*now);
    const std::lock_guard lock(mutex);
    ++refused;
  }
  /// Under the lock.
  [[nodiscard]] std::string autopilot_text() const {
    const TimeNs now_ns = host.clock().monotonic_ns();
    if (autopilot_ns && now_ns - *autopilot_ns < kThere_ns) return "the autopilot is there";
    std::string out = "no heartbeat of the autopilot is heard";
    if (other_system && now_ns - other_ns < kThere_ns)
      out += ", but one of system " + std::to_string(*other_system) + "; expected of system " +
             std::to_string(sender.system) + " (system_id)";
    return out;
  }

  void fill(ServiceStatus& status) {
    const runtime::LinkStatus shown = link.status();
    const std::lock_guard lock(mutex);
    status.counters.push_back({"messages", said});
    status.counters.push_back({"bytes_dropped", shown.bytes_dropped});
    status.counters.push_back({"frames_heard", heard_frames});
    if (refused > 0) status.counters.push_back({"frames_refused", refused});
    if (!shown.trouble.empty()) {
      status.state = ServiceState::degraded;
      status.text = shown.name + ": " + shown.trouble;
    } else if (!is_fresh()) {
      status.state = ServiceState::degraded;
      status.text = "no navigation state is heard";
    } else if (!is_useful) {
      status.text = "navigation gives no position and heading yet: the autopilot is told nothing";
    } else {
      status.text = autopilot_text();
    }
  }

  host::ServiceHost& host;
  const config::MavlinkGatewayConfig config;
  const mavlink::Sender sender;
  const std::optional<mavlink::Key> key;
  std::vector<std::uint8_t> unread;  // of the link's thread
  std::optional<mavlink::Verifier> verifier =
      key ? std::optional(mavlink::Verifier(*key)) : std::nullopt;  // likewise
  std::mutex mutex;                                                 // of what follows up to the link
  std::optional<mavlink::Signer> signer =
      key ? std::optional(mavlink::Signer(*key, static_cast<std::uint8_t>(config.signing.link)))
          : std::nullopt;
  Pace odometry;
  Pace vision;
  Pace gps_input;
  std::optional<geo::Geodetic> origin = origin_in(config);
  ForwardOnly forward;
  std::optional<NavState> newest;
  TimeNs heard_ns = 0;
  bool is_useful = false;
  std::optional<TimeNs> autopilot_ns;
  std::optional<std::uint8_t> other_system;
  TimeNs other_ns = 0;
  std::uint8_t sequence = 0;
  std::uint64_t said = 0;
  std::uint64_t heard_frames = 0;
  std::uint64_t refused = 0;
  runtime::RefusalLog refusals;
  runtime::ByteLink link;
  bus::Reader<NavState> reader;  // ends first: it uses everything above
};

MavlinkGatewayService::MavlinkGatewayService(host::ServiceHost& host,
                                             const config::MavlinkGatewayConfig& config)
    : impl_(std::make_unique<Impl>(host, config)) {}
MavlinkGatewayService::~MavlinkGatewayService() = default;

}  // namespace fathom::mavlink_gateway
