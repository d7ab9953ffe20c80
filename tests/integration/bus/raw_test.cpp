// Samples as bytes, beside readers and writers of plain samples.

#include "bus/raw.hpp"

#include "bus/cdr.hpp"
#include "bus/topics.hpp"
#include "bus/writer.hpp"
#include "samples/imu.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "support.hpp"
#include "unit/bus/sample_fields.hpp"

namespace fathom::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

class RawInbox {
 public:
  bus::RawReader::Handler handler() {
    return [this](std::span<const std::uint8_t> bytes, const bus::SampleInfo& info) {
      const std::lock_guard lock(mutex_);
      samples_.emplace_back(Bytes(bytes.begin(), bytes.end()), info);
    };
  }
  [[nodiscard]] std::vector<std::pair<Bytes, bus::SampleInfo>> all() const {
    const std::lock_guard lock(mutex_);
    return samples_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::pair<Bytes, bus::SampleInfo>> samples_;
};

template <class T>
class Raw : public testing::Test {};
// A topic of each ownership and durability, with lists.
using SomeTypes = testing::Types<ImuSample, NavState, MonitorStatus, ServiceStatus>;
TYPED_TEST_SUITE(Raw, SomeTypes);

template <class T>
std::string topic_of() {
  for (const bus::TopicInfo& info : bus::all_topics()) {
    if constexpr (std::is_same_v<T, ImuSample>) {
      if (info.type == std::string("fathom::v1::ImuSample")) return info.topic;
    } else if constexpr (std::is_same_v<T, NavState>) {
      if (info.type == std::string("fathom::v1::NavState")) return info.topic;
    } else if constexpr (std::is_same_v<T, MonitorStatus>) {
      if (info.type == std::string("fathom::v1::MonitorStatus")) return info.topic;
    } else {
      if (info.type == std::string("fathom::v1::ServiceStatus")) return info.topic;
    }
  }
  return {};
}

TYPED_TEST(Raw, ReaderGetsTheBytesBesideATypedOne) {
  bus::Participant a(options(102, "writer"));
  bus::Participant b(options(102, "recorder"));
  RawInbox raw;
  Inbox<TypeParam> typed;
  const bus::RawReader raw_reader(b, topic_of<TypeParam>(), raw.handler());
  const bus::Reader<TypeParam> reader(b, typed.handler());
  bus::Writer<TypeParam> writer(a);
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 2 && raw_reader.matched_writers() == 1; }));
  std::vector<std::string> sent;
  const auto text_of = [](const Bytes& bytes) {  // padding may hold anything
    const auto sample = bus::from_cdr<TypeParam>(bytes);
    return sample ? Dump::of(*sample) : "none";
  };
  for (unsigned i = 0; i < 50; ++i) {
    TypeParam sample;
    Filler(5, i % 2 == 0 ? Lists::full : Lists::one).fill(sample);
    sample.header.sequence = i;
    sent.push_back(Dump::of(sample));
    ASSERT_TRUE(writer.write(sample));
    let_pass(milliseconds(2));
  }
  ASSERT_TRUE(
      eventually([&] { return !raw.all().empty() && text_of(raw.all().back().first) == sent.back(); }));
  if constexpr (std::is_same_v<TypeParam, ImuSample>) {
    ASSERT_EQ(raw.all().size(), sent.size());
  }
  for (const auto& [bytes, info] : raw.all()) {
    EXPECT_NE(std::find(sent.begin(), sent.end(), text_of(bytes)), sent.end());
    EXPECT_EQ(b.writer_name(info.writer_guid), "writer");
    EXPECT_EQ(info.writer_guid, writer.guid());
    EXPECT_GE(info.reception_ns, info.source_ns);
    EXPECT_GT(info.source_ns, 1'600'000'000 * kNsPerSecond);
  }
  EXPECT_GT(typed.size(), 0U);
}

TYPED_TEST(Raw, WriterSendsTheBytesAndRefusesOthers) {
  bus::Participant a(options(102, "replay"));
  bus::Participant b(options(102, "fusion"));
  Inbox<TypeParam> typed;
  const bus::Reader<TypeParam> reader(b, typed.handler());
  bus::RawWriter writer(a, topic_of<TypeParam>());
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));
  TypeParam sample;
  Filler(9, Lists::full).fill(sample);
  ASSERT_TRUE(writer.write(bus::to_cdr(sample)));
  Bytes cut = bus::to_cdr(sample);
  cut.resize(cut.size() / 2);
  EXPECT_FALSE(writer.write(cut));
  EXPECT_FALSE(writer.write({}));
  ASSERT_TRUE(eventually([&] { return typed.size() == 1; }));
  EXPECT_EQ(Dump::of(typed.all()[0].first), Dump::of(sample));
  EXPECT_EQ(b.counters().invalid_sample, 0U);
}

TEST(RawTopics, NamesATopicThatIsNotThere) {
  bus::Participant a(options(102, "recorder"));
  EXPECT_THROW(bus::RawReader(a, "fathom/v1/nothing", {}), bus::BusError);
  EXPECT_THROW(bus::RawWriter(a, "fathom/v1/nothing"), bus::BusError);
}

}  // namespace
}  // namespace fathom::test
