#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "logs/ros2/cdr.hpp"
#include "logs/ros2/reader.hpp"
#include "logs/ros2/schema.hpp"
#include "record/writer.hpp"

namespace fathom::logs::ros2 {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Schema schema(std::string_view type, std::string_view text, std::size_t kept = 8) {
  auto parsed = parse(type, text, kept);
  EXPECT_TRUE(parsed.ok()) << (parsed.ok() ? "" : parsed.error().message);
  return parsed.ok() ? parsed.value() : Schema{};
}
std::string refusal(std::string_view text) {
  const auto parsed = parse("pkg/msg/Root", text);
  return parsed.ok() ? "" : parsed.error().message;
}

TEST(Ros2Schema, TellsFieldsFromConstantsDefaultsAndComments) {
  const Schema s = schema("pkg/msg/Root",
                          "# words\r\n"
                          "\n"
                          "int32 MOST=5 # no field\n"
                          "string NAME = a # b = c\n"
                          "  float64   x   1.5   # with a default\n"
                          "string<=10 label \"a # b\"\n"
                          "uint8[3] triple\n"
                          "int16[<=2] some [1, 2]\n"
                          "Inner inner\n"
                          "other/Inner[] all\n"
                          "================================================================================\n"
                          "MSG: pkg/Inner\n"
                          "bool yes\n"
                          "===\n"
                          "MSG: other/msg/Inner\n"
                          "char c\n"
                          "string s\n",
                          2);
  EXPECT_EQ(s.type, "pkg/Root");
  EXPECT_THAT(s.columns, ElementsAre("x", "triple[0]", "triple[1]", "triple[2]", "some.length", "some[0]",
                                     "some[1]", "inner.yes", "all.length", "all[0].c", "all[1].c"));
  EXPECT_THAT(s.texts, ElementsAre("label", "all[0].s", "all[1].s"));
}

TEST(Ros2Schema, KnowsTimeAndHeaderByTheirShortNames) {
  const Schema s = schema(
      "pkg/Root", "Header header\nduration d\n===\nMSG: std_msgs/Header\ntime stamp\nstring frame_id\n");
  EXPECT_THAT(s.columns, ElementsAre("header.stamp.sec", "header.stamp.nanosec", "d.sec", "d.nanosec"));
}

TEST(Ros2Schema, NamesTheLineThatItCannotUse) {
  EXPECT_THAT(refusal("int32 a\nint33 b\n"), HasSubstr("line 2"));
  EXPECT_THAT(refusal("int32\n"), HasSubstr("expected a type and a name"));
  EXPECT_THAT(refusal("int32[0] a\n"), HasSubstr("no size"));
  EXPECT_THAT(refusal("int32[99999999999999999999] a\n"), HasSubstr("no size"));
  EXPECT_THAT(refusal("int32<=4 a\n"), HasSubstr("string<=N"));
  EXPECT_THAT(refusal("wstring a\n"), HasSubstr("wstring"));
  EXPECT_THAT(refusal("int32] a\n"), HasSubstr("without its ["));
  EXPECT_THAT(refusal("int32 a\n===\nIDL: pkg/Inner\n"), HasSubstr("expected MSG:"));
  EXPECT_THAT(refusal(" \n"), HasSubstr("empty"));
  EXPECT_THAT(refusal(std::string(kLongestText + 1, ' ')), HasSubstr("expected at most"));
}

TEST(Ros2Schema, BoundsWhatATextMayClaim) {
  EXPECT_THAT(refusal("pkg/Root again\n"), HasSubstr("within itself"));
  EXPECT_THAT(refusal("A a\n===\nMSG: pkg/A\nB b\n===\nMSG: pkg/B\nA a\n"), HasSubstr("within itself"));
  EXPECT_THAT(refusal("float64[1000000] a\n"), HasSubstr("numbers a message"));
  // Ten levels of ten each would be 10^10 fields, a hundred of a hundred each 10^20 numbers.
  std::string deep = "A0 a\n";
  std::string wide = "A0[100] a\n";
  for (int level = 0; level < 10; ++level) {
    const std::string head = "===\nMSG: pkg/A" + std::to_string(level) + "\n";
    const std::string next = level == 9 ? "int8" : "A" + std::to_string(level + 1);
    deep += head;
    for (int i = 0; i < 10; ++i) deep += next + " f" + std::to_string(i) + "\n";
    wide += head + next + "[100] f\n";
  }
  EXPECT_THAT(refusal(deep), HasSubstr("more than"));
  EXPECT_THAT(refusal(wide), HasSubstr("more than"));
}

std::vector<std::uint8_t> bytes(std::initializer_list<int> list) {
  std::vector<std::uint8_t> out;
  for (const int one : list) out.push_back(static_cast<std::uint8_t>(one));
  return out;
}

TEST(Ros2Cdr, AlignsEachNumberToItsSizeBehindTheHeader) {
  const Schema s = schema("pkg/Root", "uint8 a\nfloat64 b\nuint8 c\nint16 d\nstring e\nint64 f\n");
  Row row;
  EXPECT_EQ(decode(s, bytes({0,   1, 0, 0, 7,    0,    0,    0,    0,    0,    0,    0,   0, 0,
                             0,   0, 0, 0, 0xF0, 0x3F, 8,    0,    0xFE, 0xFF, 2,    0,   0, 0,
                             'x', 0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}),
                   row),
            "field f: offset 30: the message ends, expected 8 bytes more")
      << "f begins at a multiple of 8: two bytes behind the end of e";
  EXPECT_EQ(decode(s, bytes({0, 1, 0, 0,    7,    0, 0,    0,    0,    0,    0,    0,    0,    0,   0,
                             0, 0, 0, 0xF0, 0x3F, 8, 0,    0xFE, 0xFF, 2,    0,    0,    0,    'x', 0,
                             0, 0, 0, 0,    0,    0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}),
                   row),
            "");
  EXPECT_THAT(row.values, ElementsAre(7.0, 1.0, 8.0, -2.0, -1.0));
  EXPECT_THAT(row.texts, ElementsAre("x"));
  EXPECT_EQ(decode(s, bytes({0, 0, 0, 0, 7, 0, 0,    0,    0,    0,    0,    0,    0x3F, 0xF0, 0,
                             0, 0, 0, 0, 0, 8, 0,    0xFF, 0xFE, 0,    0,    0,    2,    'x',  0,
                             0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE}),
                   row),
            "");
  EXPECT_THAT(row.values, ElementsAre(7.0, 1.0, 8.0, -2.0, -2.0));
}

TEST(Ros2Cdr, PassesElementsThatHaveNoColumn) {
  const Schema s = schema("pkg/Root", "uint8[] a\nuint8[<=3] b\nuint8 last\n", 2);
  Row row;
  EXPECT_EQ(decode(s, bytes({0, 1, 0, 0, 3, 0, 0, 0, 1, 2, 3, 0, 1, 0, 0, 0, 9, 5}), row), "");
  ASSERT_EQ(row.values.size(), 7U);
  EXPECT_EQ(row.values[0], 3.0);
  EXPECT_EQ(row.values[2], 2.0);
  EXPECT_EQ(row.values[3], 1.0);
  EXPECT_EQ(row.values[4], 9.0);
  EXPECT_TRUE(std::isnan(row.values[5]));
  EXPECT_EQ(row.values[6], 5.0);
  EXPECT_THAT(decode(s, bytes({0, 1, 0, 0, 255, 255, 255, 255}), row),
              HasSubstr("field a: offset 8: a sequence of 4294967295"));
  EXPECT_THAT(decode(s, bytes({0, 1, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 1, 2, 3, 4, 5}), row),
              HasSubstr("field b"));
  EXPECT_THAT(decode(s, bytes({0, 3, 0, 0}), row), HasSubstr("encapsulation 0x0003"));
}

TEST(Ros2Cdr, RefusesStringsThatCannotBe) {
  const Schema s = schema("pkg/Root", "string<=2 a\n");
  Row row;
  EXPECT_EQ(decode(s, bytes({0, 1, 0, 0, 0, 0, 0, 0}), row), "");
  EXPECT_THAT(row.texts, ElementsAre(""));
  EXPECT_THAT(decode(s, bytes({0, 1, 0, 0, 2, 0, 0, 0, 'a', 'b'}), row), HasSubstr("zero at its end"));
  EXPECT_THAT(decode(s, bytes({0, 1, 0, 0, 4, 0, 0, 0, 'a', 'b', 'c', 0}), row), HasSubstr("at most 2"));
  EXPECT_THAT(decode(s, bytes({0, 1, 0, 0, 9, 0, 0, 0, 'a', 0}), row), HasSubstr("9 bytes, but 2"));
}

TEST(Ros2Cdr, StandsAnyBytes) {
  const Schema s =
      schema("pkg/Root",
             "string a\nInner[] b\nfloat32[5] c\nInner d\n===\nMSG: pkg/Inner\nint8 x\nstring[<=3] y\n", 2);
  std::mt19937_64 random(11);
  Row row;
  std::size_t good = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::vector<std::uint8_t> message(4 + random() % 80);
    for (auto& byte : message) byte = static_cast<std::uint8_t>(random() % 4 == 0 ? random() : 0);
    message[0] = 0;
    message[1] &= 1U;
    good += decode(s, message, row).empty() ? 1U : 0U;
    ASSERT_EQ(row.values.size(), s.columns.size());
  }
  EXPECT_GT(good, 0U);
}

