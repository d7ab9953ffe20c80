#include "archive/checkpoint.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string_view>

#include <zlib.h>

namespace fathom::archive {
namespace {

constexpr std::string_view kMagic = "FATHOMCP";
constexpr std::uint32_t kFormat = 2;
constexpr std::size_t kHead = kMagic.size() + 2 * sizeof(std::uint32_t);  // magic, format, checksum

std::uint32_t checksum(std::span<const std::byte> bytes) {
  const auto* data = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(crc32_z(crc32_z(0, nullptr, 0), data, bytes.size()));
}

template <class T>
void put(std::vector<std::byte>& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    out.push_back(static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFFU));
  }
}

void put(std::vector<std::byte>& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  for (const char c : text) out.push_back(static_cast<std::byte>(c));
}

/// Parser of what put() wrote. After the bytes have run out, every value is empty.
class Parser {
 public:
  explicit Parser(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  T number() {
    std::uint64_t value = 0;
    const auto from = take(sizeof(T));
    for (std::size_t i = 0; i < from.size(); ++i) value |= std::to_integer<std::uint64_t>(from[i]) << (8 * i);
    return static_cast<T>(value);
  }
  std::string text() {
    const auto from = take(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(from.data()), from.size()};
  }
  std::span<const std::byte> take(std::size_t count) {
    good_ = good_ && count <= bytes_.size();
    if (!good_) return {};
    const auto out = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return out;
  }
  [[nodiscard]] bool at_end() const { return good_ && bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
  bool good_ = true;
};

std::string seconds_text(double seconds) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f s", seconds);
  return text.data();
}

}  // namespace

void encode(const CheckpointLabel& label, std::span<const std::byte> archive, std::vector<std::byte>& out) {
  out.clear();
  for (const char c : kMagic) out.push_back(static_cast<std::byte>(c));
  put(out, kFormat);
  put(out, std::uint32_t{0});  // place of the checksum, which follows from the rest
  put(out, std::string_view(label.vehicle));
  put(out, std::string_view(label.service));
  put(out, std::string_view(label.configuration));
  put(out, std::string_view(label.build));
  put(out, label.stamp_ns);
  put(out, static_cast<std::uint64_t>(archive.size()));
  out.insert(out.end(), archive.begin(), archive.end());
  const std::uint32_t sum = checksum(std::span(out).subspan(kHead));
  for (std::size_t i = 0; i < sizeof sum; ++i) {
    out[kHead - sizeof sum + i] = static_cast<std::byte>(sum >> (8 * i) & 0xFFU);
  }
}

Result<Checkpoint> decode(std::span<const std::byte> bytes) {
  if (bytes.size() < kHead || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0) {
    return Error{"is no checkpoint"};
  }
  Parser head(bytes.subspan(kMagic.size(), kHead - kMagic.size()));
  const auto format = head.number<std::uint32_t>();
  if (format != kFormat) {
    return Error{"is a checkpoint of format " + std::to_string(format) + ", format " +
                 std::to_string(kFormat) + " was expected"};
  }
  if (head.number<std::uint32_t>() != checksum(bytes.subspan(kHead))) {
    return Error{"is damaged: its checksum is wrong"};
  }
  Parser body(bytes.subspan(kHead));
  Checkpoint out;
  out.label.vehicle = body.text();
  out.label.service = body.text();
  out.label.configuration = body.text();
  out.label.build = body.text();
  out.label.stamp_ns = body.number<TimeNs>();
  const auto archive = body.take(body.number<std::uint64_t>());
  if (!body.at_end()) return Error{"is damaged: its lengths do not add up"};
  out.archive.assign(archive.begin(), archive.end());
  return out;
}

std::string objection(const CheckpointLabel& found, const CheckpointLabel& own, double max_age_s) {
  // The clocks of one host agree. A state of the future was saved before the clock was set back.
  constexpr double kTolerated_s = 1.0;
  const auto other = [](const char* what, const std::string& theirs, const std::string& ours) {
    return std::string("is of ") + what + " " + theirs + ", not of " + ours;
  };
  if (found.vehicle != own.vehicle) return other("vehicle", found.vehicle, own.vehicle);
  if (found.service != own.service) return other("service", found.service, own.service);
  if (found.configuration != own.configuration) {
    return other("configuration", found.configuration, own.configuration);
  }
  const double age_s = to_seconds(own.stamp_ns - found.stamp_ns);
  if (age_s < -kTolerated_s) return "is " + seconds_text(-age_s) + " from the future";
  if (age_s > max_age_s) {
    return "is " + seconds_text(age_s) + " old, at most " + seconds_text(max_age_s) + " is gone on from";
  }
  return {};
}

}  // namespace fathom::archive
