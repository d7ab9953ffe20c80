#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/device_time.hpp"
#include "codec/satellite/sbf/blocks.hpp"

namespace fathom::codec::sbf {

/// Joins a block with those of the same instant that say how good it is (its parts). `Kind` says what the
/// sample is, how many parts it may have, what a part holds, and how one goes into the sample.
///
/// Parts that come before their block are joined with it. A block waits for a part only where that part
/// followed the block before it. It is delivered when all those parts are there, and at the latest when
/// anything of a later instant comes, the next block, or the one that ends the epoch. A block is delivered
/// once: one that repeats the instant of the last is left out. Without an instant nothing can be joined, and
/// nothing waits.
template <class Kind>
class SbfEpochs {
 public:
  struct Found {
    typename Kind::Sample sample;
    DeviceTime time;
    std::uint64_t offset = 0;  ///< of the block
    std::uint64_t length = 0;
  };

  /// Whether it counts. `deliver` takes a Found.
  bool add(const GpsInstant& at, const Found& found, auto&& deliver) {
    if (at && at == at_) return false;
    release(deliver);
    at_ = at;
    arrived_.fill(false);
    waiting_ = found;
    for (std::size_t i = 0; i < Kind::kParts; ++i) {
      if (at && before_[i] && before_[i]->at == *at) join(i, before_[i]->part);
      before_[i].reset();
    }
    if (!at || is_complete()) hand_out(deliver);
    return true;
  }

  /// Whether it was joined.
  bool add_part(std::size_t which, const GpsInstant& at, const typename Kind::Part& part, auto&& deliver) {
    if (!at) return false;
    if (at != at_) {
      pass(at, deliver);
      before_[which] = Early{*at, part};
      return false;
    }
    if (arrived_[which]) return false;
    expected_[which] = true;
    if (!waiting_) return false;
    join(which, part);
    if (is_complete()) hand_out(deliver);
    return true;
  }

  /// Something of this instant has come: what waits is delivered where its own was earlier.
  void pass(const GpsInstant& at, auto&& deliver) {
    if (at > at_) release(deliver);
  }

  /// Nothing more comes of this instant.
  void end(const GpsInstant& at, auto&& deliver) {
    if (at && at == at_) release(deliver);
  }

  /// The stream has ended.
  void finish(auto&& deliver) {
    release(deliver);
    *this = SbfEpochs();
  }

 private:
  struct Early {
    DurationNs at = 0;
    typename Kind::Part part;
  };

  void join(std::size_t which, const typename Kind::Part& part) {
    Kind::join(waiting_->sample, which, part);
    arrived_[which] = true;
  }
  [[nodiscard]] bool is_complete() const {
    for (std::size_t i = 0; i < Kind::kParts; ++i) {
      if (expected_[i] && !arrived_[i]) return false;
    }
    return true;
  }
  void hand_out(auto&& deliver) {
    deliver(*waiting_);
    waiting_.reset();
  }
  /// Parts that it has waited for in vain are expected no more.
  void release(auto&& deliver) {
    if (!waiting_) return;
    for (std::size_t i = 0; i < Kind::kParts; ++i) expected_[i] = expected_[i] && arrived_[i];
    hand_out(deliver);
  }

  GpsInstant at_;  ///< of the last block
  std::optional<Found> waiting_;
  std::array<bool, Kind::kParts> arrived_{};
  std::array<bool, Kind::kParts> expected_{};
  std::array<std::optional<Early>, Kind::kParts> before_;  ///< whose block has not come yet
};

/// A fix, whose sigmas come apart.
struct FixKind {
  using Sample = GpsSample;
  using Part = Sigmas;
  static constexpr std::size_t kParts = 2;
  static constexpr std::size_t kPosition = 0;
  static constexpr std::size_t kVelocity = 1;
  static void join(GpsSample& sample, std::size_t which, const Sigmas& sigmas) {
    if (sample.fix == GpsFix::none) return;
    auto& into = which == kPosition ? sample.position_sigma_N_m : sample.velocity_sigma_N_m_s;
    for (std::size_t i = 0; i < 3; ++i) {
      if (known(sigmas[i])) into[i] = sigmas[i];
    }
  }
};

/// A heading and its sigma.
struct HeadingKind {
  using Sample = HeadingSample;
  using Part = double;
  static constexpr std::size_t kParts = 1;
  static constexpr std::size_t kSigma = 0;
  static void join(HeadingSample& sample, std::size_t /*which*/, double sigma_rad) {
    if (known(sample.heading_rad)) sample.sigma_rad = sigma_rad;
  }
};

}  // namespace fathom::codec::sbf
