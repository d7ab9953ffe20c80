#include <algorithm>

#include "explain/watch/watches.hpp"

namespace fathom::explain {

void watch_biases(const History& history, Findings& out) {
  for (const BiasRow& row : history.biases()) {
    const FoundBias& bias = row.last;
    std::string axis(bias.axis);
    std::replace(axis.begin(), axis.end(), '_', ' ');
    out.push_back(
        {.kind = Kind::biased,
         .weight = Weight::caution,
         .subject = axis,
         .begin_ns = row.begin_ns,
         .end_ns = row.log_ns,
         .word = std::string(bias.unit()),
         .figures = {{"bias", bias.in_unit(bias.value)}, {"configured_sigma", bias.in_unit(bias.said_sigma)}},
         .evidence = {{"fathom/v1/alignment", 0,
                       std::string(kBiasPrefix) + std::string(bias.axis) + ": rad/s or m/s2"}}});
  }
}

}  // namespace fathom::explain
