#include "live/record/state_pool.hpp"

#include "archive/digest.hpp"

namespace fathom::cli {

void StatePool::offer(TimeNs stamp_ns, std::span<const std::byte> archive) {
  const auto found = wanted_.find(stamp_ns);
  if (found == wanted_.end()) return;
  const std::uint64_t digest = archive::digest(archive);
  if (found->second.erase(digest) == 0) return;
  offered_.try_emplace(digest, archive.begin(), archive.end());
  if (found->second.empty()) wanted_.erase(found);
}

const std::vector<std::byte>* StatePool::find(std::uint64_t digest) const {
  const auto found = offered_.find(digest);
  return found == offered_.end() ? nullptr : &found->second;
}

}  // namespace fathom::cli
