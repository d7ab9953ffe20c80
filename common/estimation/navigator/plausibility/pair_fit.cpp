#include "estimation/navigator/plausibility/pair_fit.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::estimation {
namespace {

constexpr double kMost = 1e7;
const double kRelated = std::log(1000.0);

}  // namespace

double chi_square_mean(double count, double sigmas) {
  const double variance = 2.0 / (9.0 * count);
  return std::pow(1.0 - variance + sigmas * std::sqrt(variance), 3);
}

double evidence_for_other(double components, double expected, double configured, double other,
                          double most_left) {
  if (configured <= expected) return 0.0;  // there is nothing to explain, as mostly
  if (configured < chi_square_mean(components, kRefutedSigmas) * expected || other > most_left * configured)
    return 0.0;
  return 0.5 * components * std::log((configured + expected) / (other + expected));
}

void PairFit::add(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double noise, double share) {
  add(a, b, 2.0, noise, share);
}

void PairFit::add(double a, double b, double noise, double share) {
  add({a, 0.0}, {b, 0.0}, 1.0, noise, share);
}

void PairFit::add(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double components, double noise,
                  double share) {
  const double least = std::min(a.norm(), b.norm());
  const double most = std::max(a.norm(), b.norm());
  if (!(most < kMost) || !(noise < kMost) || most < kPairStandsOut * noise) return;
  const double sigma = std::hypot(noise, share * least);
  count_ = kPairsKept * count_ + components;
  expected_ = kPairsKept * expected_ + components * sigma * sigma;
  aa_ = kPairsKept * aa_ + a * a.transpose();
  ba_ = kPairsKept * ba_ + b * a.transpose();
  bb_ = kPairsKept * bb_ + b.squaredNorm();
}

double PairFit::left_over(const Eigen::Matrix2d& M) const {
  return std::max(0.0, bb_ - 2.0 * (M.transpose() * ba_).trace() + (M * aa_ * M.transpose()).trace());
}

double PairFit::turn_rad() const {
  return std::atan2(ba_(1, 0) - ba_(0, 1), ba_(0, 0) + ba_(1, 1));
}

bool PairFit::is_related(double factor) const {
  const double left = left_over(factor * Eigen::Matrix2d::Identity());
  return count_ > 0.0 && 0.5 * count_ * std::log((bb_ + expected_) / (left + expected_)) > kRelated;
}

bool PairFit::moves() const {
  return count_ >= 1.0 && bb_ > chi_square_mean(count_, kRefutedSigmas) * expected_;
}

bool PairFit::agrees() const {
  return count_ >= kFewestPairs &&
         left_over(Eigen::Matrix2d::Identity()) <= chi_square_mean(count_, kAgreesSigmas) * expected_;
}

bool PairFit::refutes() const {
  return count_ >= 1.0 &&
         left_over(Eigen::Matrix2d::Identity()) > chi_square_mean(count_, kRefutedSigmas) * expected_;
}

double PairFit::evidence_of(double left_over, const Proof& proof) const {
  if (count_ < proof.fewest) return 0.0;
  return evidence_for_other(count_, expected_, this->left_over(Eigen::Matrix2d::Identity()), left_over,
                            proof.most_left);
}

}  // namespace fathom::estimation
