#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace fathom::cli {

/// Lets another thread do `work` on each item, in their order, while whoever gives them goes on. What work
/// throws ends it, and comes out of each give() and finish() from then on. For one giver.
template <class T>
class Relay {
  static constexpr std::size_t kBlock = 512;
  static constexpr std::size_t kMostBlocks = 2;

 public:
  /// Items given and not done: of the blocks that wait, the one at work and the giver's own.
  static constexpr std::size_t kMostBehind = (kMostBlocks + 2) * kBlock;
  explicit Relay(std::function<void(const T&)> work) : work_(std::move(work)), thread_([this] { run(); }) {}
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;
  /// What has been given and not begun is left undone, unless finish() was called.
  ~Relay() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
      blocks_.clear();
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  /// Waits while the work is many items behind.
  void give(const T& item) {
    given_.push_back(item);
    if (given_.size() >= kBlock) pass_on();
  }
  /// Returns when all work has been done.
  void finish() {
    pass_on();
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  using Block = std::vector<T>;

  void pass_on() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return blocks_.size() < kMostBlocks || failure_; });
    if (failure_) std::rethrow_exception(failure_);
    blocks_.push_back(std::move(given_));
    given_.clear();
    if (!spare_.empty()) {
      given_ = std::move(spare_.back());
      spare_.pop_back();
    }
    lock.unlock();
    changed_.notify_all();
  }

  void run() {
    while (true) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return !blocks_.empty() || ending_; });
      if (blocks_.empty()) return;
      Block block = std::move(blocks_.front());
      blocks_.pop_front();
      lock.unlock();
      changed_.notify_all();
      try {
        for (const T& item : block) work_(item);
      } catch (...) {
        lock.lock();
        failure_ = std::current_exception();
        lock.unlock();
        changed_.notify_all();
        return;
      }
      block.clear();
      lock.lock();
      spare_.push_back(std::move(block));
    }
  }

  std::function<void(const T&)> work_;
  Block given_;  ///< the giver's own
  std::mutex mutex_;
  std::condition_variable changed_;
  // Under the mutex.
  std::deque<Block> blocks_;
  std::vector<Block> spare_;
  bool ending_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  ///< the last, so that all it uses is there
};

}  // namespace fathom::cli
