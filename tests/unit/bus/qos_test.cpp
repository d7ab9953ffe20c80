// The quality of service that readers and writers really get, against the table of the contract.

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "bus/detail/qos/effective_qos.hpp"
#include "bus/reader.hpp"
#include "bus/topics.hpp"
#include "bus/writer.hpp"
#include "sample_fields.hpp"
#include "support/presence.hpp"

namespace fathom {
namespace {

using bus::detail::EffectiveQos;
using bus::detail::kForever;

bus::ParticipantOptions options() {
  return test::presence(101, "qos_test");
}

struct Pair {
  EffectiveQos writer;
  EffectiveQos reader;
  EffectiveQos deep;
};

template <class T>
void make(bus::Participant& participant, const char* topic, std::map<std::string, Pair>& pairs,
          const bus::WriterOptions& writer_options = {}) {
  const auto ignore = [](const T&, const bus::SampleInfo&) {};
  Pair pair;
  {
    const bus::Writer<T> writer(participant, writer_options);
    const bus::Reader<T> reader(participant, ignore);
    pair.writer = bus::detail::effective_writer_qos(participant, topic);
    pair.reader = bus::detail::effective_reader_qos(participant, topic);
  }
  bus::ReaderOptions deep;
  deep.profile_suffix = "deep";
  const bus::Reader<T> reader(participant, ignore, deep);
  pair.deep = bus::detail::effective_reader_qos(participant, topic);
  pairs[topic] = pair;
}

class QosTable : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    bus::Participant participant(options());
    pairs_ = new std::map<std::string, Pair>;
    make<ImuSample>(participant, "fathom/v1/imu", *pairs_);
    make<DvlSample>(participant, "fathom/v1/dvl", *pairs_);
    make<GpsSample>(participant, "fathom/v1/gps", *pairs_);
    make<DepthSample>(participant, "fathom/v1/depth", *pairs_);
    make<AltimeterSample>(participant, "fathom/v1/altimeter", *pairs_);
    make<RangeSample>(participant, "fathom/v1/range", *pairs_);
    make<FixSample>(participant, "fathom/v1/fix", *pairs_);
    make<HeadingSample>(participant, "fathom/v1/heading", *pairs_);
    make<UsblSample>(participant, "fathom/v1/usbl", *pairs_);
    make<AirspeedSample>(participant, "fathom/v1/airspeed", *pairs_);
    make<PropulsionSample>(participant, "fathom/v1/propulsion", *pairs_);
    make<FinsSample>(participant, "fathom/v1/fins", *pairs_);
    make<NavState>(participant, "fathom/v1/nav_state", *pairs_, {.deadline_ns = {}, .ownership_strength = 7});
    make<NavDetail>(participant, "fathom/v1/nav_detail", *pairs_);
    make<Verdict>(participant, "fathom/v1/verdict", *pairs_);
    make<AlignmentStatus>(participant, "fathom/v1/alignment", *pairs_);
    make<Forecast>(participant, "fathom/v1/forecast", *pairs_);
    make<Alarm>(participant, "fathom/v1/alarm", *pairs_);
    make<MonitorStatus>(participant, "fathom/v1/monitor_status", *pairs_);
    make<ServiceStatus>(participant, "fathom/v1/service_status", *pairs_);
    make<Command>(participant, "fathom/v1/command", *pairs_);
    make<ReplicaStatus>(participant, "fathom/v1/replica_status", *pairs_);
    make<EngineStatePart>(participant, "fathom/v1/engine_state", *pairs_);
    make<Route>(participant, "fathom/v1/route", *pairs_);
    make<Truth>(participant, "fathom/v1/truth", *pairs_);
    make<IntakeRecord>(participant, "fathom/v1/intake", *pairs_);
  }
  static void TearDownTestSuite() { delete std::exchange(pairs_, nullptr); }

  static std::map<std::string, Pair>* pairs_;
};
std::map<std::string, Pair>* QosTable::pairs_ = nullptr;

TEST_F(QosTable, ExistsForEveryTopic) {
  ASSERT_EQ(pairs_->size(), bus::all_topics().size());
  for (const bus::TopicInfo& info : bus::all_topics())
    EXPECT_TRUE(pairs_->contains(info.topic)) << info.topic;
}

