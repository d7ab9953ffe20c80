#include <cstring>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "logs/import.hpp"
#include "logs/ulog/format.hpp"
#include "logs/ulog/reader.hpp"
#include "support/temporary_folder.hpp"
#include "ulog_bytes.hpp"

namespace fathom::logs {
namespace {

using test::UlogBytes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kBaro = "sensor_baro:uint64_t timestamp;float pressure;uint8_t[4] _padding0;";

std::string baro(std::uint64_t t_us, float pressure) {
  return UlogBytes::pack(t_us) + UlogBytes::pack(pressure);
}

class Ulog : public ::testing::Test {
 protected:
  Log read(const UlogBytes& bytes) {
    bytes.write(folder_ / "log.ulg");
    return logs::ulog::read(folder_ / "log.ulg", {"sensor_baro", "nested"});
  }
  test::TemporaryFolder folder_;
};

// A header, a format, a subscription, and rows 0 ... n - 1, each a second after the other.
UlogBytes with_rows(int n) {
  UlogBytes log;
  log.format(kBaro).subscribe(7, 0, "sensor_baro");
  for (int i = 0; i < n; ++i)
    log.data(7, baro(1'000'000ULL * static_cast<unsigned>(i + 1), 1000.0F + static_cast<float>(i)));
  return log;
}

TEST_F(Ulog, NestedFormatsArraysAndPaddingAreSpelledOut) {
  UlogBytes log;
  // Used before it is defined; padding inside counts, padding at the end is not logged.
  log.format("nested:uint64_t timestamp;part[2] p;bool b;char[3] text;uint8_t[3] _padding0;");
  log.format("part:int16_t[2] a;uint8_t _padding0;double d;");
  log.subscribe(1, 3, "nested");
  std::string content = UlogBytes::pack(std::uint64_t{5});
  for (int i = 0; i < 2; ++i) {
    content += UlogBytes::pack(static_cast<std::int16_t>(-1 - i)) +
               UlogBytes::pack(static_cast<std::int16_t>(30000));
    content += "x" + UlogBytes::pack(0.25 + i);
  }
  content += std::string("\x01") + "abc";
  log.data(1, content);
  const Log out = read(log);
  ASSERT_EQ(out.series.size(), 1U);
  const Series& series = out.series[0];
  EXPECT_EQ(series.instance, 3U);
  EXPECT_THAT(series.columns, ElementsAre("timestamp", "p[0].a[0]", "p[0].a[1]", "p[0].d", "p[1].a[0]",
                                          "p[1].a[1]", "p[1].d", "b"));
  EXPECT_THAT(series.values, ElementsAre(5.0, -1.0, 30000.0, 0.25, -2.0, 30000.0, 1.25, 1.0));
  EXPECT_EQ(out.losses.count, 0U);
}

TEST_F(Ulog, FormatsThatCannotBeAreNamedAndCostOnlyTheirOwnData) {
  UlogBytes log;
  log.format("loop:uint64_t timestamp;loop x;").subscribe(1, 0, "loop");
  log.format("void:uint64_t timestamp;nothing x;").subscribe(2, 0, "void");
  log.format("huge:uint64_t timestamp;double[9000] x;").subscribe(3, 0, "huge");
  log.format(kBaro).subscribe(7, 0, "sensor_baro");
  log.data(1, "12345678").data(7, baro(1'000'000, 1.0F)).data(2, "1").data(7, baro(2'000'000, 2.0F));
  const Log out = read(log);
  ASSERT_EQ(out.series.size(), 1U);
  EXPECT_EQ(out.series[0].rows(), 2U);
  EXPECT_EQ(out.losses.count, 5U);
  EXPECT_THAT(out.losses.listed[0].what, HasSubstr("contains itself"));
  EXPECT_THAT(out.losses.listed[1].what, HasSubstr("nothing is not defined"));
  EXPECT_THAT(out.losses.listed[2].what, HasSubstr("larger than a message"));
}

TEST_F(Ulog, InformationParametersTextsAndDropouts) {
  UlogBytes log;
  log.key('I', "char[3] sys_name", "PX4").key('I', "uint32_t ver_sw_release", UlogBytes::pack(0x010D02FFU));
  log.key('I', "char[0] empty", "");
  log.message('M', std::string("\0", 1) + "\x0C" + "char[2] list" + "ab");
  log.message('M', std::string("\x01", 1) + "\x0C" + "char[2] list" + "cd");
  log.message('M', std::string("\0", 1) + "\x0C" + "char[2] list" + "ef");
  log.key('P', "float GAIN", UlogBytes::pack(0.5F)).key('P', "int32_t N", UlogBytes::pack(std::int32_t{-3}));
  log.message('Q', std::string("\x01", 1) + "\x0A" + "float GAIN" + UlogBytes::pack(9.0F));
  log.message('L', "4" + UlogBytes::pack(std::uint64_t{7}) + "look out");
  log.message('C', "6" + UlogBytes::pack(std::uint16_t{2}) + UlogBytes::pack(std::uint64_t{8}) + "tagged");
  log.message('O', UlogBytes::pack(std::uint16_t{30}))
      .message('O', UlogBytes::pack(std::uint16_t{12}))
      .sync();
  log.key('P', "float GAIN", UlogBytes::pack(0.75F));
  const Log out = read(log);
  EXPECT_EQ(out.losses.count, 0U) << out.losses.listed[0].what;
  EXPECT_EQ(out.info.at("sys_name"), "PX4");
  EXPECT_EQ(out.info.at("ver_sw_release"), std::to_string(0x010D02FF));
  EXPECT_THAT(out.lists.at("list"), ElementsAre("abcd", "ef"));
  EXPECT_EQ(out.parameters.at("GAIN"), 0.75);
  EXPECT_EQ(out.parameters.at("N"), -3.0);
  ASSERT_EQ(out.texts.size(), 2U);
  EXPECT_EQ(out.texts[0].text, "look out");
  EXPECT_EQ(out.texts[0].level, 4);
  EXPECT_EQ(out.texts[1].t_us, 8);
  EXPECT_EQ(out.dropouts, 2U);
  EXPECT_EQ(out.dropout_ms, 42U);
}

TEST_F(Ulog, AppendedDataBeginsAnewWhateverWasCutBeforeIt) {
  UlogBytes log;
  const std::size_t place = log.flags(1, 1, 1);
  log.format(kBaro).subscribe(7, 0, "sensor_baro").data(7, baro(1'000'000, 1.0F));
  log.raw(
      std::string("\xFF\x00"
                  "D\x07",
                  4));  // a message that a crash cut off
  const std::uint64_t first = log.bytes().size();
  log.data(7, baro(2'000'000, 2.0F)).raw(std::string("\x20\x00", 2));
  const std::uint64_t second = log.bytes().size();
  log.data(7, baro(3'000'000, 3.0F));
  std::memcpy(log.bytes().data() + place, &first, 8);
  std::memcpy(log.bytes().data() + place + 8, &second, 8);
  const Log out = read(log);
  ASSERT_EQ(out.series.size(), 1U);
  EXPECT_THAT(out.series[0].t_us, ElementsAre(1'000'000, 2'000'000, 3'000'000));
  EXPECT_EQ(out.losses.count, 2U);
  EXPECT_EQ(out.losses.bytes, 6U);
}

TEST_F(Ulog, UnknownIncompatibleFeaturesAreRefused) {
  UlogBytes log;
  log.flags(2);
  try {
    (void)read(log);
    FAIL() << "not refused";
  } catch (const LogError& error) {
    EXPECT_THAT(error.what(), HasSubstr("offset 27"));
    EXPECT_THAT(error.what(), HasSubstr("incompatible"));
  }
}

TEST_F(Ulog, ACutAnywhereLosesOnlyWhatLiesBehindIt) {
  const UlogBytes whole = with_rows(20);
  const std::size_t row = 3 + 2 + 12;
  const std::size_t begin = const_cast<UlogBytes&>(whole).bytes().size() - 20 * row;
  for (std::size_t size = 16; size <= begin + 20 * row; ++size) {
    UlogBytes cut = whole;
    cut.bytes().resize(size);
    const Log out = read(cut);
    const std::size_t rows = size < begin ? 0 : (size - begin) / row;
    EXPECT_EQ(out.series.empty() ? 0 : out.series[0].rows(), rows) << size;
    if (size >= begin) {
      EXPECT_EQ(out.losses.bytes, (size - begin) % row) << size;
    }
  }
}

TEST_F(Ulog, GarbageBetweenMessagesLosesNoMessage) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 50; ++round) {
    UlogBytes log;
    log.format(kBaro).subscribe(7, 0, "sensor_baro");
    std::size_t garbage = 0;
    for (unsigned i = 0; i < 40; ++i) {
      log.data(7, baro(1'000'000ULL * (i + 1), 1.0F));
      if (random() % 4 != 0) continue;
      std::string bytes(random() % 200, '\0');
      for (char& c : bytes) c = static_cast<char>(random());
      garbage += bytes.size();
      log.raw(bytes);
    }
    const Log out = read(log);
    ASSERT_EQ(out.series.size(), 1U);
    EXPECT_EQ(out.series[0].rows(), 40U) << round;
    EXPECT_EQ(out.losses.bytes, garbage) << round;
  }
}

