#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.hpp"

struct gzFile_s;

namespace fathom::dataset {

/// Writes a comma-separated file, plain or gzip, field by field. Faults throw WriteError. The same calls
/// give the same bytes.
class CsvWriter {
 public:
  /// Creates or replaces `path`; a name that ends in ".gz" is compressed.
  explicit CsvWriter(const std::filesystem::path& path);
  /// Closes without reporting faults; call close() where they matter.
  ~CsvWriter();
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  /// The shortest decimal that reads back as the same value; unknown is left blank.
  CsvWriter& number(double value);
  /// With a fixed count of decimals; unknown is left blank.
  CsvWriter& fixed(double value, int decimals);
  /// Exact seconds, at most nine decimals.
  CsvWriter& seconds(DurationNs duration);
  CsvWriter& text(std::string_view word);
  void end_row();
  /// Whole line, e.g. the header.
  void line(std::string_view text);

  void close();

 private:
  /// Where the next byte goes, with room for `most`.
  char* room(std::size_t most);
  /// Where the next field goes, its comma written.
  char* field(std::size_t most);
  void flush();

  std::string file_;
  gzFile_s* out_;
  std::vector<char> pending_;  ///< the first `used_` of them are not written yet
  std::size_t used_ = 0;
  bool row_started_ = false;
};

}  // namespace fathom::dataset
