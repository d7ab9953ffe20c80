#pragma once

#include <array>
#include <cstdint>

#include "estimation/filter/state_index.hpp"

namespace fathom::estimation {

/// One linearised measurement of up to six independent components:
///   innovation = predicted - measured = H x + noise,  x the error state (see EQUATIONS.md).
/// Columns of H that no row uses are never touched: `columns` lists the others in rising order.
struct Observation {
  static constexpr int kMaxRows = 6;
  int rows = 0;
  bool each_alone = false;  ///< rows are gated one by one whatever the configuration says
  std::array<double, kMaxRows> innovation{};
  std::array<double, kMaxRows> sigma{};
  /// What the instrument of each row states of noise and slow error in one, a variance; 0: nothing of the
  /// kind.
  std::array<double, kMaxRows> stated{};
  std::array<std::uint8_t, kMaxRows> slow_state{};  ///< of that slow error
  /// Which component of what its instrument measures each row is; rows that are unknown are left out.
  std::array<std::uint8_t, kMaxRows> component{};
  std::array<std::array<double, kMaxStates>, kMaxRows> h{};
  int column_count = 0;
  std::array<std::uint8_t, kMaxStates> columns{};

  /// Fills `columns` from the non-zero entries of h.
  void list_columns(int states) {
    column_count = 0;
    for (int j = 0; j < states; ++j) {
      bool used = false;
      for (int i = 0; i < rows; ++i)
        used = used || h[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] != 0.0;
      if (used) columns[static_cast<std::size_t>(column_count++)] = static_cast<std::uint8_t>(j);
    }
  }
};

}  // namespace fathom::estimation
