#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::dataset {

/// Reads a comma-separated file with a header line, plain or gzip, row by row in constant memory. Every fault
/// throws DatasetError with file and line. Carriage returns, a byte order mark, blanks around fields and
/// empty lines at the end are forgiven; a row with too few or too many fields is not.
class CsvReader {
 public:
  /// Position of a column in the file.
  using Column = std::size_t;

  /// What becomes of a file whose end was lost with the power, with the disk's room or on the way: its last
  /// row has no line end and too few fields, it ends in zero bytes, or its gzip data stop.
  enum class LostEnd : std::uint8_t {
    refused,
    left_out,  ///< next() ends with the last whole row, lost_end() says why
  };

  /// Opens `path` and reads the header line.
  explicit CsvReader(const std::filesystem::path& path, LostEnd policy = LostEnd::refused);
  ~CsvReader();
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  /// Throws when the header does not name all of them: says which, and what the file may be instead.
  void require(const std::vector<std::string>& names) const;
  /// Throws when the header does not name it.
  [[nodiscard]] Column column(std::string_view name) const;
  [[nodiscard]] std::optional<Column> optional_column(std::string_view name) const;

  /// Advances to the next row; false at the end of the file.
  [[nodiscard]] bool next();

  /// The field of the present row as a number; unknown when blank, absent or "nan".
  [[nodiscard]] double number(Column column) const;
  [[nodiscard]] double number(const std::optional<Column>& column) const;
  [[nodiscard]] std::string_view text(Column column) const { return fields_[column]; }
  [[nodiscard]] std::string_view name(Column column) const { return names_[column]; }
  [[nodiscard]] std::size_t columns() const { return names_.size(); }

  /// About how much of the file has been read, from 0 to 1; about 0 where its length is not known.
  [[nodiscard]] double part_read() const;

  /// "LINE: what is missing of the file from there on"; empty where nothing is, or as long as rows come.
  [[nodiscard]] const std::string& lost_end() const { return lost_end_; }

  /// Throws DatasetError about the present line.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  class Source;

  [[nodiscard]] bool next_line();
  void split();
  void add_to_line(std::string_view text, bool ends_it);
  /// What was lost of the file's end in this row; empty where nothing was.
  [[nodiscard]] std::string lost_in_row() const;
  /// False: no row comes any more. Throws where what is lost is refused.
  bool leave_out(const std::string& what);
  [[noreturn]] void fail_width() const;

  std::string file_;
  LostEnd policy_;
  std::string lost_end_;
  std::unique_ptr<Source> source_;
  std::size_t line_number_ = 0;
  std::string line_;
  bool line_ended_ = false;
  std::vector<std::string> names_;
  std::vector<std::string_view> fields_;  // into line_
};

}  // namespace fathom::dataset
