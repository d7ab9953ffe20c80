#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "codec/registry.hpp"

/// What the tests on instrument recordings share.
namespace fathom::codec::capture {

using ByteVector = std::vector<std::uint8_t>;

struct Harvest {
  std::vector<Decoded> samples;
  std::vector<Rejected> rejected;
  Totals totals;
};

/// How a recording is cut before it is fed.
struct Cut {
  enum class Kind : std::uint8_t { whole, bytes, random };
  Kind kind = Kind::whole;
  std::uint32_t seed = 1;
};

[[nodiscard]] std::filesystem::path root();
[[nodiscard]] ByteVector load(const std::filesystem::path& file);
/// Lines without line ends.
[[nodiscard]] std::vector<std::string> lines(const std::filesystem::path& file);
[[nodiscard]] std::vector<std::string> split(std::string_view line, char separator);

[[nodiscard]] Harvest decode(std::string_view protocol, const ByteVector& bytes, Cut cut = {},
                             const CodecOptions& options = {});

/// Every bit of what came out, in order; two runs are the same when their texts are.
[[nodiscard]] std::vector<std::string> text(const Harvest& run);

/// The samples of one kind, in stream order.
template <class Sample>
[[nodiscard]] std::vector<std::pair<Decoded, Sample>> of_kind(const Harvest& run) {
  std::vector<std::pair<Decoded, Sample>> found;
  for (const Decoded& decoded : run.samples) {
    if (const auto* sample = std::get_if<Sample>(&decoded.sample)) found.emplace_back(decoded, *sample);
  }
  return found;
}

/// Prints what a file gave: the record of a test run.
void report(const std::filesystem::path& file, const Harvest& run, std::size_t compared,
            std::size_t mismatches);

}  // namespace fathom::codec::capture
