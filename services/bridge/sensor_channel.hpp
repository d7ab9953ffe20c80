#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "base/clock.hpp"
#include "bridge/channel_health.hpp"
#include "bridge/sanity.hpp"
#include "codec/codec.hpp"
#include "config/bridge/bridge_config.hpp"
#include "runtime/byte_source.hpp"
#include "runtime/log.hpp"

namespace fathom::bridge {

inline constexpr std::size_t kSampleKinds = std::variant_size_v<AnySample>;
inline constexpr std::size_t kRejectReasons = 8;

/// Where a channel's samples go: the topics of the bridge.
class Outlet {
 public:
  virtual ~Outlet() = default;
  /// Whether samples of this alternative of AnySample are the bridge's business.
  [[nodiscard]] virtual bool takes(std::size_t kind) const = 0;
  /// False when the network did not take it. Called by one thread at a time.
  virtual bool publish(const AnySample& sample) = 0;
};

struct ChannelCounters {
  std::uint64_t bytes = 0;
  std::uint64_t frames = 0;  ///< good ones, with or without a sample
  std::uint64_t skipped_bytes = 0;
  std::array<std::uint64_t, kRejectReasons> rejected{};  ///< by codec::RejectReason
  std::array<std::uint64_t, kRefusals> refused{};        ///< by Refusal
  std::uint64_t samples = 0;                             ///< published
  std::uint64_t ignored = 0;  ///< of other kinds or other transponders than this bridge is for
  std::uint64_t write_failed = 0;
  std::uint64_t connects = 0;
  std::uint64_t source_errors = 0;
  std::uint64_t time_implausible = 0;  ///< device UTC that could not be
  std::uint64_t time_steps = 0;        ///< of the device's clock
  std::uint64_t time_backwards = 0;    ///< stamps before their predecessor
};

/// One instrument: byte source, codec, time, mounting, sanity, outlet. Runs on the source's own thread.
class SensorChannel {
 public:
  /// `clock`, `log` and `outlet` must outlive the channel.
  SensorChannel(config::SensorPlan plan, std::string_view vehicle, const Clock& clock, runtime::Log& log,
                Outlet& outlet);
  ~SensorChannel();
  SensorChannel(const SensorChannel&) = delete;
  SensorChannel& operator=(const SensorChannel&) = delete;

  void start();

  [[nodiscard]] const config::SensorConfig& sensor() const;
  [[nodiscard]] ChannelCounters counters() const;
  /// What is wrong, in words; nothing when all is well. Call about once a second, from one thread.
  [[nodiscard]] std::optional<std::string> judge();
  /// It has delivered; one that need not speak at once is ready as soon as it is connected.
  [[nodiscard]] bool has_started() const;
  [[nodiscard]] double rate_hz() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::bridge
