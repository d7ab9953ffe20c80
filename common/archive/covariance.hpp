#pragma once

#include <cmath>
#include <cstddef>

#include "archive/visitor.hpp"

namespace fathom::archive {

/// Whether the n x n matrix at `p`, row-major with this stride, can be a covariance: finite, symmetric to
/// rounding, no variance negative, and positive: the Cholesky factorisation of its correlations succeeds when
/// a millionth is added to each, which is more than rounding takes from them over months. What is known
/// exactly (variance 0) correlates with nothing.
[[nodiscard]] bool is_covariance(const double* p, std::size_t n, std::size_t stride);

/// All elements of a square matrix that is to be a covariance.
template <class Archive, class Matrix>
void covariance(Archive& archive, const char* name, Matrix& matrix) {
  archive(name, matrix, finite());
  if constexpr (Archive::kReads) {
    const auto n = static_cast<std::size_t>(matrix.rows());
    archive.expect(is_covariance(matrix.data(), n, n), name, "a symmetric and positive covariance");
  }
}

}  // namespace fathom::archive
