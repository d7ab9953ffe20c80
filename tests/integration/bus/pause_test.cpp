// Processes that stand still for longer than their lease: the others give them up, and all of them have to
// meet again.

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "bus/writer.hpp"
#include "samples/status/health.hpp"
#include "support.hpp"

namespace fathom::test {
namespace {

using std::chrono::steady_clock;
using testing::IsEmpty;

constexpr std::uint32_t kDomainOfPauses = 123;
constexpr std::array<const char*, 7> kNames{"fusion", "imu", "gps", "heading", "dvl", "second", "third"};
constexpr std::size_t kPaused = 3;  // the first of them
constexpr milliseconds kFresh(1500);
constexpr milliseconds kLongerThanTheLease(8000);
constexpr milliseconds kToRecover(20'000);

/// What one hears of the others.
class Ears {
 public:
  explicit Ears(bus::Participant& participant)
      : reader_(participant, [this](const ServiceStatus& status, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex_);
          heard_[std::string(status.header.sensor.view())] = {steady_clock::now(), status.text};
        }) {}

  /// Those of whom nothing came within the last kFresh, and those who say that they miss somebody.
  [[nodiscard]] std::vector<std::string> missing(const std::string& me) const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> out;
    for (const std::string name : kNames) {
      const auto found = heard_.find(name);
      const bool fresh = found != heard_.end() && steady_clock::now() - found->second.at < kFresh;
      if (!fresh && name != me) out.push_back(name);
    }
    return out;
  }
  [[nodiscard]] std::vector<std::string> complaints() const {
    std::vector<std::string> out = missing("");
    const std::lock_guard lock(mutex_);
    for (const auto& [name, said] : heard_) {
      if (!said.text.empty()) out.push_back(name + " misses " + said.text);
    }
    return out;
  }

 private:
  struct Said {
    steady_clock::time_point at;
    std::string text;
  };
  mutable std::mutex mutex_;
  std::map<std::string, Said> heard_;
  bus::Reader<ServiceStatus> reader_;
};

/// Body of a child: says five times a second whom it misses.
TEST(ChildProcess, DISABLED_SaysWhomItMisses) {
  const char* const name = std::getenv("TEST_NAME");
  bus::Participant participant(options(kDomainOfPauses, name));
  bus::Writer<ServiceStatus> writer(participant);
  const Ears ears(participant);
  ServiceStatus status;
  status.header.vehicle = "auv";
  status.header.sensor = name;
  until_stopped(
      milliseconds(200),
      [&] {
        ++status.header.sequence;
        status.text.clear();
        for (const std::string& one : ears.missing(name)) status.text += one + " ";
        writer.write(status);
      },
      milliseconds(600'000));
}

TEST(Pauses, OfAProcessLongerThanItsLeaseLeaveNobodyDeaf) {
  bus::Participant participant(options(kDomainOfPauses, "monitor"));
  const Ears ears(participant);
  std::vector<std::unique_ptr<Child>> children;
  for (const std::string name : kNames) {
    children.push_back(std::make_unique<Child>("ChildProcess.DISABLED_SaysWhomItMisses",
                                               std::vector<std::string>{"TEST_NAME=" + name}));
  }
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(eventually([&] { return ears.complaints().empty(); }, kToRecover));
    for (std::size_t i = 0; i < kPaused; ++i) children[i]->pause();
    let_pass(kLongerThanTheLease);
    EXPECT_EQ(ears.missing("").size(), kPaused);
    for (std::size_t i = 0; i < kPaused; ++i) {
      children[i]->go_on();
      let_pass(milliseconds(300));  // not all of them at once, as if for one cause
    }
    let_pass(kFresh);
    (void)eventually([&] { return ears.complaints().empty(); }, kToRecover);
    ASSERT_THAT(ears.complaints(), IsEmpty()) << "round " << round;
  }
}

}  // namespace
}  // namespace fathom::test
