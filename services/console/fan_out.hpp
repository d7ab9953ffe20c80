#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
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
    explicit Client(std::size_t depth) : depth_(depth) {}
    /// True when the oldest event had to go.
    bool put(const Event& event);
    void close();

    std::size_t depth_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Event> queue_;
    bool closed_ = false;
  };

  /// `depth`: events that wait for one client at most.
  FanOut(std::size_t depth, std::size_t most_clients) : depth_(depth), most_clients_(most_clients) {}

  /// Null when there are too many already, or after close(). A client leaves by being destroyed.
  [[nodiscard]] std::shared_ptr<Client> join();
  void publish(const Event& event);
  /// Wakes everyone for good.
  void close();

  [[nodiscard]] std::size_t clients() const;
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  std::size_t depth_;
  std::size_t most_clients_;
  mutable std::mutex mutex_;
  std::vector<std::weak_ptr<Client>> clients_;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace fathom::console
