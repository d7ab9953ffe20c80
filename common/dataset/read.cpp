#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <system_error>

#include "base/disk/regular_file.hpp"
#include "dataset/columns.hpp"
#include "dataset/csv_reader.hpp"
#include "dataset/dataset.hpp"

namespace fathom::dataset {
namespace {

using Column = CsvReader::Column;
using Optional = std::optional<Column>;

constexpr double kLongestTime_s = 4.0e9;  // more than a century either side of the epoch

// A file of the folder, with the columns every file has.
class SensorFile {
 public:
  SensorFile(const std::filesystem::path& path, std::string_view kind, const ReadOptions& options)
      : csv(path, options.without_lost_ends ? CsvReader::LostEnd::left_out : CsvReader::LostEnd::refused),
        kind_(kind),
        options_(options),
        t_(csv.optional_column("t_s").value_or(0)),  // Columns::Found refuses a file without it
        received_(csv.optional_column("t_received_s")) {}

  bool next() {
    if (!csv.next()) return false;
    const TimeNs stamp = time(t_);
    const TimeNs received = received_ && !csv.text(*received_).empty() ? time(*received_) : stamp;
    if (sequence_ > 0) {
      stamps_sorted_ = stamps_sorted_ && stamp >= header.stamp_ns;
      arrivals_sorted_ = arrivals_sorted_ && received >= header.received_ns;
      if (!stamps_sorted_ && !(received_ && arrivals_sorted_)) {
        csv.fail("t_s " + std::string(csv.text(t_)) + " is earlier than " + text_before_ +
                 " in the row before, expected rows sorted by t_s" +
                 (received_ ? " or by t_received_s" : "") + began_anew(header.stamp_ns - stamp));
      }
    }
    text_before_ = csv.text(t_);
    header = SampleHeader{options_.vehicle, kind_, stamp, received, sequence_++};
    return true;
  }

  CsvReader csv;
  SampleHeader header;  // of the present row

 private:
  TimeNs time(Column column) const {
    const double t_s = csv.number(column);
    if (!(std::abs(t_s) <= kLongestTime_s)) {
      csv.fail("column " + std::string(csv.name(column)) + ": '" + std::string(csv.text(column)) +
               "' is not a time, expected seconds");
    }
    return options_.epoch_ns + from_seconds(t_s);
  }

  /// What a count of time that began anew says of it; empty where it is none.
  static std::string began_anew(DurationNs back) {
    constexpr double kGap_s = 60.0;  // between two rows
    for (const auto& [period_s, word] : {std::pair{604'800, "a GPS week"}, {86'400, "a day"}}) {
      const double gap_s = period_s - to_seconds(back);
      if (gap_s < 0.0 || gap_s > kGap_s) continue;
      return std::string("; ") + word + " began: add " + std::to_string(period_s) +
             " s from here on, in every file";
    }
    return "";
  }

  Name kind_;
  const ReadOptions& options_;
  Column t_;
  Optional received_;
  std::uint64_t sequence_ = 0;
  std::string text_before_;  // t_s of the row before, as it stands there
  bool stamps_sorted_ = true;
  bool arrivals_sorted_ = true;
};

// Room for the rest of the file, by how much of it has been read. Where room is doubled instead, a long file
// is copied at its greatest and has both copies in memory.
template <class T>
void make_room(std::vector<T>& rows, const CsvReader& csv) {
  constexpr std::size_t kRowsToJudgeBy = 4'096;
  constexpr double kMargin = 1.05;
  constexpr double kMostGrowth = 64.0;  // at once, whatever the file promises
  if (rows.size() < rows.capacity() || rows.size() < kRowsToJudgeBy) return;
  const auto count = static_cast<double>(rows.size());
  const double expected = kMargin * count / std::max(csv.part_read(), 0.01);
  rows.reserve(static_cast<std::size_t>(std::clamp(expected, 1.1 * count, kMostGrowth * count)));
}

template <class T>
void read_stream(const std::filesystem::path& directory, std::string_view kind, const ReadOptions& options,
                 std::vector<T>& out, std::vector<std::string>& lost_ends) {
  const std::filesystem::path plain = directory / (std::string(kind) + ".csv");
  std::filesystem::path zipped = plain;
  zipped += ".gz";
  const auto lies_there = [](const std::filesystem::path& path) {
    std::error_code unknown;
    return std::filesystem::symlink_status(path, unknown).type() != std::filesystem::file_type::not_found;
  };
  const bool has_plain = lies_there(plain);
  const bool has_zipped = lies_there(zipped);
  if (has_plain && has_zipped) {
    throw DatasetError(plain.string() + ": exists beside " + zipped.filename().string() +
                       ", expected one of the two");
  }
  if (!has_plain && !has_zipped) return;
  const std::filesystem::path& there = has_plain ? plain : zipped;
  if (const std::string wrong = no_regular_file(there); !wrong.empty())
    throw DatasetError(there.string() + ": " + wrong);
  SensorFile file(there, kind, options);
  const typename Columns<T>::Found found(columns<T>(), file.csv);
  while (file.next()) {
    make_room(out, file.csv);
    T& row = out.emplace_back();
    row.header = file.header;
    found.read(row);
  }
  if (!file.csv.lost_end().empty())
    lost_ends.push_back(there.filename().string() + ":" + file.csv.lost_end() +
                        (out.empty() ? "" : "; the rows before it are used"));
}

}  // namespace

Dataset read(const std::filesystem::path& directory, const ReadOptions& options) {
  std::error_code error;
  if (!std::filesystem::is_directory(directory, error)) {
    throw DatasetError(directory.string() + ": is not a folder, expected a data set with imu.csv and others");
  }
  Dataset data;
  for_each_kind([&](auto kind) {
    read_stream(directory, kind.kWord, options, data.of<typename decltype(kind)::Sample>(), data.lost_ends);
  });
  read_stream(directory, "reference", options, data.reference, data.lost_ends);
  return data;
}

std::vector<Arrival> arrivals(const Dataset& data) {
  std::vector<Arrival> order;
  for_each_kind([&](auto kind) {
    const auto& samples = data.of<typename decltype(kind)::Sample>();
    for (std::size_t i = 0; i < samples.size(); ++i)
      order.push_back({samples[i].header.received_ns, kind.kSource, static_cast<std::uint32_t>(i)});
  });
  std::stable_sort(order.begin(), order.end(),
                   [](const Arrival& a, const Arrival& b) { return a.received_ns < b.received_ns; });
  return order;
}

}  // namespace fathom::dataset
