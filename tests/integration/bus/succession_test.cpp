// A writer is followed by another while the network is cut: nothing is lost, nothing comes twice, nothing
// comes out of order. FATHOM_SOAK=1: ten successions instead of three.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "samples/imu.hpp"
#include "samples/nav_state.hpp"
#include "support.hpp"
#include "support/cut_wire.hpp"

namespace fathom::test {
namespace {

using std::chrono::duration_cast;
using std::chrono::steady_clock;

bus::ParticipantOptions at(int number, const std::string& name) {
  bus::ParticipantOptions made = options(109, name);
  made.interfaces = {CutWire::address(number)};
  made.peers = {CutWire::address(3 - number)};
  return made;
}

/// Counts what arrives of one source, by its numbers.
template <class T>
struct Tally {
  std::atomic<std::uint64_t> newest = 0;
  std::atomic<std::uint64_t> missing = 0;
  std::atomic<std::uint64_t> not_in_order = 0;  ///< or once more

  auto handler() {
    return [this](const T& sample, const bus::SampleInfo&) {
      const std::uint64_t number = sample.header.sequence;
      const std::uint64_t expected = newest + 1;
      if (number < expected) {
        ++not_in_order;
      } else {
        missing += number - expected;
        newest = number;
      }
    };
  }
};

/// Writes at a rate, each time the next number, and knows the writers by which it did so.
template <class T>
class Source {
 public:
  Source(bus::Participant& participant, std::uint64_t successor_after, steady_clock::duration period)
      : writer_(participant, followed(successor_after)), period_(period) {}

  void begin() {
    thread_ = std::thread([this] {
      T sample;
      sample.header.vehicle = "auv";
      sample.header.sensor = "one";
      WriterGuid guid = writer_.guid();
      for (auto next = steady_clock::now(); !stop_; next += period_) {
        std::this_thread::sleep_until(next);
        ++sample.header.sequence;
        if (!writer_.write(sample)) ++failed;
        written = sample.header.sequence;
        if (const WriterGuid now = writer_.guid(); now != guid) {
          guid = now;
          ++successions;
        }
      }
    });
  }
  void end() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  [[nodiscard]] int matched() const { return writer_.matched_readers(); }
  ~Source() { end(); }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  std::atomic<std::uint64_t> written = 0;
  std::atomic<std::uint64_t> failed = 0;
  std::atomic<int> successions = 0;

 private:
  static bus::WriterOptions followed(std::uint64_t successor_after) {
    bus::WriterOptions options;
    options.successor_after = successor_after;
    return options;
  }

  bus::Writer<T> writer_;
  steady_clock::duration period_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

struct Round {
  double after_s;  ///< from the sample that calls for a successor to the cut; negative: at the change itself
  double cut_s;
};
constexpr double kAtTheChange = -1.0;

TEST(Succession, LosesNothingWhileTheNetworkIsCut) {
  const CutWire wire;
  if (!wire.trouble().empty()) GTEST_SKIP() << wire.trouble();
  constexpr std::uint64_t kImuEach = 4000;  // 10 s
  const auto a = wire.on(1, [] { return std::make_unique<bus::Participant>(at(1, "imu_bridge")); });
  const auto b = wire.on(2, [] { return std::make_unique<bus::Participant>(at(2, "fusion")); });
  const Events events(*b);
  Source<ImuSample> imu(*a, kImuEach, std::chrono::microseconds(2500));
  Source<NavState> state(*a, kImuEach / 4, std::chrono::milliseconds(10));
  Tally<ImuSample> imu_heard;
  Tally<NavState> state_heard;
  const bus::Reader<ImuSample> imu_reader(*b, imu_heard.handler());
  bus::ReaderOptions each_one;
  each_one.profile_suffix = "deep";
  const bus::Reader<NavState> state_reader(*b, state_heard.handler(), each_one);
  ASSERT_TRUE(eventually([&] {
    return imu.matched() == 1 && state.matched() == 1 && imu_reader.matched_writers() == 1 &&
           state_reader.matched_writers() == 1;
  }));
  imu.begin();
  state.begin();

  std::vector<Round> rounds{{0.0, 1.5}, {kAtTheChange, 4.0}, {2.4, 1.0}};
  if (std::getenv("FATHOM_SOAK") != nullptr) {
    rounds.insert(rounds.end(), {{0.0, 4.0},
                                 {0.5, 0.5},
                                 {0.8, 3.0},
                                 {kAtTheChange, 0.5},
                                 {kAtTheChange, 1.5},
                                 {2.2, 4.0},
                                 {2.6, 2.5}});
  }
  const int wanted = static_cast<int>(rounds.size());
  std::uint64_t calls_at = kImuEach;
  for (const Round& round : rounds) {
    const int before = imu.successions;
    ASSERT_TRUE(eventually([&] { return imu.written >= calls_at; }, std::chrono::seconds(60)));
    if (round.after_s == kAtTheChange) {
      EXPECT_TRUE(eventually([&] { return imu.successions > before; }, std::chrono::seconds(8)));
    } else {
      let_pass(duration_cast<milliseconds>(std::chrono::duration<double>(round.after_s)));
    }
    wire.cut();
    let_pass(duration_cast<milliseconds>(std::chrono::duration<double>(round.cut_s)));
    wire.mend();
    EXPECT_TRUE(eventually([&] { return imu_heard.newest + 400 > imu.written; }))
        << "after a cut of " << round.cut_s << " s";
    std::printf("cut %.1f s after %.1f s: %d successions, missing %d imu samples and %d states\n",
                round.cut_s, round.after_s, imu.successions.load(), static_cast<int>(imu_heard.missing),
                static_cast<int>(state_heard.missing));
    while (calls_at <= imu.written) calls_at += kImuEach;
  }
  EXPECT_TRUE(eventually([&] { return imu.successions >= wanted && state.successions >= wanted; },
                         std::chrono::seconds(20)));
  imu.end();
  state.end();
  EXPECT_TRUE(eventually([&] { return imu_heard.newest == imu.written; }));
  EXPECT_TRUE(eventually([&] { return state_heard.newest == state.written; }));
  EXPECT_EQ(imu.failed, 0U);
  EXPECT_EQ(state.failed, 0U);
  EXPECT_EQ(imu_heard.missing, 0U);
  EXPECT_EQ(imu_heard.not_in_order, 0U);
  EXPECT_EQ(state_heard.missing, 0U);
  EXPECT_EQ(state_heard.not_in_order, 0U);
  EXPECT_TRUE(events.of(bus::BusEventKind::writer_lost).empty());
  EXPECT_TRUE(events.of(bus::BusEventKind::sample_lost).empty());
}

}  // namespace
}  // namespace fathom::test
