#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/units.hpp"
#include "base/unknown.hpp"
#include "dataset/csv_reader.hpp"
#include "dataset/csv_writer.hpp"

namespace fathom::dataset {

/// The columns of a file behind t_s, told once: reading and writing both go by them. Columns are required
/// until the first optional(); those behind it may be missing, and are written only where some row needs
/// them.
template <class Row>
class Columns {
 public:
  using Column = CsvReader::Column;
  using Read = std::function<void(const CsvReader&, Column, Row&)>;
  using Write = std::function<void(CsvWriter&, const Row&)>;
  using Predicate = std::function<bool(const Row&)>;
  struct Cell {
    std::string name;
    Read read;
    Write write;            ///< none: only read
    std::size_t group = 0;  ///< 0: required
  };

  /// The columns that follow are optional; written where some row fulfils the predicate.
  Columns& optional(Predicate worth_writing) {
    groups_.push_back(std::move(worth_writing));
    return *this;
  }
  /// The columns so far may be missing where this optional one is there.
  Columns& required_without(std::string column) {
    substitute_ = std::move(column);
    return *this;
  }

  Columns& cell(std::string name, Read read, Write write) {
    cells_.push_back({std::move(name), std::move(read), std::move(write), groups_.size()});
    return *this;
  }
  Columns& number(std::string name, double Row::*member) { return scaled(std::move(name), member, 1.0, 1.0); }
  Columns& degrees(std::string name, double Row::*member) {
    return scaled(std::move(name), member, kRadPerDeg, kDegPerRad);
  }
  template <std::size_t N>
  Columns& numbers(const std::array<const char*, N>& names, std::array<double, N> Row::*member) {
    return scaled(names, member, 1.0, 1.0);
  }
  template <std::size_t N>
  Columns& degrees(const std::array<const char*, N>& names, std::array<double, N> Row::*member) {
    return scaled(names, member, kRadPerDeg, kDegPerRad);
  }
  /// lat_deg and lon_deg, which lie within their bounds.
  Columns& place(double Row::*latitude_rad, double Row::*longitude_rad) {
    bounded_degrees("lat_deg", latitude_rad, 90.0, "latitude lies outside +-90 degrees");
    return bounded_degrees("lon_deg", longitude_rad, 360.0, "longitude lies outside +-360 degrees");
  }
  /// One of these words; a blank leaves the member as it is.
  template <class Enum>
  Columns& word(std::string name, Enum Row::*member, std::vector<std::pair<std::string_view, Enum>> words) {
    return cell(
        name,
        [name, member, words](const CsvReader& csv, Column column, Row& row) {
          const std::string_view text = csv.text(column);
          if (text.empty()) return;
          std::string expected;
          for (std::size_t i = 0; i < words.size(); ++i) {
            if (words[i].first == text) {
              row.*member = words[i].second;
              return;
            }
            expected += i == 0 ? "" : i + 1 == words.size() ? " or " : ", ";
            expected += words[i].first;
          }
          csv.fail("column " + name + ": '" + std::string(text) + "', expected " + expected);
        },
        [member, words](CsvWriter& csv, const Row& row) {
          std::string_view text = words.front().first;
          for (const auto& [word, value] : words) {
            if (value == row.*member) text = word;
          }
          csv.text(text);
        });
  }
  /// What is left to do with a row when all its columns are read.
  Columns& finally(std::function<void(const CsvReader&, Row&)> finish) {
    finish_ = std::move(finish);
    return *this;
  }

  /// The columns as they stand in a file. Throws where it has no time or lacks a required one.
  class Found {
   public:
    Found(const Columns& columns, const CsvReader& csv) : columns_(columns), csv_(csv) {
      const bool substituted =
          !columns.substitute_.empty() && csv.optional_column(columns.substitute_).has_value();
      std::vector<std::string> required{"t_s"};
      for (const Cell& cell : columns.cells_) {
        if (cell.group == 0 && !substituted) required.push_back(cell.name);
        places_.push_back(csv.optional_column(cell.name));
      }
      csv.require(required);
    }
    void read(Row& row) const {
      for (std::size_t i = 0; i < places_.size(); ++i) {
        if (places_[i]) columns_.cells_[i].read(csv_, *places_[i], row);
      }
      if (columns_.finish_) columns_.finish_(csv_, row);
    }

   private:
    const Columns& columns_;
    const CsvReader& csv_;
    std::vector<std::optional<Column>> places_;
  };

  /// The columns that are worth writing for these rows.
  class Chosen {
   public:
    Chosen(const Columns& columns, const std::vector<Row>& rows) {
      std::vector<bool> worth(columns.groups_.size() + 1, true);
      for (std::size_t group = 0; group < columns.groups_.size(); ++group)
        worth[group + 1] = std::any_of(rows.begin(), rows.end(), columns.groups_[group]);
      for (const Cell& cell : columns.cells_) {
        if (!cell.write || !worth[cell.group]) continue;
        cells_.push_back(&cell);
        header_ += "," + cell.name;
      }
    }
    [[nodiscard]] const std::string& header() const { return header_; }
    void write(CsvWriter& csv, const Row& row) const {
      for (const Cell* cell : cells_) cell->write(csv, row);
    }

   private:
    std::string header_;  // each name behind a comma
    std::vector<const Cell*> cells_;
  };

 private:
  Columns& scaled(std::string name, double Row::*member, double in, double out) {
    return cell(
        std::move(name),
        [member, in](const CsvReader& csv, Column column, Row& row) {
          row.*member = csv.number(column) * in;
        },
        [member, out](CsvWriter& csv, const Row& row) { csv.number(row.*member * out); });
  }
  template <std::size_t N>
  Columns& scaled(const std::array<const char*, N>& names, std::array<double, N> Row::*member, double in,
                  double out) {
    for (std::size_t i = 0; i < N; ++i) {
      cell(
          names[i],
          [member, i, in](const CsvReader& csv, Column column, Row& row) {
            (row.*member)[i] = csv.number(column) * in;
          },
          [member, i, out](CsvWriter& csv, const Row& row) { csv.number((row.*member)[i] * out); });
    }
    return *this;
  }
  Columns& bounded_degrees(const std::string& name, double Row::*member, double limit_deg,
                           const std::string& fault) {
    return cell(
        name,
        [=](const CsvReader& csv, Column column, Row& row) {
          const double degrees = csv.number(column);
          if (std::abs(degrees) > limit_deg) csv.fail("column " + name + ": " + fault);
          row.*member = degrees * kRadPerDeg;
        },
        [member](CsvWriter& csv, const Row& row) { csv.number(row.*member * kDegPerRad); });
  }

  std::vector<Cell> cells_;
  std::vector<Predicate> groups_;
  std::string substitute_;
  std::function<void(const CsvReader&, Row&)> finish_;
};

/// The columns of a kind's file, and of reference.csv; each in columns/.
template <class Row>
[[nodiscard]] const Columns<Row>& columns();

}  // namespace fathom::dataset
