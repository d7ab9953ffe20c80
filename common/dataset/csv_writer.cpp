#include "dataset/csv_writer.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <zlib.h>

#include "base/unknown.hpp"
#include "dataset/dataset.hpp"

namespace fathom::dataset {
namespace {

constexpr std::size_t kFlushBytes = 1U << 16U;

constexpr std::array<double, 13> kPowersOfTen{1e0, 1e1, 1e2, 1e3,  1e4,  1e5, 1e6,
                                              1e7, 1e8, 1e9, 1e10, 1e11, 1e12};
/// Below it the product of a double and a power of ten is off by 2^-10 at most.
constexpr double kMostScaled = 0x1p44;
/// How near to a half that product must not be for the rounding of it to be sure.
constexpr double kDoubtful = 0x1p-8;

/// Of a whole number, at least `least` digits; returns the end.
char* write_digits(std::uint64_t value, std::size_t least, char* out) {
  std::array<char, 24> digits;
  const char* end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  const auto count = static_cast<std::size_t>(end - digits.data());
  for (std::size_t i = count; i < least; ++i) *out++ = '0';
  return std::copy_n(digits.data(), count, out);
}

/// What std::to_chars writes with a fixed count of decimals, several times faster: one product, rounded to a
/// whole number. Nothing where the product's own rounding might have decided.
std::size_t quick_fixed(double value, int decimals, std::array<char, 32>& out) {
  if (decimals < 1 || decimals >= static_cast<int>(kPowersOfTen.size())) return 0;
  const double scaled = std::abs(value) * kPowersOfTen[static_cast<std::size_t>(decimals)];
  if (!(scaled < kMostScaled)) return 0;
  const auto rounded = static_cast<std::uint64_t>(scaled + 0.5);
  const double off = std::abs(scaled - static_cast<double>(rounded));
  if (off > 0.5 - kDoubtful) return 0;
  char* at = out.data();
  if (std::signbit(value)) *at++ = '-';
  // One digit before the point at least; then the decimals move up by one place.
  at = write_digits(rounded, static_cast<std::size_t>(decimals) + 1, at);
  std::copy_backward(at - decimals, at, at + 1);
  *(at - decimals) = '.';
  return static_cast<std::size_t>(at + 1 - out.data());
}

}  // namespace

CsvWriter::CsvWriter(const std::filesystem::path& path)
    : file_(path.string()), out_(gzopen(path.c_str(), path.extension() == ".gz" ? "wb6" : "wbT")) {
  if (out_ == nullptr) throw DatasetError(file_ + ": cannot be written: " + std::strerror(errno));
}

CsvWriter::~CsvWriter() {
  if (out_ == nullptr) return;
  gzwrite(out_, pending_.data(), static_cast<unsigned>(pending_.size()));
  gzclose_w(out_);
}

void CsvWriter::separate() {
  if (row_started_) pending_ += ',';
  row_started_ = true;
}

CsvWriter& CsvWriter::number(double value) {
  separate();
  if (!known(value)) return *this;
  std::array<char, 40> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  pending_.append(digits.data(), result.ptr);
  return *this;
}

CsvWriter& CsvWriter::fixed(double value, int decimals) {
  separate();
  if (!known(value)) return *this;
  std::array<char, 32> quick;
  if (const std::size_t length = quick_fixed(value, decimals, quick); length > 0) {
    pending_.append(quick.data(), length);
    return *this;
  }
  std::array<char, 400> digits{};  // the largest double has 309 digits before the point
  const auto result =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, decimals);
  pending_.append(digits.data(), result.ptr);
  return *this;
}

CsvWriter& CsvWriter::seconds(DurationNs duration) {
  separate();
  const bool negative = duration < 0;
  const std::uint64_t magnitude =
      negative ? 0 - static_cast<std::uint64_t>(duration) : static_cast<std::uint64_t>(duration);
  constexpr std::uint64_t kPerSecond = kNsPerSecond;
  std::array<char, 40> digits;
  char* at = digits.data();
  if (negative) *at++ = '-';
  at = write_digits(magnitude / kPerSecond, 1, at);
  *at++ = '.';
  const char* const least = at + 2;
  at = write_digits(magnitude % kPerSecond, 9, at);
  while (at > least && *(at - 1) == '0') --at;
  pending_.append(digits.data(), at);
  return *this;
}

CsvWriter& CsvWriter::text(std::string_view word) {
  separate();
  pending_ += word;
  return *this;
}

void CsvWriter::end_row() {
  pending_ += '\n';
  row_started_ = false;
  if (pending_.size() >= kFlushBytes) flush();
}

void CsvWriter::line(std::string_view text) {
  pending_ += text;
  end_row();
}

void CsvWriter::flush() {
  if (pending_.empty()) return;
  if (gzwrite(out_, pending_.data(), static_cast<unsigned>(pending_.size())) <= 0) {
    throw DatasetError(file_ + ": cannot be written: " + std::strerror(errno));
  }
  pending_.clear();
}

void CsvWriter::close() {
  flush();
  gzFile_s* out = out_;
  out_ = nullptr;
  if (gzclose_w(out) != Z_OK) throw DatasetError(file_ + ": cannot be written: " + std::strerror(errno));
}

}  // namespace fathom::dataset
