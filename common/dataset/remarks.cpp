#include "dataset/remarks.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <string_view>
#include <system_error>

#include "base/disk/folder.hpp"

namespace fathom::dataset {
namespace {

namespace fs = std::filesystem;

std::string seconds(double value, const char* form = "%.10g s") {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), form, value);
  return text.data();
}

// "0.73 s to 150.76 s", of the earliest and the latest row.
template <class T>
std::string span_of(const std::vector<T>& rows, TimeNs epoch_ns) {
  const auto [first, last] = std::minmax_element(
      rows.begin(), rows.end(), [](const T& a, const T& b) { return a.header.stamp_ns < b.header.stamp_ns; });
  return seconds(to_seconds(first->header.stamp_ns - epoch_ns)) + " to " +
         seconds(to_seconds(last->header.stamp_ns - epoch_ns));
}

// An inertial unit that is slower than a second is none: the unit of t_s is another one.
void about_inertial_times(const std::vector<ImuSample>& imu, std::vector<std::string>& out) {
  if (imu.size() < 2) return;
  std::vector<DurationNs> steps;
  steps.reserve(imu.size() - 1);
  for (std::size_t i = 1; i < imu.size(); ++i)
    steps.push_back(imu[i].header.stamp_ns - imu[i - 1].header.stamp_ns);
  const auto repeated = static_cast<std::size_t>(std::count(steps.begin(), steps.end(), 0));
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  if (*middle >= kNsPerSecond)
    out.push_back("imu: from row to row pass " + seconds(to_seconds(*middle), "%.4g s") +
                  ", expected less than a second: look whether t_s is in seconds");
  // A row that a logger writes twice now and then is no matter.
  constexpr std::size_t kShare = 100;
  if (repeated * kShare > steps.size())
    out.push_back("imu: " + std::to_string(repeated) + " of " + std::to_string(imu.size()) +
                  " rows have the t_s of the row before and are not used: write t_s with more digits");
}

// A blank is unknown; zero is what receivers and converters write in its place.
void about_sigmas(const std::vector<GpsSample>& gps, std::vector<std::string>& out) {
  const auto count = std::count_if(gps.begin(), gps.end(), [](const GpsSample& fix) {
    return fix.fix != GpsFix::none &&
           std::any_of(fix.position_sigma_N_m.begin(), fix.position_sigma_N_m.end(),
                       [](double sigma) { return sigma <= 0.0; });
  });
  if (count == 0) return;
  out.push_back(
      "gps: " + std::to_string(count) + " of " + std::to_string(gps.size()) +
      " rows say a sigma of zero or less, which no fix can have: leave sigma_n_m, sigma_e_m and sigma_d_m "
      "blank where they are not known");
}

template <class T>
void about_common_time(std::string_view word, const std::vector<T>& rows, const std::vector<ImuSample>& imu,
                       TimeNs epoch_ns, std::vector<std::string>& out) {
  if (rows.empty() || imu.empty()) return;
  const TimeNs begin_ns = imu.front().header.stamp_ns;
  const TimeNs end_ns = imu.back().header.stamp_ns;
  const bool common = std::any_of(rows.begin(), rows.end(), [&](const T& row) {
    return row.header.stamp_ns >= begin_ns && row.header.stamp_ns <= end_ns;
  });
  if (common) return;
  out.push_back(std::string(word) + ": none of its " + std::to_string(rows.size()) +
                " rows lies in the time of imu: t_s is " + span_of(rows, epoch_ns) + " here and " +
                span_of(imu, epoch_ns) + " there. Expected one clock, in seconds, in all files");
}

std::vector<std::string> known_words() {
  std::vector<std::string> out;
  for_each_kind([&](auto kind) { out.emplace_back(kind.kWord); });
  out.emplace_back("reference");
  return out;
}

// Tables that a person may take for a part of the data set. What fathom itself writes there is none.
void about_other_files(const fs::path& directory, std::vector<std::string>& out) {
  const std::vector<std::string> words = known_words();
  const auto is_one_of = [](const std::string& word, const std::vector<std::string>& of) {
    return std::find(of.begin(), of.end(), word) != of.end();
  };
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::path& file : paths_in(directory, error)) {
    fs::path stem = file.filename();
    if (stem.extension() == ".gz") stem = stem.stem();
    std::string ending = stem.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    const std::string word = stem.stem().string();
    if (ending != ".csv" || is_one_of(word, {"nav", "mag", "baro"})) continue;
    if (stem.extension() == ".csv" && is_one_of(word, words)) continue;
    names.push_back(file.filename().string());
  }
  if (names.empty()) return;
  std::sort(names.begin(), names.end());
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  text +=
      names.size() == 1 ? " is not read: its name is none of " : " are not read: their names are none of ";
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  out.push_back(text + ", with .csv or .csv.gz behind it");
}

}  // namespace

std::vector<std::string> remarks(const fs::path& directory, const Dataset& data, const ReadOptions& options) {
  std::vector<std::string> out = data.lost_ends;
  const auto& imu = data.of<ImuSample>();
  about_inertial_times(imu, out);
  for_each_kind([&](auto kind) {
    about_common_time(kind.kWord, data.of<typename decltype(kind)::Sample>(), imu, options.epoch_ns, out);
  });
  about_common_time("reference", data.reference, imu, options.epoch_ns, out);
  about_sigmas(data.of<GpsSample>(), out);
  about_other_files(directory, out);
  return out;
}

}  // namespace fathom::dataset
