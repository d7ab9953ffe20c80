// What init hears on pseudo-terminals: rates and framings as far as a terminal without a line can show them.
// It keeps the rate that its reader set, which the device here looks at; bits of a character it does not
// keep.
#include "cli/init/listening.hpp"

#include <array>
#include <atomic>
#include <bit>
#include <cerrno>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include "support/codec/seed_streams.hpp"
#include "support/process.hpp"

namespace fathom::cli {
namespace {

using test::ByteVector;

/// An instrument that says its stream ten times a second. Readers of another rate hear what is no frame.
class Instrument {
 public:
  Instrument(ByteVector stream, speed_t speed) : stream_(std::move(stream)), speed_(speed) {
    std::array<char, 64> name{};
    if (openpty(&device_, &line_, name.data(), nullptr, nullptr) != 0) throw std::runtime_error("openpty");
    path_ = name.data();
    // Where nobody reads any more, a line is full in the end, and a writer that waits cannot be ended.
    fcntl(device_, F_SETFL, O_NONBLOCK);
    termios mode{};
    tcgetattr(line_, &mode);
    cfmakeraw(&mode);
    tcsetattr(line_, TCSANOW, &mode);
    thread_ = std::thread([this] { run(); });
  }
  ~Instrument() {
    stop_ = true;
    thread_.join();
    close(device_);
    close(line_);
  }
  Instrument(const Instrument&) = delete;
  Instrument& operator=(const Instrument&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  void run() {
    std::uint64_t round = 0;
    while (!stop_) {
      termios mode{};
      tcgetattr(device_, &mode);
      const bool heard = speed_ == B0 || cfgetispeed(&mode) == speed_;
      const ByteVector& out = heard ? stream_ : (noise_ = test::noise(stream_.size(), ++round));
      const ssize_t written = write(device_, out.data(), std::min<std::size_t>(out.size(), 1000));
      if (written < 0 && errno != EAGAIN) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  ByteVector stream_;
  ByteVector noise_;
  speed_t speed_;
  int device_ = -1;
  int line_ = -1;
  std::string path_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// As seven bits and an even or odd one come out of a line of eight.
ByteVector with_parity(ByteVector bytes, int odd) {
  for (std::uint8_t& byte : bytes)
    if (std::popcount(static_cast<unsigned>(byte & 0x7f)) % 2 != odd) byte |= 0x80;
  return bytes;
}

ByteVector short_stream(const char* protocol) {
  ByteVector out = test::seed_stream(protocol);
  if (out.size() > 900) out.resize(900);
  return out;
}

TEST(InitListening, FindsRateAndFramingOnPseudoTerminals) {
  const Instrument imu(short_stream("vectornav"), B38400);
  const Instrument gps(short_stream("ubx"), B9600);
  const Instrument even(with_parity(short_stream("nmea0183"), 0), B0);
  const Instrument odd(with_parity(short_stream("nmea0183"), 1), B9600);
  const SystemClock clock;
  const std::vector<Heard> heard = listen(
      {serial_port(imu.path()), serial_port(gps.path()), serial_port(even.path()), serial_port(odd.path())},
      60.0, clock);
  ASSERT_EQ(heard.size(), 4U);
  struct Expected {
    const char* protocol;
    int baud;
    runtime::Framing framing;
  };
  const std::array<Expected, 4> expected{{{"vectornav", 38'400, runtime::Framing::n8_1},
                                          {"ubx", 9'600, runtime::Framing::n8_1},
                                          {"nmea0183", 115'200, runtime::Framing::e7_1},
                                          {"nmea0183", 9'600, runtime::Framing::o7_1}}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    SCOPED_TRACE(expected[i].protocol);
    ASSERT_TRUE(heard[i].recognition) << heard[i].bytes << " bytes";
    EXPECT_EQ(heard[i].recognition->protocol, expected[i].protocol);
    EXPECT_EQ(heard[i].port.baud, expected[i].baud);
    EXPECT_EQ(heard[i].port.framing, expected[i].framing);
  }
  // A bridge that opens the port as it was found understands it.
  Recognizer bridge;
  std::mutex mutex;
  {
    runtime::ByteSource source(
        heard[2].port, clock,
        [&](std::span<const std::uint8_t> bytes, const runtime::Arrival&) {
          const std::lock_guard lock(mutex);
          bridge.feed(bytes, clock.monotonic_ns());
        },
        [](const runtime::SourceEvent&) {});
    source.start();
    EXPECT_TRUE(test::wait_until([&] {
      const std::lock_guard lock(mutex);
      return bridge.best().has_value();
    }));
  }
  ASSERT_TRUE(bridge.best());
  EXPECT_EQ(bridge.best()->protocol, "nmea0183");
  const auto proposals = propose(heard);
  // What several bridges read of a line has the same port.
  const auto ports_at = [&](const std::string& path) {
    std::vector<nlohmann::ordered_json> out;
    for (const Proposal& one : proposals) {
      if (one.instrument.contains("port") && one.instrument["port"]["path"] == path)
        out.push_back(one.instrument["port"]);
    }
    return out;
  };
  EXPECT_EQ(ports_at(imu.path()).size(), 2U) << "the unit and the receiver inside";
  const auto nmea = ports_at(even.path());
  ASSERT_GT(nmea.size(), 1U);
  for (const auto& port : nmea) {
    EXPECT_EQ(port["framing"], "7E1");
    EXPECT_EQ(port["shared"], true);
  }
  ASSERT_FALSE(ports_at(gps.path()).empty());
  EXPECT_FALSE(ports_at(gps.path())[0].contains("framing"));
}

}  // namespace
}  // namespace fathom::cli
