#include "estimation/doubt/followed.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "estimation/filter/adjoint.hpp"

namespace fathom::estimation {

template <std::size_t N>
Evidence<N>::Evidence(const FollowedErrors<N>& errors, const Observation& observation,
                      const InnovationStatistics& statistics) {
  constexpr auto kColumns = static_cast<Eigen::Index>(N);
  const Eigen::Index m = statistics.rows;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Observation::kMaxRows, 1> innovation(m);
  decltype(weighed) seen = decltype(weighed)::Zero(m, kColumns);  // H u
  UpdateRecord::Square s(m, m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto row = static_cast<std::size_t>(i);
    innovation(i) = observation.innovation[row];
    for (int c = 0; c < observation.column_count; ++c) {
      const std::size_t state = observation.columns[static_cast<std::size_t>(c)];
      for (std::size_t j = 0; j < N; ++j)
        seen(i, static_cast<Eigen::Index>(j)) += observation.h[row][state] * errors[state * N + j];
    }
    for (Eigen::Index j = 0; j < m; ++j)
      s(i, j) = statistics.s[row * kStatisticsStride + static_cast<std::size_t>(j)];
  }
  weighed = s.llt().solve(seen);
  for (std::size_t j = 0; j < N; ++j) {
    const auto column = weighed.col(static_cast<Eigen::Index>(j));
    gradient[j] = column.dot(innovation);
    curvature[j] = column.dot(seen.col(static_cast<Eigen::Index>(j)));
  }
}

template <std::size_t N>
template <std::size_t M>
void Considered<N>::add(std::size_t i, const Evidence<M>& evidence, std::size_t j,
                        const InnovationStatistics& statistics, const ErrorFilter& filter) {
  for (int c = filter.estimated(); c < filter.size(); ++c) {
    const double variance = filter(c, c);
    if (!(variance > 0.0)) continue;
    double shared = 0.0;
    for (int row = 0; row < statistics.rows; ++row)
      shared += evidence.weighed(row, static_cast<Eigen::Index>(j)) *
                statistics.ph[static_cast<std::size_t>(row * kMaxStates + c)];
    sums[i * kMaxStates + static_cast<std::size_t>(c)] += shared / std::sqrt(variance);
  }
}

template <std::size_t N>
void follow(const NavTransition& step, const ProcessNoise& noise, FollowedErrors<N>& errors) {
  // Rows that are kRowStride apart, of an even number of columns, as the step wants them.
  constexpr std::size_t kWidth = (N + 1) / 2 * 2;
  alignas(64) std::array<double, static_cast<std::size_t>(kMaxStates) * kRowStride> rows;
  for (std::size_t i = 0; i < kMaxStates; ++i) {
    std::copy_n(errors.data() + i * N, N, rows.data() + i * kRowStride);
    std::fill_n(rows.data() + i * kRowStride + N, kWidth - N, 0.0);
  }
  step.apply(rows.data(), static_cast<int>(kWidth));
  for (std::size_t i = 0; i < kNavStates; ++i)
    std::copy_n(rows.data() + i * kRowStride, N, errors.data() + i * N);
  if (noise.drift == nullptr) return;
  for (const std::uint8_t state : noise.drift->decaying()) {
    const double kept = noise.drift->kept(state, step.dt_s());
    for (std::size_t j = 0; j < N; ++j) errors[state * N + j] *= kept;
  }
}

template <std::size_t N>
void follow(const Evidence<N>& evidence, const InnovationStatistics& statistics, int estimated,
            FollowedErrors<N>& errors) {
  for (int i = 0; i < statistics.rows; ++i) {
    const double* ph = statistics.ph.data() + static_cast<std::size_t>(i) * kMaxStates;
    for (std::size_t state = 0; state < static_cast<std::size_t>(estimated); ++state)
      for (std::size_t j = 0; j < N; ++j)
        errors[state * N + j] -= ph[state] * evidence.weighed(i, static_cast<Eigen::Index>(j));
  }
}

template <std::size_t N>
void follow(const Carry& carry, FollowedErrors<N>& errors) {
  constexpr auto kColumns = static_cast<int>(N);
  using Part =
      Eigen::Matrix<double, Carry::kStates, kColumns, kColumns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
  Eigen::Map<Part> part(errors.data() + static_cast<std::size_t>(Carry::kFirst) * N);
  part = (carry.matrix() * part).eval();
}

template struct Evidence<1>;
template void follow<1>(const NavTransition&, const ProcessNoise&, FollowedErrors<1>&);
template void follow<1>(const Evidence<1>&, const InnovationStatistics&, int, FollowedErrors<1>&);
template void follow<1>(const Carry&, FollowedErrors<1>&);
template struct Evidence<6>;
template void follow<6>(const NavTransition&, const ProcessNoise&, FollowedErrors<6>&);
template void follow<6>(const Evidence<6>&, const InnovationStatistics&, int, FollowedErrors<6>&);
template void follow<6>(const Carry&, FollowedErrors<6>&);

template void Considered<1>::add(std::size_t, const Evidence<1>&, std::size_t, const InnovationStatistics&,
                                 const ErrorFilter&);
template void Considered<3>::add(std::size_t, const Evidence<6>&, std::size_t, const InnovationStatistics&,
                                 const ErrorFilter&);

}  // namespace fathom::estimation
