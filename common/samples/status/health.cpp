#include "samples/status/health.hpp"

namespace fathom {

std::uint64_t ServiceStatus::counter(std::string_view name) const {
  for (const ServiceCounter& one : counters) {
    if (one.name.view() == name) return one.value;
  }
  return 0;
}

}  // namespace fathom
