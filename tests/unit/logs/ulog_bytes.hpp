#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace fathom::test {

/// Writes ULog files by hand.
class UlogBytes {
 public:
  UlogBytes() {
    bytes_ = {0x55, 0x4C, 0x6F, 0x67, 0x01, 0x12, 0x35, 0x01};
    put(std::uint64_t{112'000'000});
  }
  template <class T>
  UlogBytes& put(T value) {
    const auto* raw = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), raw, raw + sizeof value);
    return *this;
  }
  UlogBytes& raw(const std::string& text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return *this;
  }
  UlogBytes& message(char type, const std::string& payload) {
    put(static_cast<std::uint16_t>(payload.size()));
    put(type);
    return raw(payload);
  }
  UlogBytes& format(const std::string& text) { return message('F', text); }
  UlogBytes& subscribe(std::uint16_t id, std::uint8_t instance, const std::string& topic) {
    return message('A', pack(instance) + pack(id) + topic);
  }
  UlogBytes& data(std::uint16_t id, const std::string& content) { return message('D', pack(id) + content); }
  UlogBytes& key(char type, const std::string& key, const std::string& value) {
    return message(type, pack(static_cast<std::uint8_t>(key.size())) + key + value);
  }
  UlogBytes& sync() { return message('S', std::string("\x2F\x73\x13\x20\x25\x0C\xBB\x12", 8)); }
  /// Flags with the offsets of appended data; the place of the first offset is returned.
  std::size_t flags(std::uint8_t incompatible, std::uint64_t first = 0, std::uint64_t second = 0) {
    std::string payload(40, '\0');
    payload[8] = static_cast<char>(incompatible);
    std::memcpy(&payload[16], &first, 8);
    std::memcpy(&payload[24], &second, 8);
    message('B', payload);
    return bytes_.size() - 24;
  }

  template <class T>
  [[nodiscard]] static std::string pack(T value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
  }
  [[nodiscard]] std::vector<std::uint8_t>& bytes() { return bytes_; }
  void write(const std::filesystem::path& path) const {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes_.data()), static_cast<std::streamsize>(bytes_.size()));
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace fathom::test
