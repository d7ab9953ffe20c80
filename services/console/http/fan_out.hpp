#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace fathom::console {

/// One text for all clients: written once, shared, never copied.
using Event = std::shared_ptr<const std::string>;

/// Hands events to any number of clients. Each has a queue of its own with a limit: one that does not keep up
/// loses its oldest events, and nobody else notices. Thread-safe.
class FanOut {
 public:
  class Client {
   public:
    /// The next event; null when none came within `patience` or the fan-out was closed.
    [[nodiscard]] Event wait(std::chrono::milliseconds patience);
    [[nodiscard]] bool closed() const;

   private:
    friend class FanOut;
    Client(std::size_t depth, std::string viewer) : depth_(depth), viewer_(std::move(viewer)) {}
    /// True when the oldest event had to go.
    bool put(const Event& event);
    void close();

    std::size_t depth_;
    std::string viewer_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Event> queue_;
    bool closed_ = false;
  };

  struct Limits {
    std::size_t depth = 100;  ///< events that wait for one client at most
    std::size_t most_clients = 48;
    std::size_t most_per_viewer = 12;  ///< so that one cannot take what is there for all
  };
  enum class Refused : std::uint8_t { no, all_taken, viewer_has_enough };
  struct Join {
    std::shared_ptr<Client> client;  ///< leaves by being destroyed; null when refused
    Refused refused = Refused::no;
  };

  explicit FanOut(Limits limits) : limits_(limits) {}

  /// `viewer`: who is behind it, by which clients are counted. After close() all are taken.
  [[nodiscard]] Join join(const std::string& viewer);
  void publish(const Event& event);
  /// Wakes everyone for good.
  void close();

  [[nodiscard]] std::size_t clients() const;
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  Limits limits_;
  mutable std::mutex mutex_;
  std::vector<std::weak_ptr<Client>> clients_;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace fathom::console