// --- the reader ---------------------------------------------------------------------------------------

constexpr const char* kPressure =
    "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n===\nMSG: std_msgs/Header\n"
    "builtin_interfaces/Time stamp\nstring frame_id\n";

std::vector<std::uint8_t> pressure(std::uint32_t sec, char frame, double value) {
  auto out = bytes({0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, frame, 0, 0, 0});
  std::memcpy(out.data() + 4, &sec, sizeof sec);
  const std::array<double, 2> numbers{value, 0.0};
  const auto* raw = reinterpret_cast<const std::uint8_t*>(numbers.data());
  out.insert(out.end(), raw, raw + sizeof numbers);
  return out;
}

struct Bag {
  std::unique_ptr<record::Source> source() {
    EXPECT_EQ(writer.finish(), "");
    return std::make_unique<record::MemorySource>(file);
  }
  Bag() { EXPECT_EQ(writer.begin(), ""); }
  void add(std::uint16_t channel, TimeNs time, const std::vector<std::uint8_t>& message) {
    EXPECT_EQ(writer.write({channel, 0, time, time, message}), "");
  }
  record::Bytes file;
  record::Writer writer{std::make_unique<record::MemorySink>(file), {}};
  std::uint16_t schema = writer.add_schema("sensor_msgs/msg/FluidPressure", "ros2msg", kPressure);
};

