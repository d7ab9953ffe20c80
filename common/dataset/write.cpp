#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <system_error>

#include "dataset/columns.hpp"
#include "dataset/csv_writer.hpp"
#include "dataset/dataset.hpp"

namespace fathom::dataset {
namespace {

constexpr std::array kSuffixes{".csv", ".csv.gz"};

template <class T>
void write_stream(const std::filesystem::path& directory, std::string_view kind, const WriteOptions& options,
                  const std::vector<T>& stream) {
  std::error_code error;
  for (const char* suffix : kSuffixes) {
    // What an earlier run left would stand beside the new file, or for a sensor that this data set has not.
    std::filesystem::remove(directory / (std::string(kind) + suffix), error);
  }
  if (stream.empty()) return;
  CsvWriter csv(directory / (std::string(kind) + (options.gzip ? ".csv.gz" : ".csv")));
  const bool arrivals = std::any_of(stream.begin(), stream.end(), [](const T& sample) {
    return sample.header.received_ns != sample.header.stamp_ns;
  });
  const typename Columns<T>::Chosen chosen(columns<T>(), stream);
  csv.line("t_s" + chosen.header() + (arrivals ? ",t_received_s" : ""));
  for (const T& sample : stream) {
    csv.seconds(sample.header.stamp_ns - options.epoch_ns);
    chosen.write(csv, sample);
    if (arrivals) csv.seconds(sample.header.received_ns - options.epoch_ns);
    csv.end_row();
  }
  csv.close();
}

}  // namespace

std::vector<std::string> file_names() {
  std::vector<std::string> out;
  const auto add = [&](std::string_view kind) {
    for (const char* suffix : kSuffixes) out.push_back(std::string(kind) + suffix);
  };
  for_each_kind([&](auto kind) { add(kind.kWord); });
  add("reference");
  return out;
}

void write(const std::filesystem::path& directory, const Dataset& data, const WriteOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw WriteError(directory.string() + ": cannot be created: " + error.message());
  for_each_kind([&](auto kind) {
    write_stream(directory, kind.kWord, options, data.of<typename decltype(kind)::Sample>());
  });
  write_stream(directory, "reference", options, data.reference);
}

}  // namespace fathom::dataset
