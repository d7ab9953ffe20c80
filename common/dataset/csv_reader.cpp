#include "dataset/csv_reader.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <system_error>

#include <zlib.h>

#include "base/unknown.hpp"
#include "dataset/dataset.hpp"
#include "dataset/powers_of_ten.hpp"

namespace fathom::dataset {
namespace {

// A row of the widest file has under 500 bytes; what exceeds this is not one of our files.
constexpr std::size_t kLongestLine = 65'536;

std::string_view trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// What std::from_chars makes of "-123.456", several times faster: a whole number and a power of ten that a
// double holds exactly give the nearest double by one division. False, and nothing is said, for what is
// written otherwise or has more digits.
bool quick_number(std::string_view field, double& value) {
  constexpr std::size_t kMostDigits = 18;
  constexpr std::uint64_t kMostExact = 1ULL << 53U;
  const bool negative = field.front() == '-';
  if (negative) field.remove_prefix(1);
  if (field.size() > kMostDigits + 1) return false;
  std::uint64_t digits = 0;
  std::size_t before = 0;
  for (; before < field.size() && field[before] >= '0' && field[before] <= '9'; ++before)
    digits = 10 * digits + static_cast<std::uint64_t>(field[before] - '0');
  if (before == 0) return false;
  std::size_t behind = 0;
  if (before < field.size()) {
    if (field[before] != '.') return false;
    for (std::size_t i = before + 1; i < field.size(); ++i, ++behind) {
      if (field[i] < '0' || field[i] > '9') return false;
      digits = 10 * digits + static_cast<std::uint64_t>(field[i] - '0');
    }
    if (behind == 0) return false;
  }
  if (digits > kMostExact) return false;
  const double magnitude = static_cast<double>(digits) / kPowersOfTen[behind];
  value = negative ? -magnitude : magnitude;
  return true;
}

// Field text in a message: short and printable whatever the file holds.
std::string quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (text.size() > 40 ? "...'" : "'");
}

constexpr const char* kTruncated =
    "gzip data end too early: the file is truncated, expected a complete .gz file";
constexpr const char* kOldLineEnds = "lines end with a carriage return alone, expected a line feed, or both";

// The names of a header for people, as many as help.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 20;
  std::string out;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
    out += (i == 0 ? "" : ", ") + quoted(std::string_view(names[i]));
  return out + (names.size() > kMost ? ", ..." : "");
}

std::string number_of_fields(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " field" : " fields");
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

bool is_number(const std::string& field) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc() && end == field.data() + field.size();
}

// What stands in place of a header, where that can be seen; empty where names are missing, no more.
std::string what_the_header_is(const std::vector<std::string>& names) {
  const std::string& first = names.front();
  if (first.starts_with("\xFF\xFE") || first.starts_with("\xFE\xFF")) return "the text is UTF-16, not UTF-8";
  if (is_comment(first)) return "the line is a comment";
  for (const auto& [separator, word] : {std::pair{';', "semicolons"}, {'\t', "tabs"}, {'|', "bars"}}) {
    if (names.size() == 1 && first.find(separator) != std::string::npos)
      return std::string("columns are separated by ") + word +
             ", not by commas (and numbers need a decimal point)";
  }
  if (first.starts_with('"')) return "the names stand in quotation marks";
  if (std::all_of(names.begin(), names.end(), is_number)) return "the line holds numbers and no names";
  return "";
}

}  // namespace

