#include "fusion/checkpoint/start.hpp"

#include <array>
#include <cstdio>
#include <system_error>

#include "archive/digest.hpp"
#include "fusion/checkpoint/file.hpp"

namespace fathom::fusion {
namespace {

namespace fs = std::filesystem;

fs::path beside(const fs::path& checkpoint, const char* ending) {
  fs::path out = checkpoint;
  out += ending;
  return out;
}

/// Why the bytes of `file` are not gone on from; empty when they are.
std::string taken_up(estimation::FusionEngine& engine, const fs::path& file,
                     const archive::CheckpointLabel& own, double max_age_s, archive::CheckpointLabel& found,
                     Resumption& out) {
  const auto bytes = read_file(file);
  if (!bytes) return bytes.error().message;
  const auto checkpoint = archive::decode(bytes.value());
  if (!checkpoint) return checkpoint.error().message;
  found = checkpoint.value().label;
  if (std::string why = objection(found, own, max_age_s); !why.empty()) return why;
  const std::string why = engine.restore(checkpoint.value().archive);
  out.stamp_ns = engine.nav_state().header.stamp_ns;
  out.digest = archive::digest(checkpoint.value().archive);
  return why.empty() ? why : "holds no state of this engine: " + why;
}

}  // namespace

Resumption resume(estimation::FusionEngine& engine, const config::CheckpointConfig& config,
                  const archive::CheckpointLabel& own) {
  Resumption out;
  out.how = "started afresh";
  if (config.path.empty()) return out;
  const fs::path path = config.path;
  const fs::path tried = beside(path, ".tried");
  const fs::path refused = beside(path, ".refused");
  std::error_code error;
  // The second trial of one is the last.
  fs::path file = tried;
  if (fs::exists(fs::symlink_status(path, error))) {
    fs::rename(path, tried, error);
    if (error) file = path;
  } else if (fs::exists(fs::symlink_status(tried, error))) {
    fs::rename(tried, refused, error);
    file = refused;
  } else {
    out.how += ": checkpoint " + config.path + " is not there";
    return out;
  }
  archive::CheckpointLabel found;
  const std::string why = taken_up(engine, file, own, config.max_age_s, found, out);
  if (!why.empty()) {
    out.refused = true;
    if (file != refused) fs::rename(file, refused, error);
    out.how += ": checkpoint " + config.path + " " + why;
    out.how +=
        error ? " (and cannot be put aside: " + error.message() + ")" : ", put aside as " + refused.string();
    return out;
  }
  out.resumed = true;
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "resumed from a checkpoint %.2f s old",
                to_seconds(own.stamp_ns - found.stamp_ns));
  out.how = text.data();
  if (found.build != own.build) out.how += ", written by build " + found.build;
  return out;
}

void forget_trial(const fs::path& checkpoint) {
  std::error_code error;
  fs::remove(beside(checkpoint, ".tried"), error);
}

}  // namespace fathom::fusion
