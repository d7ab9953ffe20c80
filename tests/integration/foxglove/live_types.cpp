// Says samples of every topic's type on a vehicle network as soon as somebody listens to all of them, and
// writes what it said to standard output: live_types DOMAIN. A line for each sample: topic, and the values of
// all fields in the order of their text.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "bus/topics.hpp"
#include "bus/writer.hpp"
#include "samples/kinds.hpp"
#include "support/leaves.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"
#include "unit/bus/sample_fields.hpp"

namespace fathom {
namespace {

constexpr unsigned kSeeds = 8;

struct Speaker {
  bus::Participant& participant;
  std::size_t topic = 0;
  bool heard = true;

  /// Of the next topic.
  template <class Sample>
  void say() {
    const bus::TopicInfo& info = bus::all_topics()[topic++];
    if (std::string_view(info.topic) == "fathom/v1/engine_state") return;  // not on offer
    bus::Writer<Sample> writer(participant);
    if (!test::wait_until([&] { return writer.matched_readers() > 0; }, 15.0)) {
      std::fprintf(stderr, "%s: nobody listens\n", info.topic);
      heard = false;
    }
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      Sample sample;
      test::Filler(seed, test::Lists::full).fill(sample);
      writer.write(sample);
      std::printf("%s%s\n", info.topic, test::Leaves::of(sample).c_str());
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
};

int run(std::uint32_t domain) {
  bus::Participant participant(test::presence(domain, "fusion"));
  Speaker speaker{participant};
  for_each_kind([&](auto kind) { speaker.say<typename decltype(kind)::Sample>(); });
  speaker.say<NavState>();
  speaker.say<NavDetail>();
  speaker.say<Verdict>();
  speaker.say<AlignmentStatus>();
  speaker.say<Forecast>();
  speaker.say<Alarm>();
  speaker.say<MonitorStatus>();
  speaker.say<ServiceStatus>();
  speaker.say<Command>();
  speaker.say<ReplicaStatus>();
  speaker.say<EngineStatePart>();
  speaker.say<Route>();
  speaker.say<Truth>();
  speaker.say<IntakeRecord>();
  return speaker.heard ? 0 : 1;
}

}  // namespace
}  // namespace fathom

int main(int argc, char** argv) {
  return argc == 2 ? fathom::run(static_cast<std::uint32_t>(std::strtoul(argv[1], nullptr, 10))) : 2;
}
