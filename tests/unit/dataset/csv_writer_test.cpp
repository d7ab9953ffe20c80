#include "dataset/csv_writer.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fathom::dataset {
namespace {

struct Number {
  double value;
  int decimals;
};

/// One number a line, as the writer has it.
std::vector<std::string> written(const std::vector<Number>& numbers) {
  const std::string path = ::testing::TempDir() + "csv_writer_test.csv";
  {
    CsvWriter csv(path);
    for (const Number& one : numbers) csv.fixed(one.value, one.decimals).end_row();
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
  const std::vector<std::string> lines = written(numbers);
  ASSERT_EQ(lines.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    ASSERT_EQ(lines[i], expected(numbers[i])) << numbers[i].decimals << " decimals";
}

}  // namespace
}  // namespace fathom::dataset
