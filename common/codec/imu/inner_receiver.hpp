#pragma once

namespace fathom::codec {

/// Which of a unit's two receivers the vehicle's fix comes from: the first. The second counts as long as the
/// first was never heard, and from its second fix on: at the beginning of a stream that of the first may
/// follow.
class FirstReceiver {
 public:
  /// Whether a fix is the vehicle's.
  bool takes(bool of_second) {
    if (of_second) {
      const bool again = second_heard_;
      second_heard_ = true;
      return again && !first_heard_;
    }
    first_heard_ = true;
    return true;
  }
  [[nodiscard]] bool first_heard() const { return first_heard_; }

 private:
  bool first_heard_ = false;
  bool second_heard_ = false;
};

}  // namespace fathom::codec
