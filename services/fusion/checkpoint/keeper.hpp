#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "archive/checkpoint.hpp"
#include "config/fusion/fusion_config.hpp"
#include "runtime/log.hpp"

namespace fathom::fusion {

/// Keeper of the checkpoint: it writes one each period on a thread of its own, and a last one at the end.
/// Navigation never waits for a disk that is slow, full or gone. A failure is logged once, counted, and the
/// next period tries again.
class CheckpointKeeper {
 public:
  struct Counts {
    std::uint64_t written = 0;
    std::uint64_t failed = 0;
    std::string failure;  ///< why the last one could not be written; empty when it was
  };
  /// Fills the stamp and the archive. False when there is nothing to save yet. It is called on the keeper's
  /// thread.
  using Save = std::function<bool(TimeNs& stamp_ns, std::vector<std::byte>& archive)>;

  /// `label` without its stamp.
  CheckpointKeeper(const config::CheckpointConfig& config, archive::CheckpointLabel label, runtime::Log& log,
                   Save save);
  ~CheckpointKeeper();
  CheckpointKeeper(const CheckpointKeeper&) = delete;
  CheckpointKeeper& operator=(const CheckpointKeeper&) = delete;

  [[nodiscard]] Counts counts() const;

 private:
  void run();
  void write();

  config::CheckpointConfig config_;
  archive::CheckpointLabel label_;
  runtime::Log& log_;
  Save save_;
  std::vector<std::byte> archive_;  // of the keeper's thread; the capacity is kept
  std::vector<std::byte> file_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;
  Counts counts_;
  std::thread thread_;  ///< last: it uses everything above
};

}  // namespace fathom::fusion