TEST(Ros2Reader, MakesASeriesOfEachTopicTypeAndFrame) {
  Bag bag;
  const std::uint16_t air = bag.writer.add_channel(bag.schema, "/air", "cdr");
  const std::uint16_t json = bag.writer.add_channel(bag.schema, "/json", "json");
  bag.add(air, 5'000'001'000, pressure(5, 'a', 1.0));
  bag.add(json, 5'000'001'500, bytes({'{', '}'}));
  bag.add(air, 5'000'002'999, pressure(5, 'b', 2.0));
  bag.add(air, 5'000'009'000, pressure(5, 'a', 3.0));
  const Log log = read(bag.source(), "bag");
  ASSERT_EQ(log.series.size(), 2U);
  EXPECT_EQ(log.series[0].frame, "a");
  EXPECT_EQ(log.series[1].frame, "b");
  EXPECT_EQ(log.series[1].label(), "/air:1");
  EXPECT_THAT(log.series[0].t_us, ElementsAre(0, 8));
  EXPECT_THAT(log.series[1].t_us, ElementsAre(1));
  EXPECT_EQ(log.start_ns, 5'000'001'000);
  EXPECT_EQ(log.series[0].at(1, log.series[0].find("fluid_pressure")), 3.0);
  EXPECT_EQ(log.messages.at("/json"), 1U);
  EXPECT_EQ(log.losses.count, 0U);
}

TEST(Ros2Reader, TakesNoMoreMemoryThanItMay) {
  Bag bag;
  const std::uint16_t air = bag.writer.add_channel(bag.schema, "/air", "cdr");
  for (int i = 0; i < 10; ++i) bag.add(air, i + 1, pressure(5, 'a', 1.0));
  const auto source = bag.source();
  try {
    (void)read(std::make_unique<record::MemorySource>(bag.file), "bag", {.values = 39});
    FAIL() << "expected a refusal: 10 messages of 4 numbers";
  } catch (const LogError& error) {
    EXPECT_THAT(error.what(), HasSubstr("bag: /air: more than 39 numbers"));
  }
  EXPECT_EQ(read(std::make_unique<record::MemorySource>(bag.file), "bag", {.values = 40}).series.size(), 1U);
}

TEST(Ros2Reader, SaysThatARecordingOfFathomIsNoBag) {
  Bag bag;
  const std::uint16_t own = bag.writer.add_schema("fathom::v1::ImuSample", "omgidl", "x");
  bag.add(bag.writer.add_channel(own, "fathom/v1/imu", "cdr"), 1, bytes({0, 1, 0, 0}));
  const auto source = bag.source();
  try {
    (void)read(std::make_unique<record::MemorySource>(bag.file), "bag");
    FAIL() << "expected a refusal";
  } catch (const LogError& error) {
    EXPECT_THAT(error.what(), HasSubstr("fathom solve reads it"));
  }
}

}  // namespace
}  // namespace fathom::logs::ros2
