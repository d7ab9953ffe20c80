#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "base/time.hpp"

namespace fathom::host {

/// Notices that nothing takes what arrives from the vehicle network any more: in a socket of this process the
/// same datagram is the next one to be read for 10 s, with many behind it. Then a thread of Fast DDS holds
/// what the others wait for, for ever (2.9.1: a reader that leaves while samples are sent to it once more),
/// and the process is there, gives life signs and hears nobody. A receiver that is only too slow takes that
/// datagram at some time.
class Deafness {
 public:
  /// Of the sockets that Fast DDS opens for this domain (RTPS 9.6.2.3).
  explicit Deafness(std::uint32_t domain);

  /// Looks at the sockets, once a second however often it is called. True: this process hears nothing.
  [[nodiscard]] bool look(TimeNs monotonic_ns);

 private:
  struct Waiting {
    std::size_t first = 0;  ///< a hash of the datagram that is read next
    TimeNs since_ns = 0;    ///< it has been that one since
    bool seen = false;      ///< in this look
  };
  std::uint32_t first_port_;
  TimeNs looked_ns_ = 0;
  std::map<std::uint64_t, Waiting> sockets_;  ///< by inode
};

}  // namespace fathom::host
