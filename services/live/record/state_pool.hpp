#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "base/time.hpp"

namespace fathom::cli {

/// The states of engines that fusions went on from. First each is named by its stamp and digest; then it is
/// offered by whoever has it: a checkpoint in the recording, or the run that saved it, done again.
class StatePool {
 public:
  void want(TimeNs stamp_ns, std::uint64_t digest) { wanted_[stamp_ns].insert(digest); }
  /// Whether a state of this stamp is wanted and has not been offered.
  [[nodiscard]] bool wants(TimeNs stamp_ns) const { return wanted_.contains(stamp_ns); }
  /// Keeps it when it is wanted. `archive` is an engine's.
  void offer(TimeNs stamp_ns, std::span<const std::byte> archive);
  /// Nothing when it has not been offered.
  [[nodiscard]] const std::vector<std::byte>* find(std::uint64_t digest) const;

 private:
  std::map<TimeNs, std::set<std::uint64_t>> wanted_;
  std::map<std::uint64_t, std::vector<std::byte>> offered_;  // by digest
};

}  // namespace fathom::cli
