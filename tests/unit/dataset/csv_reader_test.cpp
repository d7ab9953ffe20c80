#include "dataset/csv_reader.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "dataset/dataset.hpp"
#include "dataset_folder.hpp"

namespace fathom::dataset {
namespace {

/// The numbers of a file with one field a line.
std::vector<double> read(const std::vector<std::string>& fields) {
  const test::DatasetFolder folder;
  std::string text = "x\n";
  for (const std::string& field : fields) text += field + "\n";
  folder.file("x.csv", text);
  CsvReader csv(folder.path() / "x.csv");
  std::vector<double> out;
  while (csv.next()) out.push_back(csv.number(0));
  return out;
}

std::string digits(std::mt19937_64& random, std::size_t count) {
  std::string out;
  while (out.size() < count) out += static_cast<char>('0' + random() % 10);
  return out;
}

TEST(CsvReader, NumbersAreThoseOfTheCLibraryToTheLastBit) {
  std::vector<std::string> fields{"0",
                                  "-0",
                                  "0.0",
                                  "-0.000",
                                  "5.",
                                  ".5",
                                  "-.5",
                                  "+1.25",
                                  "1e3",
                                  "-2E-7",
                                  "inf",
                                  "9007199254740992",
                                  "00012",
                                  "1e308",
                                  "5e-324",
                                  "9007199254740993",
                                  "0.9007199254740993",
                                  "9999999999999999999",
                                  "123456789012345678901234567890"};
  std::mt19937_64 random(5);
  for (int i = 0; i < 200'000; ++i) {
    std::string field = random() % 2 == 0 ? "-" : "";
    field += digits(random, 1 + random() % 12);
    if (random() % 8 != 0) field += "." + digits(random, 1 + random() % 12);
    if (random() % 16 == 0) field += "e-" + digits(random, 1);
    fields.push_back(field);
  }
  const std::vector<double> numbers = read(fields);
  ASSERT_EQ(numbers.size(), fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint64_t>(numbers[i]),
              std::bit_cast<std::uint64_t>(std::strtod(fields[i].c_str(), nullptr)))
        << fields[i];
}

TEST(CsvReader, WhatIsNoNumberIsNamed) {
  for (const char* field : {"-", ".", "-.", "1.2.3", "12a", "0x10", "1,5", "--1", "1e", "1e999", "1 2"}) {
    try {
      (void)read({field});
      ADD_FAILURE() << field;
    } catch (const DatasetError& error) {
      EXPECT_NE(std::string(error.what()).find("x.csv:2"), std::string::npos) << error.what();
    }
  }
}

TEST(CsvReader, BlanksAroundAFieldAreForgiven) {
  EXPECT_EQ(read({" 1.5", "2.5\t", "\t-3.5 \r"}), (std::vector<double>{1.5, 2.5, -3.5}));
  EXPECT_TRUE(std::isnan(read({"nan"}).at(0)));
}

}  // namespace
}  // namespace fathom::dataset
