#pragma once

// A vehicle that says where it is, the service that makes sentences of it, and readers of sentences.

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/clock.hpp"
#include "bus/writer.hpp"
#include "samples/nav_state.hpp"
#include "support/free_port.hpp"
#include "support/navigating.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"

namespace fathom::test {

inline constexpr std::uint32_t kDomain = 223;
inline constexpr double kSpeed_rad_s = 3e-7;  // 1.9 m/s to the north

/// Goes north at a known speed, and says so a hundred times a second.
class Vehicle {
 public:
  Vehicle() : participant_(presence(kDomain, "fusion")), states_(participant_) {
    thread_ = std::thread([this] {
      auto next = std::chrono::steady_clock::now();
      while (!stop_) {
        if (!quiet_) states_.write(state());
        next += std::chrono::milliseconds(10);
        std::this_thread::sleep_until(next);
      }
    });
  }
  ~Vehicle() {
    stop_ = true;
    thread_.join();
  }
  void be_quiet(bool quiet) { quiet_ = quiet; }
  void rest_on(NavMode mode) { mode_ = mode; }
  [[nodiscard]] static double latitude_rad(TimeNs stamp_ns) {
    constexpr TimeNs kEpoch_ns = 1'700'000'000 * kNsPerSecond;
    return -0.5 + kSpeed_rad_s * std::fmod(to_seconds(stamp_ns - kEpoch_ns), 100'000.0);
  }
  static constexpr double kLongitude_rad = 2.0;

 private:
  NavState state() {
    const TimeNs now_ns = clock_.utc_ns();
    NavState out = navigating(now_ns, ++sequence_);
    out.mode = mode_;
    out.latitude_rad = latitude_rad(now_ns);
    out.longitude_rad = kLongitude_rad;
    out.depth_m = 5.0;
    out.altitude_above_bottom_m = 12.0;
    out.velocity_N_m_s = {1.9, 0.0, 0.0};
    return out;
  }

  SystemClock clock_;
  bus::Participant participant_;
  bus::Writer<NavState> states_;
  std::uint64_t sequence_ = 0;
  std::atomic<bool> stop_ = false;
  std::atomic<bool> quiet_ = false;
  std::atomic<NavMode> mode_ = NavMode::gps_aided;
  std::thread thread_;
};

/// A descriptor, read as lines.
class Lines {
 public:
  explicit Lines(int descriptor) : descriptor_(descriptor) {}
  ~Lines() { close(descriptor_); }
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  /// A connection to a port of this host; waits until somebody listens there.
  [[nodiscard]] static int connected(int port) {
    const sockaddr_in address = loopback(port);
    int descriptor = -1;
    (void)wait_until([&] {
      descriptor = socket(AF_INET, SOCK_STREAM, 0);
      if (connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return true;
      close(descriptor);
      descriptor = -1;
      return false;
    });
    return descriptor;
  }
  [[nodiscard]] static int bound(int port) {
    const int descriptor = socket(AF_INET, SOCK_DGRAM, 0);
    const sockaddr_in address = loopback(port);
    EXPECT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return descriptor;
  }

  /// The next line for which `wanted` is true; empty when there is none within the time.
  template <class Wanted>
  std::string next(Wanted&& wanted, double seconds = 10.0) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    for (;;) {
      for (std::size_t cut = text_.find('\n'); cut != std::string::npos; cut = text_.find('\n')) {
        const std::string line = text_.substr(0, cut + 1);
        text_.erase(0, cut + 1);
        all_ += line;
        if (wanted(line)) return line;
      }
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
      pollfd one{descriptor_, POLLIN, 0};
      if (left.count() <= 0 || poll(&one, 1, static_cast<int>(left.count())) <= 0) return "";
      std::array<char, 4096> piece{};
      const ssize_t size = read(descriptor_, piece.data(), piece.size());
      if (size <= 0) return "";
      text_.append(piece.data(), static_cast<std::size_t>(size));
    }
  }
  std::string next_with(const std::string& part, double seconds = 10.0) {
    return next([&](const std::string& line) { return line.find(part) != std::string::npos; }, seconds);
  }
  /// Everything that went by.
  [[nodiscard]] const std::string& all() const { return all_; }

 private:
  int descriptor_;
  std::string text_;
  std::string all_;
};

inline constexpr const char* kEverything =
    R"([{"sentence":"GGA","rate_hz":5},{"sentence":"RMC","rate_hz":5},{"sentence":"VTG"},{"sentence":"GST"},)"
    R"({"sentence":"HDT","rate_hz":10},{"sentence":"ZDA"},{"sentence":"DPT"},{"sentence":"VBW"},{"sentence":"ROT"},)"
    R"({"sentence":"PFTHM"}])";

inline std::vector<std::string> arguments(const std::string& outputs) {
  return {"--config", source_dir() + "/deploy/config/nmea_out.json",
          "--set",    "bus.domain=" + std::to_string(kDomain),
          "--set",    "clock.anchor_file=",
          "--set",    "outputs=" + outputs};
}

inline std::string tcp_output(int port) {
  return R"({"type":"tcp_server","address":"127.0.0.1","port":)" + std::to_string(port) + R"(,"sentences":)" +
         kEverything + "}";
}

inline bool is_installed(const std::string& program) {
  return std::filesystem::exists(program);
}

}  // namespace fathom::test
