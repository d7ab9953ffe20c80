#pragma once

#include <array>
#include <optional>

#include "estimation/alignment/velocity_window.hpp"

namespace fathom::estimation {

/// The last velocities of a satellite receiver, half a second apart or more, and the inertial increments
/// between them (ALN-24). Fixed size.
class VelocityTrack {
 public:
  static constexpr std::size_t kMarks = 16;

  void reset() { *this = VelocityTrack(); }
  /// One inertial interval that ends at `now_ns`, and the velocity that was measured within it. True when
  /// that was marked.
  bool add(const std::optional<NewVelocity>& measured, TimeNs now_ns, double dt_s,
           const Eigen::Vector3d& rate_B_rad_s, const Eigen::Vector3d& force_B_m_s2);

  [[nodiscard]] std::size_t size() const { return count_; }
  /// 0 is the oldest. The span of a mark is that since the one before.
  [[nodiscard]] const VelocityMark& mark(std::size_t k) const { return marks_[k]; }
  [[nodiscard]] const VelocityMark& newest() const { return marks_[count_ - 1]; }
  /// Since the newest mark.
  [[nodiscard]] const InertialSpan& since_newest() const { return now_; }

  /// For archives: see fields/alignment.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  void mark(const NewVelocity& measured, const Eigen::Vector3d& rate_B_rad_s);

  std::array<VelocityMark, kMarks> marks_{};
  std::size_t count_ = 0;
  InertialSpan now_;
};

}  // namespace fathom::estimation