TEST_F(QosTable, EveryTopic) {
  for (const auto& [topic, pair] : *pairs_) {
    SCOPED_TRACE(topic);
    EXPECT_TRUE(pair.writer.synchronous);
    EXPECT_EQ(pair.writer.heartbeat_ns, 50 * kNsPerMillisecond);
    for (const EffectiveQos* qos : {&pair.writer, &pair.reader, &pair.deep}) {
      EXPECT_EQ(qos->matching.reliability, 1);
      EXPECT_EQ(qos->matching.liveliness, 0);
      EXPECT_EQ(qos->matching.lease_ns, kForever);
      EXPECT_FALSE(qos->data_sharing);
      EXPECT_GT(qos->max_instances, 10);
      EXPECT_GT(qos->max_samples_per_instance, 0);
      EXPECT_GE(qos->max_samples, qos->max_instances * qos->max_samples_per_instance);
      if (!qos->keep_all) {
        EXPECT_GE(qos->max_samples_per_instance, qos->depth);
      }
    }
    // A reader of the same configuration always meets the writer.
    EXPECT_LE(pair.writer.matching.deadline_ns, pair.reader.matching.deadline_ns);
    EXPECT_GE(pair.deep.depth, pair.reader.depth);
    // What comes after a lost sample waits in the reader until that one is sent again.
    EXPECT_GE(pair.reader.max_samples_per_instance, pair.writer.depth);
  }
}

TEST_F(QosTable, Samples) {
  // Depths: 5 s at the highest rate, in Hz, of the kind of instrument.
  const std::map<std::string, int> rates{
      {"imu", 400},   {"dvl", 50},       {"gps", 50},         {"depth", 50}, {"heading", 100},
      {"usbl", 10},   {"airspeed", 100}, {"propulsion", 100}, {"fins", 100}, {"altimeter", 100},
      {"range", 100}, {"fix", 100},      {"verdict", 400},    {"truth", 100}};
  for (const auto& [name, rate_hz] : rates) {
    SCOPED_TRACE(name);
    const Pair& pair = pairs_->at("fathom/v1/" + name);
    for (const EffectiveQos* qos : {&pair.writer, &pair.reader}) {
      EXPECT_EQ(qos->matching.durability, 0);
      EXPECT_EQ(qos->matching.ownership, 0);
      EXPECT_EQ(qos->matching.deadline_ns, kForever);
      EXPECT_FALSE(qos->keep_all);
      EXPECT_GE(qos->depth, 5 * rate_hz);
    }
  }
}

TEST_F(QosTable, NavState) {
  const Pair& pair = pairs_->at("fathom/v1/nav_state");
  for (const EffectiveQos* qos : {&pair.writer, &pair.reader, &pair.deep}) {
    EXPECT_EQ(qos->matching.durability, 0);
    EXPECT_EQ(qos->matching.ownership, 1);
    EXPECT_EQ(qos->matching.deadline_ns, 30 * kNsPerMillisecond);
  }
  EXPECT_EQ(pair.reader.depth, 1);
  EXPECT_GE(pair.deep.depth, 2000);
  EXPECT_GE(pair.writer.depth, 2000);
  EXPECT_EQ(pair.writer.ownership_strength, 7U);
}

TEST_F(QosTable, Status) {
  for (const std::string name : {"nav_detail", "alignment", "forecast", "alarm", "monitor_status",
                                 "service_status", "replica_status", "route"}) {
    SCOPED_TRACE(name);
    const Pair& pair = pairs_->at("fathom/v1/" + name);
    for (const EffectiveQos* qos : {&pair.writer, &pair.reader}) {
      EXPECT_EQ(qos->matching.durability, 1);
      EXPECT_EQ(qos->depth, 1);
      EXPECT_EQ(qos->matching.deadline_ns, name == "alarm" ? kForever : 3 * kNsPerSecond);
    }
  }
}

TEST_F(QosTable, EngineState) {
  const Pair& pair = pairs_->at("fathom/v1/engine_state");
  for (const EffectiveQos* qos : {&pair.writer, &pair.reader}) {
    EXPECT_EQ(qos->matching.durability, 0);
    EXPECT_EQ(qos->matching.deadline_ns, kForever);
    // A whole state waits for a reader that has lost a part of it.
    EXPECT_GE(qos->depth, 128);
  }
}

