#include "logs/import.hpp"

#include <fstream>
#include <system_error>

#include <nlohmann/json.hpp>

#include "dataset/csv_writer.hpp"
#include "logs/dataflash/reader.hpp"
#include "logs/ros2/reader.hpp"
#include "logs/ulog/reader.hpp"

namespace fathom::logs {
namespace {

using Json = nlohmann::ordered_json;

// A topic may be called anything: no name of it leaves the folder or hides in it.
std::string file_name(const std::string& topic) {
  constexpr std::size_t kLongest = 150;
  std::string out;
  for (const char c : topic.substr(0, kLongest)) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    if (!plain && out.empty()) continue;
    out += plain ? c : '.';
  }
  return out.empty() ? "unnamed" : out;
}

void write_source(const std::filesystem::path& directory, const Series& series) {
  const std::string name = file_name(series.topic) + "." + std::to_string(series.instance);
  std::filesystem::path path = directory / (name + ".csv");
  // The same topic under two layouts: the second one stands beside the first.
  for (int again = 2; std::filesystem::exists(path); ++again)
    path = directory / (name + "." + std::to_string(again) + ".csv");
  dataset::CsvWriter csv(path);
  std::string line = "t_s";
  for (const std::string& column : series.columns) line += "," + column;
  csv.line(line);
  for (std::size_t row = 0; row < series.rows(); ++row) {
    csv.seconds(series.t_us[row] * 1000);
    for (std::size_t i = 0; i < series.columns.size(); ++i) csv.number(series.at(row, i));
    csv.end_row();
  }
  csv.close();
}

void write_table(const std::filesystem::path& directory, const Table& table) {
  dataset::CsvWriter csv(directory / (table.name + ".csv"));
  std::string line = "t_s";
  for (const std::string& column : table.columns) line += "," + column;
  csv.line(line);
  for (std::size_t row = 0; row < table.stamps_ns.size(); ++row) {
    csv.seconds(table.stamps_ns[row] - dataset::kDefaultEpochNs);
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      csv.number(table.values[row * table.columns.size() + i]);
    csv.end_row();
  }
  csv.close();
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

void write_words(const std::filesystem::path& directory, const Log& log) {
  if (!log.parameters.empty()) {
    dataset::CsvWriter csv(directory / "parameters.csv");
    csv.line("name,value");
    for (const auto& [name, value] : log.parameters) csv.text(name).number(value).end_row();
    csv.close();
  }
  if (!log.texts.empty()) {
    dataset::CsvWriter csv(directory / "messages.csv");
    csv.line("t_s,level,text");
    for (const LoggedText& one : log.texts)
      csv.seconds(one.t_us * 1000).number(one.level).text(quoted(one.text)).end_row();
    csv.close();
  }
}

void prepare(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw dataset::DatasetError(directory.string() + ": cannot be created: " + error.message());
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    if (entry.path().extension() == ".csv") std::filesystem::remove(entry.path(), error);
  }
}

}  // namespace

Log read(const std::filesystem::path& path) {
  if (ros2::looks_like(path)) return ros2::read(path);  // first: it may be a folder
  if (ulog::looks_like(path)) return ulog::read(path, px4_topics());
  if (dataflash::looks_like(path)) return dataflash::read(path, ardupilot_topics());
  throw LogError(path.string() +
                 ": offset 0: neither a PX4 ULog, an ArduPilot DataFlash log nor an MCAP file of ROS 2");
}

Vehicle convert(const Log& log, const ConvertOptions& options) {
  if (log.format == ros2::kFormatName) return ros2_bag(log, options);
  return log.format == dataflash::kFormatName ? ardupilot(log, options) : px4(log, options);
}

std::string to_json(const std::string& source, const Log& log, const Vehicle& vehicle) {
  Json out;
  out["source"] = source;
  out["format"] = log.format;
  for (const auto& [key, value] : log.info) out["info"][key] = value;
  for (const auto& [key, values] : log.lists) out["lists"][key] = values.size();
  out["utc_of_start"] =
      vehicle.utc_of_start_ns ? Json(to_iso8601(*vehicle.utc_of_start_ns, 6)) : Json(nullptr);
  for (const auto& [file, label] : vehicle.sources) {
    out["files"][file]["from"] = label;
    const auto others = vehicle.others.find(file);
    if (others != vehicle.others.end()) out["files"][file]["others"] = others->second;
  }
  for_each_kind([&](auto kind) {
    const std::size_t rows = vehicle.data.of<typename decltype(kind)::Sample>().size();
    if (rows > 0) out["files"][std::string(kind.kWord)]["rows"] = rows;
  });
  for (const Table& table : vehicle.tables) out["files"][table.name]["rows"] = table.stamps_ns.size();
  for (const auto& [topic, count] : log.messages) out["messages"][topic] = count;
  out["dropouts"] = {{"count", log.dropouts}, {"ms", log.dropout_ms}};
  out["lost"] = {{"count", log.losses.count}, {"bytes", log.losses.bytes}, {"first", Json::array()}};
  for (const Lost& one : log.losses.listed)
    out["lost"]["first"].push_back({{"offset", one.offset ? Json(*one.offset) : Json(nullptr)},
                                    {"bytes", one.bytes},
                                    {"what", one.what}});
  out["notes"] = Json::array();
  for (const std::string& note : log.notes) out["notes"].push_back(note);
  for (const std::string& note : vehicle.notes) out["notes"].push_back(note);
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write(const std::filesystem::path& directory, const std::string& source, const Log& log,
           const Vehicle& vehicle, const WriteOptions& options) {
  dataset::write(directory, vehicle.data, {dataset::kDefaultEpochNs, options.gzip});
  for (const char* name : {"mag.csv", "baro.csv"}) {
    std::error_code error;
    std::filesystem::remove(directory / name, error);
  }
  for (const Table& table : vehicle.tables) write_table(directory, table);
  const std::filesystem::path sources = directory / "sources";
  prepare(sources);
  for (const Series& series : log.series) {
    if (series.rows() > 0) write_source(sources, series);
  }
  write_words(sources, log);
  std::ofstream file(directory / "import.json", std::ios::binary);
  file << to_json(source, log, vehicle);
  file.close();
  if (!file) throw dataset::DatasetError((directory / "import.json").string() + ": cannot be written");
}

}  // namespace fathom::logs
