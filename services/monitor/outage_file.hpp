#pragma once

#include <string>
#include <vector>

#include "health/gps/gps_outage.hpp"

namespace fathom::monitor {

/// The GPS outages' running books beside the journal, so that a monitor that was killed goes on counting.
/// Replaced as a whole by rename: a reader finds the old file or the new one. It is not synchronised each
/// time, a process may die but not the machine; after a power cut everything begins anew.
class OutageFile {
 public:
  /// `journal_path` + ".outages"; empty: nothing is kept.
  explicit OutageFile(const std::string& journal_path)
      : path_(journal_path.empty() ? std::string() : journal_path + ".outages") {}

  /// What is there, checked; nothing where there is no file. error() says what was wrong with one.
  [[nodiscard]] std::vector<health::GpsOutageBook> read(const Name& vehicle);
  bool write(const Name& vehicle, const std::vector<health::GpsOutageBook>& books);
  /// One line, as of the last call that failed; empty when it succeeded.
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  std::string path_;
  std::string error_;
};

}  // namespace fathom::monitor
