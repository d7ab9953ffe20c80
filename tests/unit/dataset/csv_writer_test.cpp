#include "dataset/csv_writer.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/unknown.hpp"

namespace fathom::dataset {
namespace {

struct Number {
  double value;
  int decimals;
};

/// The lines of a file that `write` fills.
template <class Write>
std::vector<std::string> written(Write write) {
  const std::string path = ::testing::TempDir() + "csv_writer_test.csv";
  {
    CsvWriter csv(path);
    write(csv);
    csv.close();
  }
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  std::remove(path.c_str());
  return lines;
}

/// The C library rounds exactly, ties to even.
std::string expected(const Number& one) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), "%.*f", one.decimals, one.value);
  return text.data();
}

TEST(CsvWriter, FixedDecimalsAreThoseOfTheCLibrary) {
  std::vector<Number> numbers;
  // Halves that a double holds, and their neighbours; zeros; what is large.
  for (const double base :
       {0.5, 1.5, 2.5, 0.125, 0.375, 1e-9, 123456.5, 0.0, 1e12, 1e15, 4503599627370495.5, 1e300}) {
    for (const double value : {base, std::nextafter(base, 1e308), std::nextafter(base, -1.0)})
      for (const double sign : {1.0, -1.0})
        for (int decimals = 0; decimals <= 14; ++decimals) numbers.push_back({sign * value, decimals});
  }
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> exponent(-14.0, 14.0);
  for (int i = 0; i < 200'000; ++i) {
    const double value = std::pow(10.0, exponent(random)) * (random() % 2 == 0 ? 1.0 : -1.0);
    const int decimals = static_cast<int>(random() % 13);
    numbers.push_back({value, decimals});
    // Decimals near a half of the last one, on either side by some units in the last place.
    const double scale = std::pow(10.0, decimals);
    double near = (std::floor(std::abs(value) * scale) + 0.5) / scale;
    for (std::uint64_t step = random() % 4; step > 0; --step)
      near = std::nextafter(near, random() % 2 == 0 ? 1e308 : 0.0);
    numbers.push_back({near, decimals});
  }
  const std::vector<std::string> lines = written([&](CsvWriter& csv) {
    for (const Number& one : numbers) csv.fixed(one.value, one.decimals).end_row();
  });
  ASSERT_EQ(lines.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    ASSERT_EQ(lines[i], expected(numbers[i])) << numbers[i].decimals << " decimals";
}

TEST(CsvWriter, SecondsAreExactWithTwoDecimalsAtLeast) {
  EXPECT_EQ(written([](CsvWriter& csv) {
              for (const DurationNs duration :
                   {DurationNs{0}, DurationNs{1}, DurationNs{-1}, DurationNs{10'000'000},
                    DurationNs{1'500'000'000}, DurationNs{-99'000'000'010},
                    std::numeric_limits<DurationNs>::max(), std::numeric_limits<DurationNs>::min()})
                csv.seconds(duration).end_row();
            }),
            (std::vector<std::string>{"0.00", "0.000000001", "-0.000000001", "0.01", "1.50", "-99.00000001",
                                      "9223372036.854775807", "-9223372036.854775808"}));
}

TEST(CsvWriter, FieldsOfAnyLengthStandSideBySide) {
  const std::string word(300'000, 'w');
  EXPECT_EQ(written([&](CsvWriter& csv) {
              csv.line("a,b,c");
              csv.text(word).fixed(kUnknown, 3).text("").number(0.1).end_row();
              csv.number(-1e300).number(kUnknown).end_row();
            }),
            (std::vector<std::string>{"a,b,c", word + ",,,0.1", "-1e+300,"}));
}

}  // namespace
}  // namespace fathom::dataset
