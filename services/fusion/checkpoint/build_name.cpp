#include "fusion/checkpoint/build_name.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <zlib.h>

#include "runtime/build_info.hpp"

namespace fathom::fusion {

std::string build_of_this_executable() {
  std::string out(runtime::version());
  std::ifstream file("/proc/self/exe", std::ios::binary);
  if (!file) return out + "-unknown";
  std::vector<char> block(1U << 20U);
  uLong value = crc32_z(0, nullptr, 0);
  do {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    value =
        crc32_z(value, reinterpret_cast<const Bytef*>(block.data()), static_cast<std::size_t>(file.gcount()));
  } while (file);
  std::array<char, 16> sum{};
  std::snprintf(sum.data(), sum.size(), "-%08x", static_cast<unsigned>(value));
  return out + sum.data();
}

}  // namespace fathom::fusion
