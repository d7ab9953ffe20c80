#include "cli/bench/floor.hpp"

#include <array>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace fathom::cli {
namespace {

using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

Small inverse(const Small& s) {
  return s.llt().solve(Small::Identity(s.rows(), s.cols()));
}

template <int N>
class Dense final : public DenseFloor {
 public:
  explicit Dense(int rows) : rows_(rows) {
    // Any full matrices of sensible size: what they hold does not change what multiplying them costs.
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) {
        phi_(i, j) = (i == j ? 1.0 : 0.0) + 1e-6 * (1 + (7 * i + 3 * j) % 11);
        q_(i, j) = i == j ? 1e-9 : 1e-12;
      }
    h_.resize(rows, N);
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < N; ++j) h_(i, j) = i == j % rows ? 1.0 : 0.1;
    reset();
  }

  void predict() override {
    sandwich(phi_);
    p_ += q_;
  }

  void update() override {
    Tall ph(N, rows_);
    for (int i = 0; i < rows_; ++i) ph.col(i).noalias() = p_ * h_.row(i).transpose();
    Small s(rows_, rows_);
    for (int i = 0; i < rows_; ++i)
      for (int j = 0; j < rows_; ++j) s(i, j) = h_.row(i).dot(ph.col(j)) + (i == j ? 0.01 : 0.0);
    const Small weight = inverse(s);
    Tall k = Tall::Zero(N, rows_);
    for (int i = 0; i < rows_; ++i)
      for (int j = 0; j < rows_; ++j) k.col(i) += weight(j, i) * ph.col(j);
    keep_.setIdentity();
    for (int i = 0; i < rows_; ++i) keep_.noalias() -= k.col(i) * h_.row(i);
    sandwich(keep_);
    for (int i = 0; i < rows_; ++i) p_.noalias() += (0.01 * k.col(i)) * k.col(i).transpose();
  }

  void reset() override {
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) p_(i, j) = i == j ? 1.0 : 0.01;
  }
  [[nodiscard]] int states() const override { return N; }

 private:
  using Square = Eigen::Matrix<double, N, N>;
  using Tall = Eigen::Matrix<double, N, Eigen::Dynamic, 0, N, 6>;

  /// P <- A P A'.
  [[gnu::noinline]] void sandwich(const Square& a) {
    t_.noalias() = a * p_;
    p_.noalias() = t_ * a.transpose();
  }

  int rows_;
  Square phi_;
  Square p_;
  Square q_;
  Square t_;
  Square keep_;
  Eigen::Matrix<double, Eigen::Dynamic, N, 0, 6, N> h_;
};

template <int N>
std::unique_ptr<DenseFloor> make(int rows) {
  return std::make_unique<Dense<N>>(rows);
}

struct Entry {
  int states;
  std::unique_ptr<DenseFloor> (*make)(int rows);
};

constexpr std::array<Entry, 4> kSizes{{{15, make<15>}, {25, make<25>}, {50, make<50>}, {58, make<58>}}};

}  // namespace

std::unique_ptr<DenseFloor> dense_floor(int states, int rows) {
  const Entry* best = &kSizes.front();
  for (const Entry& one : kSizes)
    if (one.states <= states) best = &one;
  return best->make(rows);
}

}  // namespace fathom::cli
