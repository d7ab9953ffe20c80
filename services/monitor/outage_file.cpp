#include "monitor/outage_file.hpp"

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include <nlohmann/json.hpp>

#include "base/disk/regular_file.hpp"

namespace fathom::monitor {
namespace {

using nlohmann::json;

constexpr std::size_t kMostBytes = 64 * 1024;
constexpr std::size_t kMostBooks = 64;
constexpr TimeNs kLatest_ns = 4'000'000'000 * kNsPerSecond;  // the year 2096
constexpr DurationNs kLongest_ns = 3'000'000'000 * kNsPerSecond;

std::optional<std::int64_t> whole(const json& entry, const char* key, std::int64_t most) {
  const auto found = entry.find(key);
  if (found == entry.end() || !found->is_number_integer()) return std::nullopt;
  const auto value = found->get<std::int64_t>();
  if (value < 0 || value > most) return std::nullopt;
  return value;
}

std::optional<health::GpsOutageBook> book_of(const json& entry) {
  if (!entry.is_object()) return std::nullopt;
  const auto receiver = entry.find("receiver");
  const auto active = entry.find("active");
  const auto last = whole(entry, "last_usable_ns", kLatest_ns);
  const auto count = whole(entry, "count", 0xffffffff);
  const auto longest = whole(entry, "longest_ns", kLongest_ns);
  const auto total = whole(entry, "total_ns", kLongest_ns);
  if (receiver == entry.end() || !receiver->is_string() || active == entry.end() || !active->is_boolean() ||
      !last || !count || !longest || !total)
    return std::nullopt;
  const auto& name = receiver->get_ref<const std::string&>();
  if (name.size() > Name::kCapacity) return std::nullopt;
  return health::GpsOutageBook{
      Name(name), {active->get<bool>(), *last, static_cast<std::uint32_t>(*count), *longest, *total}};
}

}  // namespace

std::vector<health::GpsOutageBook> OutageFile::read(const Name& vehicle) {
  error_.clear();
  std::vector<health::GpsOutageBook> books;
  if (path_.empty()) return books;
  std::error_code absent;
  if (std::filesystem::symlink_status(path_, absent).type() == std::filesystem::file_type::not_found)
    return books;
  const auto fail = [&](const std::string& what) {
    error_ = "GPS outages of before, " + path_ + ": " + what + "; outages are counted anew";
    return std::vector<health::GpsOutageBook>();
  };
  const auto text = read_regular_file(path_, kMostBytes);
  if (!text) return fail(text.error().message);
  const json all = json::parse(text.value(), nullptr, false);
  if (!all.is_object() || !all.contains("vehicle") || !all["vehicle"].is_string() ||
      !all.contains("outages") || !all["outages"].is_array() || all["outages"].size() > kMostBooks)
    return fail("not what the monitor writes there");
  if (all["vehicle"].get_ref<const std::string&>() != vehicle.view()) return fail("of another vehicle");
  for (const json& entry : all["outages"]) {
    const auto book = book_of(entry);
    if (!book) return fail("an entry is not what the monitor writes there");
    books.push_back(*book);
  }
  return books;
}

bool OutageFile::write(const Name& vehicle, const std::vector<health::GpsOutageBook>& books) {
  error_.clear();
  if (path_.empty()) return true;
  json all{{"vehicle", vehicle.str()}, {"outages", json::array()}};
  for (const health::GpsOutageBook& book : books) {
    all["outages"].push_back({{"receiver", book.receiver.str()},
                              {"active", book.record.active},
                              {"last_usable_ns", book.record.last_usable_ns},
                              {"count", book.record.count},
                              {"longest_ns", book.record.longest_ns},
                              {"total_ns", book.record.total_ns}});
  }
  const std::string beside = path_ + ".new";
  std::ofstream file(beside, std::ios::binary | std::ios::trunc);
  file << all.dump() << '\n';
  file.close();
  if (!file || std::rename(beside.c_str(), path_.c_str()) != 0) {
    error_ = "GPS outages, " + path_ + ": cannot be written: " + std::generic_category().message(errno);
    return false;
  }
  return true;
}

}  // namespace fathom::monitor
