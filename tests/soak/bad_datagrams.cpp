// What a stranger or a broken box may send: RTPS datagrams that once were right, with something changed in
// each.
//   soak_bad_datagrams capture INTERFACE FILE --seconds S     keeps the RTPS datagrams seen on an interface
//   soak_bad_datagrams send FILE --to ADDRESS ... --count N   sends them, mutated, to the ports of a domain
// The same seed sends the same datagrams.

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <netinet/ip.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace {

using Clock = std::chrono::steady_clock;
using Datagram = std::vector<std::uint8_t>;

constexpr std::size_t kMostSeeds = 4000;
constexpr std::size_t kRtpsHeader = 20;
constexpr int kPortsPerDomain = 250;
constexpr int kFirstPort = 7400;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

void capture(const std::string& interface, const std::string& file, double seconds) {
  const int socket = ::socket(AF_PACKET, SOCK_DGRAM, htons(ETH_P_IP));
  if (socket < 0) fail("raw socket");
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_IP);
  address.sll_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (address.sll_ifindex == 0 ||
      bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    fail("interface " + interface);
  }
  std::set<Datagram> kept;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  Datagram packet(70'000);
  while (Clock::now() < end && kept.size() < kMostSeeds) {
    pollfd polled{socket, POLLIN, 0};
    if (poll(&polled, 1, 100) <= 0) continue;
    const ssize_t count = recv(socket, packet.data(), packet.size(), 0);
    if (count < static_cast<ssize_t>(sizeof(iphdr))) continue;
    const std::size_t head = (packet[0] & 0x0FU) * 4U + 8U;  // IP and UDP
    if (packet[9] != IPPROTO_UDP || static_cast<std::size_t>(count) < head + kRtpsHeader) continue;
    if (std::memcmp(&packet[head], "RTPS", 4) != 0) continue;
    kept.emplace(packet.begin() + static_cast<std::ptrdiff_t>(head), packet.begin() + count);
  }
  close(socket);
  std::ofstream out(file, std::ios::binary);
  for (const Datagram& one : kept) {
    const auto size = static_cast<std::uint32_t>(one.size());
    out.write(reinterpret_cast<const char*>(&size), sizeof size);
    out.write(reinterpret_cast<const char*>(one.data()), static_cast<std::streamsize>(one.size()));
  }
  if (!out.flush()) fail(file);
  std::printf("%zu different datagrams\n", kept.size());
}

std::vector<Datagram> read_seeds(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<Datagram> seeds;
  for (std::uint32_t size = 0; in.read(reinterpret_cast<char*>(&size), sizeof size);) {
    Datagram one(std::min<std::uint32_t>(size, 70'000));
    if (in.read(reinterpret_cast<char*>(one.data()), static_cast<std::streamsize>(one.size())))
      seeds.push_back(one);
  }
  if (seeds.empty()) throw std::runtime_error(file + ": no datagrams in it");
  // Bytes behind the sender's statistics: what ends a Fast DDS 2.9 that is not kept from it.
  Datagram known(seeds.front().begin(), seeds.front().begin() + kRtpsHeader);
  known.insert(known.end(), {0x80, 0x01, 0x38, 0x00});
  known.resize(84, 0xA5);
  seeds.push_back(known);
  return seeds;
}

void mutate(Datagram& one, const std::vector<Datagram>& seeds, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random() % std::max<std::size_t>(n, 1));
  };
  const int changes = 1 + static_cast<int>(below(4));
  for (int i = 0; i < changes && one.size() > kRtpsHeader; ++i) {
    const std::size_t at = kRtpsHeader + below(one.size() - kRtpsHeader);
    switch (below(8)) {
      case 0:
        one[at] ^= static_cast<std::uint8_t>(1U << below(8));
        break;
      case 1:
        one[at] = static_cast<std::uint8_t>(random());
        break;
      case 2:  // a length or a count
        for (std::size_t k = at; k < std::min(at + 4, one.size()); ++k) one[k] = below(2) == 0 ? 0xFF : 0x00;
        break;
      case 3:
        one.resize(at);
        break;
      case 4:
        for (std::size_t k = below(64); k > 0; --k) one.push_back(static_cast<std::uint8_t>(random()));
        break;
      case 5:  // the kind of the first submessage
        one[kRtpsHeader] = below(4) == 0 ? 0x80 : static_cast<std::uint8_t>(random());
        break;
      case 6: {  // the tail of another one
        const Datagram& other = seeds[below(seeds.size())];
        const std::size_t from = below(other.size());
        one.resize(at);
        one.insert(one.end(), other.begin() + static_cast<std::ptrdiff_t>(from), other.end());
        break;
      }
      default:  // another sender
        for (std::size_t k = 8; k < kRtpsHeader; ++k) one[k] = static_cast<std::uint8_t>(random());
        break;
    }
  }
  if (one.size() > 1400) one.resize(1400);
}

void send(const std::string& file, const std::vector<std::string>& to, std::uint64_t count, double rate_hz,
          int domain, std::uint64_t seed) {
  const std::vector<Datagram> seeds = read_seeds(file);
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  if (socket < 0) fail("socket");
  std::vector<sockaddr_in> targets;
  for (const std::string& address : to) {
    for (int port = 0; port < 60;
         ++port) {  // discovery by multicast, discovery and samples of 25 participants
      sockaddr_in target{};
      target.sin_family = AF_INET;
      target.sin_port = htons(static_cast<std::uint16_t>(kFirstPort + kPortsPerDomain * domain + port));
      if (inet_pton(AF_INET, address.c_str(), &target.sin_addr) != 1)
        throw std::runtime_error(address + ": no address");
      targets.push_back(target);
    }
  }
  std::mt19937_64 random(seed);
  constexpr std::size_t kBatch = 64;
  std::array<Datagram, kBatch> batch;
  std::array<iovec, kBatch> pieces{};
  std::array<mmsghdr, kBatch> messages{};
  std::uint64_t sent = 0;
  std::uint64_t refused = 0;
  int refused_in_a_row = 0;
  const auto began = Clock::now();
  while (sent < count) {
    for (std::size_t i = 0; i < kBatch; ++i) {
      batch[i] = seeds[random() % seeds.size()];
      mutate(batch[i], seeds, random);
      pieces[i] = {batch[i].data(), batch[i].size()};
      messages[i].msg_hdr = {};
      messages[i].msg_hdr.msg_name = &targets[random() % targets.size()];
      messages[i].msg_hdr.msg_namelen = sizeof(sockaddr_in);
      messages[i].msg_hdr.msg_iov = &pieces[i];
      messages[i].msg_hdr.msg_iovlen = 1;
    }
    const int done = sendmmsg(socket, messages.data(), kBatch, 0);
    if (done < 0) {
      ++refused;
      constexpr int kMostInARow = 10000;
      if (++refused_in_a_row == kMostInARow)
        throw std::runtime_error(std::string("cannot send: ") + std::strerror(errno));
    } else {
      refused_in_a_row = 0;
      sent += static_cast<std::uint64_t>(done);
    }
    if (rate_hz > 0.0) {
      const std::chrono::duration<double> due(static_cast<double>(sent) / rate_hz);
      const std::chrono::duration<double> left = due - (Clock::now() - began);
      if (left.count() > 0.001) usleep(static_cast<useconds_t>(1e6 * left.count()));
    }
  }
  close(socket);
  const std::chrono::duration<double> took = Clock::now() - began;
  std::printf("sent %llu datagrams in %.1f s, %llu calls refused\n", static_cast<unsigned long long>(sent),
              took.count(), static_cast<unsigned long long>(refused));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Datagrams of RTPS with something wrong in each"};
  app.require_subcommand(1);
  std::string interface;
  std::string file;
  double seconds = 5.0;
  auto* take = app.add_subcommand("capture", "keep the RTPS datagrams seen on an interface");
  take->add_option("interface", interface)->required();
  take->add_option("file", file)->required();
  take->add_option("--seconds", seconds);
  std::vector<std::string> to;
  std::uint64_t count = 10'000'000;
  double rate_hz = 0.0;
  int domain = 0;
  std::uint64_t seed = 1;
  auto* give = app.add_subcommand("send", "mutate them and send them");
  give->add_option("file", file)->required();
  give->add_option("--to", to)->required();
  give->add_option("--count", count);
  give->add_option("--rate", rate_hz, "a second; 0: as fast as it goes");
  give->add_option("--domain", domain)->check(CLI::Range(0, 230));
  give->add_option("--seed", seed);
  CLI11_PARSE(app, argc, argv);
  try {
    if (*take) {
      capture(interface, file, seconds);
    } else {
      send(file, to, count, rate_hz, domain, seed);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "soak_bad_datagrams: %s\n", error.what());
    return 4;
  }
  return 0;
}
