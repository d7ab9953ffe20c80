#pragma once

#include <cstddef>
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

  /// Opens `path` and reads the header line.
  explicit CsvReader(const std::filesystem::path& path);
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

  /// Throws DatasetError about the present line.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  class Source;

  [[nodiscard]] bool next_line();
  void split();
  [[noreturn]] void fail_width() const;

  std::string file_;
  std::unique_ptr<Source> source_;
  std::size_t line_number_ = 0;
  std::string line_;
  bool line_ended_ = false;
  std::vector<std::string> names_;
  std::vector<std::string_view> fields_;  // into line_
};

}  // namespace fathom::dataset