TEST_F(Ulog, AnyBytesEndWithoutACrash) {
  std::mt19937_64 random(11);
  const UlogBytes whole = with_rows(50);
  for (int round = 0; round < 300; ++round) {
    UlogBytes bad = whole;
    for (unsigned i = 0; i < 1 + random() % 20; ++i)
      bad.bytes()[16 + random() % (bad.bytes().size() - 16)] = static_cast<std::uint8_t>(random());
    const Log out = read(bad);
    for (const Series& one : out.series) EXPECT_EQ(one.values.size(), one.rows() * one.columns.size());
  }
}

TEST_F(Ulog, MessagesOfOtherKindsAndLengthsAreCountedAndPassed) {
  UlogBytes log = with_rows(2);
  log.message('X', "of the future").data(7, baro(3'000'000, 3.0F));
  log.data(9, "nobody's").data(7, baro(4'000'000, 4.0F));
  log.data(7, "short")
      .data(7, baro(5'000'000, 5.0F) + std::string(4, '\0'))
      .data(7, baro(6'000'000, 6.0F) + std::string(30, 'x'));
  log.data(7, baro(7'000'000, 7.0F));
  const Log out = read(log);
  EXPECT_EQ(out.series[0].rows(), 7U);
  EXPECT_EQ(out.losses.count, 2U);
  EXPECT_THAT(out.losses.listed[0].what, HasSubstr("id 9"));
  EXPECT_THAT(out.losses.listed[1].what, HasSubstr("sensor_baro of 7 bytes"));
  ASSERT_EQ(out.notes.size(), 1U);
  EXPECT_THAT(out.notes[0], HasSubstr("'X'"));
}

TEST_F(Ulog, ATimeThatDamageMadeIsDropped) {
  UlogBytes log = with_rows(3);
  log.data(7, baro(900'000'000'000ULL, 3.0F)).data(7, baro(4'000'000, 4.0F)).data(7, baro(5'000'000, 5.0F));
  log.data(7, baro(~std::uint64_t{0}, 6.0F));
  const Log out = read(log);
  EXPECT_THAT(out.series[0].t_us, ElementsAre(1'000'000, 2'000'000, 3'000'000, 4'000'000, 5'000'000));
  EXPECT_EQ(out.losses.count, 2U);
}

}  // namespace
}  // namespace fathom::logs
