// Writes or compares the JSON Schema files of every configuration kind.
// Usage: fathom_write_schemas [--compare] DIR
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string_view>

#include "config/registry.hpp"

int main(int argc, char** argv) {
  const bool compare = argc == 3 && std::string_view(argv[1]) == "--compare";
  if (argc != (compare ? 3 : 2)) {
    std::cerr << "usage: fathom_write_schemas [--compare] DIR\n";
    return 2;
  }
  const std::filesystem::path directory = argv[argc - 1];
  int differing = 0;
  for (const auto& kind : fathom::config::config_kinds()) {
    const auto path = directory / (std::string(kind.name) + ".schema.json");
    const std::string text = kind.schema();
    if (!compare) {
      std::ofstream(path) << text;
      continue;
    }
    std::ostringstream shipped;
    shipped << std::ifstream(path).rdbuf();
    if (shipped.str() != text) {
      std::cerr << path.string() << ": differs from the code's description; fathom_write_schemas "
                << directory.string() << " rewrites it\n";
      ++differing;
    }
  }
  return differing == 0 ? 0 : 1;
}
