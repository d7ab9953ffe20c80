#include "fusion/checkpoint/keeper.hpp"

#include <chrono>
#include <utility>

#include "fusion/checkpoint/file.hpp"
#include "fusion/checkpoint/start.hpp"

namespace fathom::fusion {

CheckpointKeeper::CheckpointKeeper(const config::CheckpointConfig& config, archive::CheckpointLabel label,
                                   runtime::Log& log, Save save)
    : config_(config), label_(std::move(label)), log_(log), save_(std::move(save)), thread_([this] {
        run();
      }) {}

CheckpointKeeper::~CheckpointKeeper() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

CheckpointKeeper::Counts CheckpointKeeper::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

void CheckpointKeeper::run() {
  const std::chrono::duration<double> period(config_.period_s);
  for (bool last = false; !last;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, period, [this] { return stop_; });
      last = stop_;
    }
    write();
  }
}

void CheckpointKeeper::write() {
  archive_.clear();
  if (!save_(label_.stamp_ns, archive_)) return;
  encode(label_, archive_, file_);
  const std::string failure = replace_file(config_.path, file_, config_.sync);
  if (failure.empty()) forget_trial(config_.path);
  bool news = false;
  {
    const std::lock_guard lock(mutex_);
    ++(failure.empty() ? counts_.written : counts_.failed);
    news = failure.empty() != counts_.failure.empty();
    counts_.failure = failure;
  }
  if (!news) return;
  if (failure.empty()) {
    log_.info("checkpoints are written again");
  } else {
    log_.warning("checkpoint " + failure);
  }
}

}  // namespace fathom::fusion