// Bytes of the file, decompressed where needed: of every member of a gzip file. zlib's own reader of files
// leaves out, without a word, whatever follows a member and does not begin as one.
class CsvReader::Source {
 public:
  explicit Source(const std::filesystem::path& path) : file_(std::fopen(path.c_str(), "rbe")) {
    if (file_ == nullptr) throw DatasetError(path.string() + ": cannot be opened: " + std::strerror(errno));
    std::error_code unknown;
    file_bytes_ = static_cast<double>(std::filesystem::file_size(path, unknown));  // huge where unknown
    refill();
    plain_ = !begins_member();
    if (!plain_ && inflateInit2(&stream_, kGzip) != Z_OK)
      throw DatasetError(path.string() + ": no memory to unpack it");
  }
  ~Source() {
    inflateEnd(&stream_);
    std::fclose(file_);
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  // The next chunk of bytes, empty at the end of the file; an error text as well when the file is damaged.
  std::string_view read(const char*& error) {
    stream_.next_out = reinterpret_cast<Bytef*>(buffer_.data());
    stream_.avail_out = static_cast<uInt>(buffer_.size());
    while (stream_.avail_out > 0 && error == nullptr) {
      if (stream_.avail_in == 0) refill();
      if (error_number_ != 0) {
        error_text_ = std::string("cannot be read: ") + std::strerror(error_number_);
        error = error_text_.c_str();
      } else if (stream_.avail_in == 0) {
        if (within_) error = kTruncated;
        break;
      } else if (plain_) {
        copy();
      } else {
        unpack(error);
      }
    }
    const std::size_t count = buffer_.size() - stream_.avail_out;
    output_bytes_ += static_cast<double>(count);
    return {buffer_.data(), count};
  }
  [[nodiscard]] bool plain() const { return plain_; }
  /// How much of the file became lines, from 0 to 1: about 0 where its length is not known.
  [[nodiscard]] double part_read() const {
    const double taken = input_bytes_ - stream_.avail_in;
    const double waits = static_cast<double>(pending.size()) / std::max(1.0, output_bytes_);
    return std::clamp(taken * (1.0 - waits) / std::max(1.0, file_bytes_), 0.0, 1.0);
  }

  std::string_view pending;      // read, not yet split into lines
  const char* damage = nullptr;  // found behind `pending`

 private:
  static constexpr int kGzip = MAX_WBITS + 16;

  /// Behind what is left of the input.
  void refill() {
    if (stream_.avail_in > 0) std::memmove(input_.data(), stream_.next_in, stream_.avail_in);
    const std::size_t left = stream_.avail_in;
    const std::size_t got = std::fread(input_.data() + left, 1, input_.size() - left, file_);
    if (std::ferror(file_) != 0) error_number_ = errno;
    input_bytes_ += static_cast<double>(got);
    stream_.next_in = input_.data();
    stream_.avail_in = static_cast<uInt>(left + got);
  }
  [[nodiscard]] bool begins_member() const {
    return stream_.avail_in >= 2 && stream_.next_in[0] == 0x1F && stream_.next_in[1] == 0x8B;
  }
  void copy() {
    const uInt count = std::min(stream_.avail_in, stream_.avail_out);
    std::memcpy(stream_.next_out, stream_.next_in, count);
    stream_.next_out += count;
    stream_.avail_out -= count;
    stream_.next_in += count;
    stream_.avail_in -= count;
  }
  void unpack(const char*& error) {
    if (!within_ && !begin_member(error)) return;
    const int code = inflate(&stream_, Z_NO_FLUSH);
    if (code == Z_STREAM_END) {
      within_ = false;
    } else if (code != Z_OK && code != Z_BUF_ERROR) {
      error = "gzip data are damaged, expected an intact .gz file";
    }
  }
  /// False at padding, and at bytes that begin no member.
  bool begin_member(const char*& error) {
    if (stream_.avail_in < 2) refill();
    if (begins_member()) {
      within_ = inflateReset(&stream_) == Z_OK;
      return within_;
    }
    const bool is_padding = *stream_.next_in == 0;  // of tapes and of blocks
    ++stream_.next_in;
    --stream_.avail_in;
    if (!is_padding)
      error = "gzip data are damaged: bytes follow that begin no gzip data, expected an intact .gz file";
    return false;
  }

  std::FILE* file_;
  double file_bytes_ = 0.0;
  double input_bytes_ = 0.0;
  double output_bytes_ = 0.0;
  int error_number_ = 0;
  bool plain_ = true;
  bool within_ = false;  ///< a member
  z_stream stream_{};
  std::string error_text_;
  std::array<Bytef, 1U << 17U> input_{};
  std::array<char, 1U << 16U> buffer_{};
};

CsvReader::CsvReader(const std::filesystem::path& path, LostEnd policy)
    : file_(path.string()), policy_(policy), source_(std::make_unique<Source>(path)) {
  if (path.extension() == ".gz" && source_->plain()) {
    throw DatasetError(file_ + ": is not gzip data, expected a .gz file");
  }
  if (!next_line()) throw DatasetError(file_ + ": is empty, expected a header line with column names");
  if (line_.starts_with("\xEF\xBB\xBF")) line_.erase(0, 3);
  if (trim(line_).find('\r') != std::string_view::npos && line_.find('\0') == std::string::npos)
    fail(kOldLineEnds);
  split();
  for (const std::string_view name : fields_) {
    if (std::find(names_.begin(), names_.end(), name) != names_.end()) {
      fail("column " + quoted(name) + " appears twice, expected each once");
    }
    names_.emplace_back(name);
  }
}

CsvReader::~CsvReader() = default;

double CsvReader::part_read() const {
  return source_->part_read();
}

bool CsvReader::next_line() {
  line_.clear();
  line_ended_ = false;
  ++line_number_;
  bool any = false;
  while (true) {
    if (source_->pending.empty()) {
      if (source_->damage == nullptr) source_->pending = source_->read(source_->damage);
      if (source_->pending.empty()) {
        if (source_->damage == nullptr) return any;
        if (source_->damage == kTruncated && !names_.empty()) return leave_out(kTruncated);
        fail(source_->damage);
      }
    }
    any = true;
    const auto end = source_->pending.find('\n');
    add_to_line(source_->pending.substr(0, end), end != std::string_view::npos);
    if (line_.size() > kLongestLine) {
      fail(line_.find('\r') < kLongestLine ? kOldLineEnds
                                           : "line is longer than 65536 bytes, expected a row of numbers");
    }
    if (end != std::string_view::npos) {
      source_->pending.remove_prefix(end + 1);
      line_ended_ = true;
      return true;
    }
    source_->pending = {};
  }
}

void CsvReader::add_to_line(std::string_view text, bool ends_it) {
  if (ends_it || text.find('\0') == std::string_view::npos) {
    line_.append(text);
    return;
  }
  // A file whose end was lost with the power may end in many zero bytes. One stands for all.
  for (const char c : text) {
    if (c != '\0' || !line_.ends_with('\0')) line_ += c;
  }
}

std::string CsvReader::lost_in_row() const {
  if (line_ended_) return "";
  if (line_.find('\0') != std::string::npos) return "the file ends in zero bytes, expected rows";
  if (fields_.size() >= names_.size()) return "";
  return "row has " + number_of_fields(fields_.size()) + ", expected " + std::to_string(names_.size()) +
         ", and no line end: the file was cut there";
}

bool CsvReader::leave_out(const std::string& what) {
  if (policy_ == LostEnd::refused) fail(what);
  lost_end_ = std::to_string(line_number_) + ": " + what;
  return false;
}

void CsvReader::split() {
  fields_.clear();
  const std::string_view line = line_;
  std::size_t begin = 0;
  while (true) {
    const auto comma = line.find(',', begin);
    fields_.push_back(trim(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) return;
    begin = comma + 1;
  }
}

bool CsvReader::next() {
  if (!next_line()) return false;
  if (trim(line_).empty()) {
    // Blank lines may end a file, not interrupt it.
    const std::size_t blank = line_number_;
    while (next_line()) {
      if (trim(line_).empty()) continue;
      line_number_ = blank;
      fail("line is blank, expected a row of " + std::to_string(names_.size()) + " fields");
    }
    return false;
  }
  split();
  if (policy_ == LostEnd::left_out) {
    if (const std::string lost = lost_in_row(); !lost.empty()) return leave_out(lost);
  }
  if (fields_.size() != names_.size()) fail_width();
  return true;
}

void CsvReader::fail_width() const {
  const std::string expected = "expected " + std::to_string(names_.size()) + " fields as in the header";
  if (is_comment(line_)) fail("row is a comment, " + expected);
  if (line_.find('\0') != std::string::npos)
    fail("row holds zero bytes, as a file does whose end was lost with the power, " + expected +
         "; delete it and what follows to use the rows before");
  const bool cut = !line_ended_ && fields_.size() < names_.size();
  fail(
      "row has " + number_of_fields(fields_.size()) + ", " + expected +
      (cut ? "; it ends the file and has no line end, so it was cut: delete it to use the rows before" : ""));
}

void CsvReader::require(const std::vector<std::string>& names) const {
  std::string missing;
  std::size_t count = 0;
  for (const std::string& name : names) {
    if (optional_column(name)) continue;
    missing += (count++ == 0 ? "'" : ", '") + name + "'";
  }
  if (count == 0) return;
  const std::string why = what_the_header_is(names_);
  throw DatasetError(file_ + ":1: " +
                     (why.empty() ? "column" + std::string(count == 1 ? " " : "s ") + missing +
                                        (count == 1 ? " is" : " are") +
                                        " missing from the header, which has " + listed(names_)
                                  : why + ", expected a header with " + missing));
}

CsvReader::Column CsvReader::column(std::string_view name) const {
  const auto found = optional_column(name);
  if (!found) require({std::string(name)});
  return *found;
}

std::optional<CsvReader::Column> CsvReader::optional_column(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) return std::nullopt;
  return static_cast<Column>(found - names_.begin());
}

double CsvReader::number(Column column) const {
  std::string_view field = fields_[column];
  if (field.empty()) return kUnknown;
  double value = kUnknown;
  if (quick_number(field, value)) return value;
  if (field.front() == '+') field.remove_prefix(1);
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error == std::errc::result_out_of_range || error == std::errc::invalid_argument ||
      end != field.data() + field.size()) {
    fail("column " + std::string(names_[column]) + ": " + quoted(fields_[column]) +
         " is not a number, expected a decimal number or blank for unknown");
  }
  return value;
}

double CsvReader::number(const std::optional<Column>& column) const {
  return column ? number(*column) : kUnknown;
}

void CsvReader::fail(const std::string& message) const {
  throw DatasetError(file_ + ":" + std::to_string(line_number_) + ": " + message);
}

}  // namespace fathom::dataset
