#include "estimation/smoothing/filter_log.hpp"

namespace fathom::estimation {

void FilterLog::back_through(std::size_t end, std::size_t begin, Adjoint& adjoint) const {
  for (std::size_t i = end; i > begin; --i) {
    const auto& entry = entries_[i - 1];
    if (const auto* step = std::get_if<Transition>(&entry)) {
      adjoint.back_through(*step);
    } else if (const auto* update = std::get_if<UpdateRecord>(&entry)) {
      adjoint.back_through(*update);
    } else if (const auto* drift = std::get_if<DriftRecord>(&entry)) {
      adjoint.back_through(*drift);
    } else if (const auto* shift = std::get_if<ShiftRecord>(&entry)) {
      adjoint.back_through(*shift);
    } else if (const auto* carry = std::get_if<Carry>(&entry)) {
      adjoint.back_through(*carry);
    } else if (const auto* forgotten = std::get_if<Forgotten>(&entry)) {
      adjoint.back_through_forgotten(forgotten->state);
    } else {
      adjoint.cut();
    }
  }
}

}  // namespace fathom::estimation
