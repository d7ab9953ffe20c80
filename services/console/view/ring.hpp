#pragma once

#include <cstddef>
#include <vector>

namespace fathom::console {

/// The newest `capacity` values, oldest first. Its memory is taken once and never grows.
template <class T>
class Ring {
 public:
  /// Precondition: capacity > 0.
  explicit Ring(std::size_t capacity) : values_(capacity) {}

  void push(const T& value) {
    values_[(first_ + size_) % values_.size()] = value;
    if (size_ < values_.size()) {
      ++size_;
    } else {
      first_ = (first_ + 1) % values_.size();
    }
  }
  void clear() { first_ = size_ = 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t capacity() const { return values_.size(); }
  [[nodiscard]] const T& operator[](std::size_t index) const {
    return values_[(first_ + index) % values_.size()];
  }
  [[nodiscard]] T& operator[](std::size_t index) { return values_[(first_ + index) % values_.size()]; }
  [[nodiscard]] const T& back() const { return (*this)[size_ - 1]; }

 private:
  std::vector<T> values_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace fathom::console
