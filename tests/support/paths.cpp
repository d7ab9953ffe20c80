#include "support/paths.hpp"

namespace fathom::test {

std::string source_dir() {
  return FATHOM_SOURCE_DIR;
}
std::string binary_dir() {
  return FATHOM_BINARY_DIR;
}
std::string captures_dir() {
  return FATHOM_CAPTURES;
}
std::string datasets_dir() {
  return FATHOM_DATASETS;
}
std::string vectors_dir() {
  return FATHOM_VECTORS;
}

}  // namespace fathom::test
