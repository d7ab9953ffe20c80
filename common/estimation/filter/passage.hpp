#pragma once

#include <algorithm>
#include <array>

#include "estimation/filter/error_filter.hpp"

namespace fathom::estimation {

/// What a filter did from an instant on, as seen from there (LATE-1): how an error of then has become one of
/// now, and what the measurements since say about the error of then. Goes forward with the filter, as its
/// tape; an Adjoint over the same steps, from nothing known back to the first, has the same gradient and
/// curvature. Fixed size, nothing allocated; a copy costs what is in use.
class Passage final : public FilterTape {
 public:
  /// Columns of errors that are carried along together.
  static constexpr int kColumns = 32;
  /// By states and columns: the covariance of the present error with some sums of earlier ones.
  using Columns =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxStates, kColumns>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kColumns, kColumns>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kColumns, 1>;

  explicit Passage(int states = 0) : n_(states) { begin(); }
  Passage(const Passage& other) : n_(other.n_) { copy(other); }
  Passage& operator=(const Passage& other) {
    n_ = other.n_;
    if (this != &other) copy(other);
    return *this;
  }

  /// From here on.
  void begin();
  /// A new start of the filter: nothing now follows from what was before.
  [[nodiscard]] bool is_cut() const { return cut_; }
  [[nodiscard]] int size() const { return n_; }

  /// (LATE-2): from its begin to its end. `columns`: covariance of the error at the instant with the sums;
  /// `sums`: covariance of these among themselves; `mean`: what they are expected to be.
  void carry_along(Columns& columns, Square& sums, Vector& mean) const;

  void propagated(const NavTransition& transition, const ProcessNoise& noise) override;
  void updated(const Observation& observation, const InnovationStatistics& statistics) override;
  void forgot(int state) override;
  void drifted(const ErrorFilter& widened, const std::array<double, kNavStates>& variance) override;
  void shifted(const ErrorFilter& filter, const std::array<double, kMaxStates>& column, double mean,
               double variance) override;
  void carried(const Carry& carry) override;
  void restarted() override;

  /// For archives: see fields/past.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  [[nodiscard]] static std::size_t at(int row, int column) {
    return static_cast<std::size_t>(row * kRowStride + column);
  }
  /// Columns that the loops run over: an even number; the odd one is zero.
  [[nodiscard]] int width() const { return (n_ + 1) & ~1; }
  void copy(const Passage& other) {
    cut_ = other.cut_;
    gradient_ = other.gradient_;
    for (int i = 0; i < n_; ++i) {
      std::copy_n(other.a_.data() + at(i, 0), static_cast<std::size_t>(width()), a_.data() + at(i, 0));
      std::copy_n(other.w_.data() + at(i, 0), static_cast<std::size_t>(width()), w_.data() + at(i, 0));
    }
  }
  [[nodiscard]] auto transition() const {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    return Eigen::Map<const Rows, 0, Eigen::OuterStride<kRowStride>>(a_.data(), n_, n_);
  }
  [[nodiscard]] auto curvature() const {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    return Eigen::Map<const Rows, 0, Eigen::OuterStride<kRowStride>>(w_.data(), n_, n_);
  }

  using Matrix = std::array<double, static_cast<std::size_t>(kMaxStates) * kRowStride>;

  int n_;
  bool cut_ = false;
  alignas(64) Matrix a_{};                     ///< closed-loop transition
  alignas(64) Matrix w_{};                     ///< curvature, symmetric to the bit
  std::array<double, kMaxStates> gradient_{};  ///< lambda
};

}  // namespace fathom::estimation
