// A cable with faults: passes Ethernet frames between two interfaces of this network namespace and loses,
// delays, doubles and reorders them on the way, the same in both directions. Ends with SIGTERM. Usage:
// soak_bad_cable A B --loss SHARE --delay SECONDS --jitter SECONDS --duplicate SHARE [--seed N]

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <queue>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace {

using Clock = std::chrono::steady_clock;

std::atomic<bool> over{false};

// struct virtio_net_hdr, whose header C++ does not compile.
constexpr std::size_t kOffloadHeader = 10;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

/// One end: everything that comes in, with the offload header, so that checksums left to the hardware stay
/// so.
class End {
 public:
  explicit End(const std::string& interface)
      : socket_(::socket(AF_PACKET, SOCK_RAW | SOCK_NONBLOCK, htons(ETH_P_ALL))) {
    if (socket_ < 0) fail("raw socket");
    const int yes = 1;
    if (setsockopt(socket_, SOL_PACKET, PACKET_VNET_HDR, &yes, sizeof yes) != 0) fail("PACKET_VNET_HDR");
    const int room = 8 << 20;
    setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
    sockaddr_ll address{};
    address.sll_family = AF_PACKET;
    address.sll_protocol = htons(ETH_P_ALL);
    address.sll_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
    if (address.sll_ifindex == 0) fail("interface " + interface);
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      fail("bind to " + interface);
    packet_mreq all{};
    all.mr_ifindex = address.sll_ifindex;
    all.mr_type = PACKET_MR_PROMISC;
    if (setsockopt(socket_, SOL_PACKET, PACKET_ADD_MEMBERSHIP, &all, sizeof all) != 0)
      fail("promiscuous " + interface);
  }
  ~End() { close(socket_); }
  End(const End&) = delete;
  End& operator=(const End&) = delete;

  [[nodiscard]] int socket() const { return socket_; }
  /// The next frame that came in; false when there is none.
  bool take(std::vector<std::uint8_t>& frame) {
    for (;;) {
      frame.resize(kOffloadHeader + 70'000);
      sockaddr_ll from{};
      socklen_t size = sizeof from;
      const ssize_t count =
          recvfrom(socket_, frame.data(), frame.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
      if (count < 0) return false;
      if (from.sll_pkttype == PACKET_OUTGOING) continue;
      frame.resize(static_cast<std::size_t>(count));
      return true;
    }
  }
  void give(const std::vector<std::uint8_t>& frame) { (void)!send(socket_, frame.data(), frame.size(), 0); }

 private:
  int socket_;
};

struct InFlight {
  Clock::time_point due;
  int to = 0;
  std::vector<std::uint8_t> frame;
  friend bool operator>(const InFlight& a, const InFlight& b) { return a.due > b.due; }
};

struct Faults {
  double loss = 0.0;
  double delay_s = 0.0;
  double jitter_s = 0.0;
  double duplicate = 0.0;
};

void pass_on(const std::string& a, const std::string& b, const Faults& faults, std::uint64_t seed) {
  End left(a);
  End right(b);
  std::array<End*, 2> ends{&left, &right};
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::priority_queue<InFlight, std::vector<InFlight>, std::greater<>> in_flight;
  std::array<std::uint64_t, 3> counts{};  // passed, lost, doubled
  std::vector<std::uint8_t> frame;
  while (!over) {
    int wait_ms = 100;
    if (!in_flight.empty()) {
      const auto left_ms =
          std::chrono::duration<double, std::milli>(in_flight.top().due - Clock::now()).count();
      wait_ms = std::clamp(static_cast<int>(left_ms), 0, 100);
    }
    std::array<pollfd, 2> polled{{{left.socket(), POLLIN, 0}, {right.socket(), POLLIN, 0}}};
    (void)poll(polled.data(), polled.size(), wait_ms);
    for (int from = 0; from < 2; ++from) {
      while (ends[static_cast<std::size_t>(from)]->take(frame)) {
        if (share(random) < faults.loss) {
          ++counts[1];
          continue;
        }
        const int copies = share(random) < faults.duplicate ? 2 : 1;
        counts[2] += static_cast<std::uint64_t>(copies - 1);
        for (int copy = 0; copy < copies; ++copy) {
          const std::chrono::duration<double> late(faults.delay_s + faults.jitter_s * share(random));
          in_flight.push({Clock::now() + std::chrono::duration_cast<Clock::duration>(late), 1 - from, frame});
        }
      }
    }
    while (!in_flight.empty() && in_flight.top().due <= Clock::now()) {
      ends[static_cast<std::size_t>(in_flight.top().to)]->give(in_flight.top().frame);
      in_flight.pop();
      ++counts[0];
    }
  }
  std::printf("passed %llu frames, lost %llu, doubled %llu\n", static_cast<unsigned long long>(counts[0]),
              static_cast<unsigned long long>(counts[1]), static_cast<unsigned long long>(counts[2]));
}

}  // namespace

int main(int argc, char** argv) {
  std::string a;
  std::string b;
  Faults faults;
  std::uint64_t seed = 1;
  CLI::App app{"A cable with faults between two interfaces"};
  app.add_option("a", a)->required();
  app.add_option("b", b)->required();
  app.add_option("--loss", faults.loss)->check(CLI::Range(0.0, 1.0));
  app.add_option("--delay", faults.delay_s)->check(CLI::Range(0.0, 10.0));
  app.add_option("--jitter", faults.jitter_s)->check(CLI::Range(0.0, 10.0));
  app.add_option("--duplicate", faults.duplicate)->check(CLI::Range(0.0, 1.0));
  app.add_option("--seed", seed);
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGTERM, [](int) { over = true; });
  std::signal(SIGINT, [](int) { over = true; });
  try {
    pass_on(a, b, faults, seed);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "soak_bad_cable: %s\n", error.what());
    return 4;
  }
  return 0;
}
