#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace fathom::test {

/// Two hops of bytes over Fast DDS itself, without anything of fathom's bus: from a writer in this process to
/// a relay in another one, and back as another topic. UDP on the loopback interface, reliable, synchronous.
class RawHops {
 public:
  /// `first_bytes` go out, `second_bytes` come back. Precondition: both at least 8.
  RawHops(std::size_t first_bytes, std::size_t second_bytes);
  ~RawHops();
  RawHops(const RawHops&) = delete;
  RawHops& operator=(const RawHops&) = delete;

  /// Both ways are open.
  [[nodiscard]] bool matched() const;
  void send();
  /// From send() to the return of each so far, us.
  [[nodiscard]] std::vector<double> take_round_us();

  /// The other process: sends on what comes until it is killed. Does not return.
  [[noreturn]] static void relay(std::size_t first_bytes, std::size_t second_bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::test
