#pragma once

#include <string>
#include <vector>

#include "health/gps/gps_outage.hpp"

namespace fathom::monitor {

/// The file of the GPS outages' books, beside the journal. With it a monitor that was killed goes on
/// counting. A rename replaces the file as a whole, so that a reader finds the old file or the new one. The
/// disk is not synchronised each time: the file outlives the process, but after a power cut the books begin
/// again.
class OutageFile {
 public:
  /// `journal_path` + ".outages"; empty: nothing is kept.
  explicit OutageFile(const std::string& journal_path)
      : path_(journal_path.empty() ? std::string() : journal_path + ".outages") {}

  /// Reads and checks the books. Nothing when there is no file. error() says what was wrong with the file.
  [[nodiscard]] std::vector<health::GpsOutageBook> read(const Name& vehicle);
  bool write(const Name& vehicle, const std::vector<health::GpsOutageBook>& books);
  /// Why the last call failed, in one line. Empty when it succeeded.
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  std::string path_;
  std::string error_;
};

}  // namespace fathom::monitor
