#pragma once

#include <functional>
#include <string>

namespace fathom::bus::detail {

/// Keeps Fast DDS from writing to standard output, and keeps its latest error for our own messages.
/// Idempotent.
void capture_dds_log();

/// The latest error of Fast DDS in parentheses with a leading space, for the end of a message. Empty when
/// there was none.
[[nodiscard]] std::string last_dds_error();

/// A listener for every error of Fast DDS in this process. The handler runs on a thread of Fast DDS.
class DdsErrors {
 public:
  explicit DdsErrors(std::function<void(const std::string& message)> handler);
  /// The handler is not running any more when this returns.
  ~DdsErrors();
  DdsErrors(const DdsErrors&) = delete;
  DdsErrors& operator=(const DdsErrors&) = delete;

 private:
  std::function<void(const std::string&)> handler_;
};

}  // namespace fathom::bus::detail
