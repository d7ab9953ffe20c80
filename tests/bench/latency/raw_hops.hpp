#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <sys/types.h>

namespace fathom::test {

/// Two hops of bytes over Fast DDS itself, without anything of fathom's bus: from one process to a relay in
/// another one, and back as another topic. UDP on the loopback interface, reliable, synchronous. Every reader
/// is a process of its own. Of the readers of a topic the one that counts is neither the first nor the last
/// that is sent to, if there are more.
class RawHops {
 public:
  struct Way {
    std::size_t bytes;  ///< at least 8
    int readers = 1;    ///< the one that counts among them
  };

  /// Starts the processes. Precondition: this process has no threads yet. `name` sets its topics apart.
  RawHops(std::string name, Way out, Way back);
  ~RawHops();
  RawHops(const RawHops&) = delete;
  RawHops& operator=(const RawHops&) = delete;

  /// Every reader has its writer.
  [[nodiscard]] bool matched() const;
  /// From now on so many a second; 0: none.
  void send(double rate_hz);
  /// From sending to return of each since the last call, us.
  [[nodiscard]] std::vector<double> take_round_us();

 private:
  struct Shared;
  void spawn(int milliseconds, void (RawHops::*body)());
  [[noreturn]] void relay();
  [[noreturn]] void sender();
  [[noreturn]] void listen_out();
  [[noreturn]] void listen_back();

  std::string name_;
  Way out_;
  Way back_;
  Shared* shared_;  ///< with the processes
  std::size_t taken_ = 0;
  std::vector<pid_t> processes_;
};

}  // namespace fathom::test
