#include "runtime/build_info.hpp"

#include <array>
#include <cinttypes>
#include <cstdint>
#include <cstdio>

#include <unistd.h>

namespace fathom::runtime {

std::string_view version() {
  return FATHOM_VERSION;
}

std::string host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0 || name[0] == '\0') return "unknown";
  return name.data();
}

std::string hex_hash(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  std::array<char, 17> out{};
  std::snprintf(out.data(), out.size(), "%016" PRIx64, hash);
  return out.data();
}

}  // namespace fathom::runtime
