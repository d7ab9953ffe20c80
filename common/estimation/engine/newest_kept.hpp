#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fathom::estimation {

/// A queue of bounded length whose oldest makes room for the newest, and is counted. Nothing is allocated
/// after construction.
template <class T>
class NewestKept {
 public:
  explicit NewestKept(std::size_t most) : kept_(most) {}

  /// The place of the newest, to be filled.
  [[nodiscard]] T& push() {
    if (count_ == kept_.size()) {
      first_ = (first_ + 1) % kept_.size();
      --count_;
      ++dropped_;
    }
    return kept_[(first_ + count_++) % kept_.size()];
  }
  /// The oldest; false: there is none.
  bool pop(T& oldest) {
    if (count_ == 0) {
      first_ = 0;  // always the same memory, while they are taken in time
      return false;
    }
    oldest = kept_[first_];
    first_ = (first_ + 1) % kept_.size();
    --count_;
    return true;
  }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  std::vector<T> kept_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace fathom::estimation
