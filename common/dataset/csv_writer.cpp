#include "dataset/csv_writer.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include <zlib.h>

#include "base/unknown.hpp"
#include "dataset/dataset.hpp"
#include "dataset/powers_of_ten.hpp"

namespace fathom::dataset {
namespace {

constexpr std::size_t kFlushBytes = 1U << 16U;

/// Below it the product of a double and a power of ten is off by 2^-10 at most.
constexpr double kMostScaled = 0x1p44;
/// How near to a half that product must not be for the rounding of it to be sure.
constexpr double kDoubtful = 0x1p-8;

/// The longest field that fixed() writes the quick way: what is copied of it, whatever its length.
constexpr std::size_t kQuickBytes = 32;
/// The largest double has 309 digits before the point, and fixed() writes some behind it.
constexpr std::size_t kLongestNumber = 400;

/// The two digits of every whole number below a hundred, one pair after the other.
constexpr std::array<char, 200> kPairs = [] {
  std::array<char, 200> pairs{};
  for (std::size_t i = 0; i < pairs.size(); ++i)
    pairs[i] = static_cast<char>('0' + (i % 2 == 0 ? i / 20 : i / 2 % 10));
  return pairs;
}();

/// Writes a whole number of so many digits, leading zeros among them: in parts that do not wait for each
/// other.
template <int kCount>
void put_digits(char* at, std::uint64_t value) {
  if constexpr (kCount == 1) {
    *at = static_cast<char>('0' + value);
  } else if constexpr (kCount == 2) {
    std::memcpy(at, &kPairs[2 * value], 2);
  } else {
    constexpr int kLow = kCount > 8 ? 8 : kCount > 4 ? 4 : 2;
    constexpr std::uint64_t kPower = kLow == 8 ? 100'000'000 : kLow == 4 ? 10'000 : 100;
    put_digits<kCount - kLow>(at, value / kPower);
    put_digits<kLow>(at + kCount - kLow, value % kPower);
  }
}

/// Writes a whole number before `end`, without leading zeros; returns where it begins.
char* whole_before(char* end, std::uint64_t value) {
  for (; value >= 100; value /= 100) put_digits<2>(end -= 2, value % 100);
  if (value < 10) {
    put_digits<1>(--end, value);
  } else {
    put_digits<2>(end -= 2, value);
  }
  return end;
}

/// What std::to_chars writes with a fixed count of decimals, several times faster: one product, rounded to a
/// whole number. Written before `end`, returns where it begins; `end` where the product's own rounding might
/// have decided.
template <int kDecimals>
char* quick_fixed_of(double value, char* end) {
  constexpr auto kPower = static_cast<std::uint64_t>(kPowersOfTen[kDecimals]);
  const double scaled = std::abs(value) * kPowersOfTen[kDecimals];
  if (!(scaled < kMostScaled)) return end;
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): what is in doubt is sent back below
  const auto whole = static_cast<std::int64_t>(scaled + 0.5);
  const double off = std::abs(scaled - static_cast<double>(whole));
  if (off > 0.5 - kDoubtful) return end;
  const auto rounded = static_cast<std::uint64_t>(whole);
  char* at = end - kDecimals;
  put_digits<kDecimals>(at, rounded % kPower);
  *--at = '.';
  at = whole_before(at, rounded / kPower);
  if (std::signbit(value)) *--at = '-';
  return at;
}

/// The same for a count that is given when it runs; `end` where it is none of those that are compiled.
char* quick_fixed(double value, int decimals, char* end) {
  constexpr int kMostDecimals = 12;
  constexpr auto kOf = []<int... kLess>(std::integer_sequence<int, kLess...>) {
    return std::array{&quick_fixed_of<kLess + 1>...};
  }
  (std::make_integer_sequence<int, kMostDecimals>());
  return decimals < 1 || decimals > kMostDecimals ? end
                                                  : kOf[static_cast<std::size_t>(decimals - 1)](value, end);
}

}  // namespace

