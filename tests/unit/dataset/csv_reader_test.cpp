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
std::vector<double> numbers_of(const std::vector<std::string>& fields) {
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
  const std::vector<double> numbers = numbers_of(fields);
  ASSERT_EQ(numbers.size(), fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint64_t>(numbers[i]),
              std::bit_cast<std::uint64_t>(std::strtod(fields[i].c_str(), nullptr)))
        << fields[i];
}

TEST(CsvReader, WhatIsNoNumberIsNamed) {
  for (const char* field : {"-", ".", "-.", "1.2.3", "12a", "0x10", "1,5", "--1", "1e", "1e999", "1 2"}) {
    try {
      (void)numbers_of({field});
      ADD_FAILURE() << field;
    } catch (const DatasetError& error) {
      EXPECT_NE(std::string(error.what()).find("x.csv:2"), std::string::npos) << error.what();
    }
  }
}

/// How many rows of a file are there, and what is said of its end.
std::pair<std::size_t, std::string> rows_of(const test::DatasetFolder& folder, const char* name) {
  CsvReader csv(folder.path() / name, CsvReader::LostEnd::left_out);
  std::size_t rows = 0;
  while (csv.next()) ++rows;
  return {rows, csv.lost_end()};
}

TEST(CsvReader, WhatIsBeforeALostEndIsRead) {
  const test::DatasetFolder folder;
  const auto rows = [&](const std::string& text) {
    folder.file("x.csv", text);
    return rows_of(folder, "x.csv");
  };
  const std::string whole = "t_s,depth_m\n1,2\n2,3\n";
  using Found = std::pair<std::size_t, std::string>;
  EXPECT_EQ(rows(whole), Found(2, ""));
  EXPECT_EQ(rows(whole + "3,4"), Found(3, "")) << "no line end, and whole";
  EXPECT_EQ(rows(whole + "3"),
            Found(2, "4: row has 1 field, expected 2, and no line end: the file was cut there"));
  const std::string zeros = "4: the file ends in zero bytes, expected rows";
  EXPECT_EQ(rows(whole + std::string(3, '\0')), Found(2, zeros));
  EXPECT_EQ(rows(whole + "3,4" + std::string(300'000, '\0')), Found(2, zeros)) << "how long was the 4?";
  // What goes on behind it was not lost, and is not left out without a word.
  for (const std::string& damaged : {whole + "3\n4,5\n", whole + std::string(5, '\0') + "\n4,5\n"})
    EXPECT_THROW((void)rows(damaged), DatasetError) << damaged;
  folder.file("x.csv", "t_s,dep");
  CsvReader header(folder.path() / "x.csv", CsvReader::LostEnd::left_out);
  EXPECT_THROW(header.require({"t_s", "depth_m"}), DatasetError);
}

TEST(CsvReader, WhatIsBeforeTheEndOfCutGzipDataIsRead) {
  const test::DatasetFolder folder;
  std::mt19937_64 random(7);
  std::string text = "t_s,depth_m\n";
  for (int i = 0; i < 20'000; ++i) text += std::to_string(i) + "," + digits(random, 6) + "\n";
  folder.zipped("x.csv.gz", text);
  folder.cut("x.csv.gz", std::filesystem::file_size(folder.path() / "x.csv.gz") / 2);
  const auto [rows, said] = rows_of(folder, "x.csv.gz");
  EXPECT_GT(rows, 9'000U);
  EXPECT_LT(rows, 11'000U);
  EXPECT_EQ(said, std::to_string(rows + 2) +
                      ": gzip data end too early: the file is truncated, expected a complete .gz file");
  CsvReader strict(folder.path() / "x.csv.gz");
  EXPECT_THROW(while (strict.next()){}, DatasetError);
}

TEST(CsvReader, BlanksAroundAFieldAreForgiven) {
  EXPECT_EQ(numbers_of({" 1.5", "2.5\t", "\t-3.5 \r"}), (std::vector<double>{1.5, 2.5, -3.5}));
  EXPECT_TRUE(std::isnan(numbers_of({"nan"}).at(0)));
}

}  // namespace
}  // namespace fathom::dataset
