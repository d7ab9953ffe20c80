#pragma once

namespace fathom::estimation {

/// Value that a chi-square variable of `degrees` (1 or more) stays below with the given probability, inside
/// (0, 1). Rounded to nine digits, so that builds with other versions of the library have the same bits.
[[nodiscard]] double chi_square_quantile(double probability, int degrees);

}  // namespace fathom::estimation
