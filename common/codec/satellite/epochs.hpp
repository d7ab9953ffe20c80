#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/device_time.hpp"

namespace fathom::codec {

/// Joins a sample of a receiver with what comes of the same instant in frames of their own (its parts).
/// `Kind` says what an instant, the sample and a part are, how many parts there may be, how many samples in a
/// row may wait in vain for one, and how one goes into the sample.
///
/// Parts that come before their sample are joined with it. A sample waits for a part only where that part has
/// followed one, and no longer once so many have waited in vain. It is delivered when all those parts are
/// there, and at the latest when anything of a later instant comes, the next sample, or what ends the epoch.
/// Nothing is delivered twice. Without an instant nothing can be joined, and nothing waits.
template <class Kind>
class Epochs {
 public:
  using Instant = typename Kind::Instant;  ///< optional
  struct Found {
    typename Kind::Sample sample;
    DeviceTime time;
    std::uint64_t offset = 0;  ///< of the sample's frame
    std::uint64_t length = 0;
  };

  /// Whether the last sample was of this instant.
  [[nodiscard]] bool is_at(const Instant& at) const { return at && at == at_; }

  /// `deliver` takes a Found.
  void add(const Instant& at, const Found& found, auto&& deliver) {
    release(deliver);
    at_ = at;
    arrived_.fill(false);
    waiting_ = found;
    for (std::size_t i = 0; i < Kind::kParts; ++i) {
      if (at && before_[i] && before_[i]->at == at) join(i, before_[i]->part);
      before_[i].reset();
    }
    if (!at || is_complete()) hand_out(deliver);
  }

  /// Whether it was joined.
  bool add_part(std::size_t which, const Instant& at, const typename Kind::Part& part, auto&& deliver) {
    if (!at) return false;
    if (at != at_) {
      pass(at, deliver);
      before_[which] = Early{at, part};
      return false;
    }
    if (arrived_[which]) return false;
    patience_[which] = Kind::kWaitsInVain;
    if (!waiting_) return false;
    join(which, part);
    if (is_complete()) hand_out(deliver);
    return true;
  }

  /// Something of this instant has come: what waits is delivered where its own was earlier.
  void pass(const Instant& at, auto&& deliver) {
    if (at > at_) release(deliver);
  }

  /// Nothing more comes of this instant.
  void end(const Instant& at, auto&& deliver) {
    if (is_at(at)) release(deliver);
  }

  /// The stream has ended.
  void finish(auto&& deliver) {
    release(deliver);
    *this = Epochs();
  }

 private:
  struct Early {
    Instant at;
    typename Kind::Part part;
  };

  void join(std::size_t which, const typename Kind::Part& part) {
    Kind::join(waiting_->sample, which, part);
    arrived_[which] = true;
  }
  [[nodiscard]] bool is_complete() const {
    for (std::size_t i = 0; i < Kind::kParts; ++i) {
      if (patience_[i] > 0 && !arrived_[i]) return false;
    }
    return true;
  }
  void hand_out(auto&& deliver) {
    deliver(*waiting_);
    waiting_.reset();
  }
  void release(auto&& deliver) {
    if (!waiting_) return;
    for (std::size_t i = 0; i < Kind::kParts; ++i) {
      if (!arrived_[i]) patience_[i] = std::max(0, patience_[i] - 1);
    }
    hand_out(deliver);
  }

  Instant at_;  ///< of the last sample
  std::optional<Found> waiting_;
  std::array<bool, Kind::kParts> arrived_{};
  std::array<int, Kind::kParts> patience_{};               ///< how many in a row may wait in vain from now on
  std::array<std::optional<Early>, Kind::kParts> before_;  ///< whose sample has not come yet
};

}  // namespace fathom::codec