CsvWriter::CsvWriter(const std::filesystem::path& path)
    : file_(path.string()),
      out_(gzopen(path.c_str(), path.extension() == ".gz" ? "wb6" : "wbT")),
      pending_(2 * kFlushBytes) {
  if (out_ == nullptr) throw WriteError(file_ + ": cannot be written: " + std::strerror(errno));
}

CsvWriter::~CsvWriter() {
  if (out_ == nullptr) return;
  gzwrite(out_, pending_.data(), static_cast<unsigned>(used_));
  gzclose_w(out_);
}

char* CsvWriter::room(std::size_t most) {
  if (pending_.size() - used_ < most) pending_.resize(pending_.size() + most + kFlushBytes);
  return pending_.data() + used_;
}

char* CsvWriter::field(std::size_t most) {
  char* const at = room(most + 1);
  const bool first = !row_started_;
  row_started_ = true;
  if (first) return at;
  *at = ',';
  ++used_;
  return at + 1;
}

CsvWriter& CsvWriter::number(double value) {
  char* const at = field(kLongestNumber);
  if (!known(value)) return *this;
  used_ += static_cast<std::size_t>(std::to_chars(at, at + kLongestNumber, value).ptr - at);
  return *this;
}

CsvWriter& CsvWriter::fixed(double value, int decimals) {
  char* const at = field(kLongestNumber);
  if (!known(value)) return *this;
  std::array<char, 2 * kQuickBytes> quick{};
  char* const end = quick.data() + kQuickBytes;
  if (const char* const begin = quick_fixed(value, decimals, end); begin != end) {
    std::memcpy(at, begin, kQuickBytes);  // a length that is known costs less than the right one
    used_ += static_cast<std::size_t>(end - begin);
    return *this;
  }
  const auto result = std::to_chars(at, at + kLongestNumber, value, std::chars_format::fixed, decimals);
  used_ += static_cast<std::size_t>(result.ptr - at);
  return *this;
}

CsvWriter& CsvWriter::seconds(DurationNs duration) {
  char* const at = field(kLongestNumber);
  const bool negative = duration < 0;
  const std::uint64_t magnitude =
      negative ? 0 - static_cast<std::uint64_t>(duration) : static_cast<std::uint64_t>(duration);
  constexpr std::uint64_t kPerSecond = kNsPerSecond;
  std::array<char, 32> digits;
  char* const end = digits.data() + digits.size();
  constexpr int kDecimals = 9;
  constexpr int kLeastDecimals = 2;
  char* begin = end - kDecimals;
  put_digits<kDecimals>(begin, magnitude % kPerSecond);
  const char* const least = begin + kLeastDecimals;
  *--begin = '.';
  begin = whole_before(begin, magnitude / kPerSecond);
  if (negative) *--begin = '-';
  const char* last = end;
  while (last > least && *(last - 1) == '0') --last;
  used_ += static_cast<std::size_t>(std::copy(static_cast<const char*>(begin), last, at) - at);
  return *this;
}

CsvWriter& CsvWriter::text(std::string_view word) {
  std::copy(word.begin(), word.end(), field(word.size()));
  used_ += word.size();
  return *this;
}

void CsvWriter::end_row() {
  *room(1) = '\n';
  ++used_;
  row_started_ = false;
  if (used_ >= kFlushBytes) flush();
}

void CsvWriter::line(std::string_view text) {
  std::copy(text.begin(), text.end(), room(text.size()));
  used_ += text.size();
  end_row();
}

void CsvWriter::flush() {
  if (used_ == 0) return;
  if (gzwrite(out_, pending_.data(), static_cast<unsigned>(used_)) <= 0) {
    throw WriteError(file_ + ": cannot be written: " + std::strerror(errno));
  }
  used_ = 0;
}

void CsvWriter::close() {
  flush();
  gzFile_s* out = out_;
  out_ = nullptr;
  if (gzclose_w(out) != Z_OK) throw WriteError(file_ + ": cannot be written: " + std::strerror(errno));
}

}  // namespace fathom::dataset
