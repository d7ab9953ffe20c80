#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes/little_endian.hpp"
#include "base/result.hpp"
#include "base/time.hpp"
#include "record/bytes.hpp"
#include "record/fields.hpp"
#include "record/records.hpp"

namespace fathom::record {

/// Appends values as MCAP writes them: little-endian, text and maps with their length in bytes before them.
class Encoder {
 public:
  explicit Encoder(Bytes& out) : out_(out) {}

  template <std::unsigned_integral T>
  void operator()(const char* /*name*/, const T& value) {
    put(value);
  }
  void operator()(const char* /*name*/, const TimeNs& value) { put(static_cast<std::uint64_t>(value)); }
  void operator()(const char* /*name*/, const std::string& text) { put_text(text); }
  void operator()(const char* /*name*/, const View& bytes) {
    put(static_cast<std::uint64_t>(bytes.size()));
    rest(bytes);
  }
  template <class K, class V>
  void operator()(const char* /*name*/, const std::map<K, V>& map) {
    put_list(map);
  }
  void operator()(const char* /*name*/, const std::vector<std::pair<TimeNs, std::uint64_t>>& list) {
    put_list(list);
  }
  void rest(const View& bytes) { out_.insert(out_.end(), bytes.begin(), bytes.end()); }

 private:
  template <std::unsigned_integral T>
  void put(T value) {
    append_le<T>(out_, value);
  }
  void put(TimeNs value) { put(static_cast<std::uint64_t>(value)); }
  void put_text(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    rest(view_of(text));
  }
  void put(const std::string& text) { put_text(text); }
  template <class List>
  void put_list(const List& list) {
    const std::size_t at = out_.size();
    put(std::uint32_t{0});
    for (const auto& [key, value] : list) {
      put(key);
      put(value);
    }
    store_le<std::uint32_t>(out_, at, static_cast<std::uint32_t>(out_.size() - at - sizeof(std::uint32_t)));
  }

  Bytes& out_;
};

/// Reads them from bytes that may be anybody's. After the first fault every value is left as it was; error()
/// names the field.
class Decoder {
 public:
  explicit Decoder(View bytes) : left_(bytes) {}

  template <std::unsigned_integral T>
  void operator()(const char* name, T& value) {
    number(name, value);
  }
  void operator()(const char* name, TimeNs& value) {
    std::uint64_t raw = 0;
    if (!number(name, raw)) return;
    if (raw > static_cast<std::uint64_t>(std::numeric_limits<TimeNs>::max())) {
      return fail(name, std::to_string(raw) + " ns, expected an instant before the year 2262");
    }
    value = static_cast<TimeNs>(raw);
  }
  void operator()(const char* name, std::string& text) {
    if (const auto bytes = sized<std::uint32_t>(name); ok()) text = text_of(bytes);
  }
  void operator()(const char* name, View& bytes) {
    if (const auto found = sized<std::uint64_t>(name); ok()) bytes = found;
  }
  template <class K, class V>
  void operator()(const char* name, std::map<K, V>& map) {
    const View all = left_after<std::uint32_t>(name);
    while (ok() && left_.size() > all.size()) {
      K key{};
      V value{};
      (*this)(name, key);
      (*this)(name, value);
      if (!ok()) break;
      if (left_.size() < all.size()) return fail(name, "its last entry is longer than the map");
      if (!map.emplace(std::move(key), std::move(value)).second) return fail(name, "a key is there twice");
    }
  }
  void operator()(const char* name, std::vector<std::pair<TimeNs, std::uint64_t>>& list) {
    const View all = left_after<std::uint32_t>(name);
    while (ok() && left_.size() > all.size()) {
      std::pair<TimeNs, std::uint64_t> entry{};
      (*this)(name, entry.first);
      (*this)(name, entry.second);
      if (!ok()) break;
      if (left_.size() < all.size()) return fail(name, "its last entry is longer than the list");
      list.push_back(entry);
    }
  }
  void rest(View& bytes) {
    if (ok()) bytes = std::exchange(left_, View{});
  }

  [[nodiscard]] bool ok() const { return error_.empty(); }
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  template <std::unsigned_integral T>
  bool number(const char* name, T& value) {
    if (!ok()) return false;
    if (left_.size() < sizeof(T)) {
      fail(name,
           "ends after " + std::to_string(left_.size()) + " bytes, expected " + std::to_string(sizeof(T)));
      return false;
    }
    value = load_le<T>(left_, 0);
    left_ = left_.subspan(sizeof(T));
    return true;
  }
  template <std::unsigned_integral Length>
  View sized(const char* name) {
    Length length = 0;
    if (!number(name, length)) return {};
    if (length > left_.size()) {
      fail(name, "says that it has " + std::to_string(length) + " bytes, but only " +
                     std::to_string(left_.size()) + " are left in the record");
      return {};
    }
    const View bytes = left_.first(static_cast<std::size_t>(length));
    left_ = left_.subspan(static_cast<std::size_t>(length));
    return bytes;
  }
  /// Goes into a list: what will be left behind it.
  template <std::unsigned_integral Length>
  View left_after(const char* name) {
    const View bytes = sized<Length>(name);
    const View behind = left_;
    if (ok()) left_ = {bytes.data(), bytes.size() + behind.size()};
    return behind;
  }
  void fail(const char* name, const std::string& what) {
    if (ok()) error_ = std::string(name) + ": " + what;
  }

  View left_;
  std::string error_;
};

/// Appends the record: opcode, length, fields.
template <class Record>
void append(Bytes& out, const Record& record) {
  const std::size_t at = out.size();
  out.resize(at + kRecordHead);
  Encoder encoder(out);
  fields(encoder, record);
  out[at] = static_cast<std::uint8_t>(Record::kOp);
  store_le<std::uint64_t>(out, at + 1, out.size() - at - kRecordHead);
}

/// The record behind the content of one, without opcode and length. Further bytes are left alone, as the
/// specification wants. The error names record and field.
template <class Record>
[[nodiscard]] Result<Record> parse(View content) {
  Record record;
  Decoder decoder(content);
  fields(decoder, record);
  if (!decoder.ok()) return Error{to_string(Record::kOp) + ": " + decoder.error()};
  return record;
}

}  // namespace fathom::record