// A recorder that finds fusion late still hears from which entry on: 20 records a second, for 20 s at least.
TEST_F(QosTable, Intake) {
  const Pair& pair = pairs_->at("fathom/v1/intake");
  for (const EffectiveQos* qos : {&pair.writer, &pair.reader, &pair.deep}) {
    EXPECT_EQ(qos->matching.durability, 1);
    EXPECT_EQ(qos->matching.deadline_ns, kForever);
    EXPECT_GE(qos->depth, 400);
  }
}

TEST_F(QosTable, Command) {
  const Pair& pair = pairs_->at("fathom/v1/command");
  for (const EffectiveQos* qos : {&pair.writer, &pair.reader}) {
    EXPECT_EQ(qos->matching.durability, 0);
    EXPECT_TRUE(qos->keep_all);
    EXPECT_EQ(qos->lifespan_ns, 5 * kNsPerSecond);
  }
}

TEST(Options, DeadlineOverridesTheProfile) {
  bus::Participant participant(options());
  bus::WriterOptions writer_options;
  writer_options.deadline_ns = 250 * kNsPerMillisecond;
  const bus::Writer<ImuSample> writer(participant, writer_options);
  bus::ReaderOptions reader_options;
  reader_options.deadline_ns = 1500 * kNsPerMillisecond;
  const bus::Reader<ImuSample> reader(
      participant, [](const ImuSample&, const bus::SampleInfo&) {}, reader_options);
  EXPECT_EQ(bus::detail::effective_writer_qos(participant, "fathom/v1/imu").matching.deadline_ns,
            250 * kNsPerMillisecond);
  EXPECT_EQ(bus::detail::effective_reader_qos(participant, "fathom/v1/imu").matching.deadline_ns,
            1500 * kNsPerMillisecond);
}

/// The message of the BusError that `action` throws.
template <class Action>
std::string error_of(Action action) {
  try {
    action();
  } catch (const bus::BusError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no BusError";
  return {};
}

TEST(BadOptions, AreNamed) {
  const auto message = [](auto change) {
    bus::ParticipantOptions bad = options();
    change(bad);
    return error_of([&] { const bus::Participant participant(bad); });
  };
  EXPECT_NE(message([](auto& o) { o.name = ""; }).find("participant name ''"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.domain = 233; }).find("domain 233: expected 0 to 232"),
            std::string::npos);
  EXPECT_NE(message([](auto& o) { o.interfaces = {}; }).find("no interfaces"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.interfaces = {"203.0.113.7"}; }).find("interface '203.0.113.7'"),
            std::string::npos);
  EXPECT_NE(message([](auto& o) { o.peers = {"not an address"}; }).find("peer 'not an address'"),
            std::string::npos);
  EXPECT_NE(message([](auto& o) { o.profiles_dir = "/nonexistent"; }).find("/nonexistent"),
            std::string::npos);

  bus::Participant participant(options());
  bus::WriterOptions negative;
  negative.ownership_strength = -1;
  EXPECT_NE(error_of([&] { const bus::Writer<NavState> writer(participant, negative); }).find("strength -1"),
            std::string::npos);
  bus::WriterOptions zero;
  zero.deadline_ns = 0;
  EXPECT_NE(error_of([&] {
              const bus::Writer<ImuSample> writer(participant, zero);
            }).find("topic fathom/v1/imu: deadline 0 ns"),
            std::string::npos);
  bus::ReaderOptions suffix;
  suffix.profile_suffix = "shallow";
  EXPECT_NE(error_of([&] {
              const bus::Reader<ImuSample> reader(
                  participant, [](const auto&, const auto&) {}, suffix);
            }).find("fathom/v1/imu.shallow"),
            std::string::npos);
}

TEST(BadProfiles, AreNamed) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "fathom_bad_profiles";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "participant.xml") << "<dds><profiles><nonsense/></profiles></dds>";
  bus::ParticipantOptions bad = options();
  bad.profiles_dir = folder.string();
  EXPECT_NE(error_of([&] { const bus::Participant participant(bad); }).find("participant.xml"),
            std::string::npos);
  ASSERT_EQ(::mkfifo((folder / "a.xml").c_str(), 0600), 0);  // nobody ever writes into it
  EXPECT_NE(error_of([&] {
              const bus::Participant participant(bad);
            }).find("a.xml: is a pipe, expected a regular file"),
            std::string::npos);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace fathom
