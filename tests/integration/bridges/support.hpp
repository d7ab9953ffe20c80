#pragma once

// What the bridge tests share: a bridge as a real process, devices on real links, readers on the real bus.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "base/time.hpp"
#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "samples/status/health.hpp"
#include "support/free_port.hpp"

namespace fathom::test {

using Bytes = std::span<const std::uint8_t>;

inline Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

[[nodiscard]] TimeNs utc_now();

/// Asks every 10 ms until it is true; false after `limit_s`.
[[nodiscard]] bool eventually(const std::function<bool()>& condition, double limit_s = 15.0);

/// A folder of its own that goes with the test.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

/// A running executable of this build. Killed with the object if it still runs.
class Process {
 public:
  Process(const std::string& executable, const std::vector<std::string>& arguments, const std::string& log);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  void signal(int number) const;
  /// Exit code; -1 when it did not end within `limit_s` or was killed by a signal.
  [[nodiscard]] int wait(double limit_s = 10.0);
  /// What it wrote so far.
  [[nodiscard]] std::string output() const;

 private:
  pid_t pid_ = -1;
  std::string log_;
};

/// The bridge `kind` with its shipped configuration on `domain`, changed by `sets`.
[[nodiscard]] std::vector<std::string> bridge_arguments(const std::string& kind, int domain,
                                                        const std::vector<std::string>& sets);

/// A serial instrument: a pseudo-terminal, its other end at `path`.
class SerialDevice {
 public:
  explicit SerialDevice(std::string path);
  ~SerialDevice();
  SerialDevice(const SerialDevice&) = delete;
  SerialDevice& operator=(const SerialDevice&) = delete;
  void send(Bytes bytes) const;
  /// What was said to it since it was asked last.
  [[nodiscard]] std::string heard() const;

 private:
  std::string path_;
  int master_ = -1;
};

/// A network instrument that others connect to. Port 0: any free one.
class TcpDevice {
 public:
  explicit TcpDevice(int port = 0);
  ~TcpDevice();
  TcpDevice(const TcpDevice&) = delete;
  TcpDevice& operator=(const TcpDevice&) = delete;
  [[nodiscard]] int port() const { return port_; }
  /// Sends to whoever is connected; takes a waiting connection first.
  void send(Bytes bytes);
  /// What was said to it since it was asked last.
  [[nodiscard]] std::string heard();

 private:
  void take_waiting();

  int listener_ = -1;
  int peer_ = -1;
  int port_ = 0;
};

/// A connection to a TCP server on this host, -1 when there is none. The caller closes it.
[[nodiscard]] int connect_to(int port);
void send_udp(int port, Bytes bytes);

[[nodiscard]] bus::ParticipantOptions test_participant(int domain);

/// Keeps everything that arrives on the topic of T.
template <class T>
class Collector {
 public:
  explicit Collector(bus::Participant& participant)
      : reader_(participant, [this](const T& sample, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex_);
          samples_.push_back(sample);
        }) {}

  [[nodiscard]] std::vector<T> all() const {
    const std::lock_guard lock(mutex_);
    return samples_;
  }
  [[nodiscard]] std::size_t count() const {
    const std::lock_guard lock(mutex_);
    return samples_.size();
  }
  [[nodiscard]] bool matched() const { return reader_.matched_writers() > 0; }

 private:
  mutable std::mutex mutex_;
  std::vector<T> samples_;
  bus::Reader<T> reader_;
};

/// The newest life sign has this state, and its text holds `text`.
[[nodiscard]] bool is_in_state(const Collector<ServiceStatus>& status, ServiceState state,
                               const std::string& text = "");
/// Value of a counter in the newest life sign; 0 when it is not there.
[[nodiscard]] std::uint64_t counter(const Collector<ServiceStatus>& status, std::string_view name);

}  // namespace fathom::test
