#include "samples/kinds.hpp"

namespace fathom {

std::string_view to_string(SourceKind source) {
  std::string_view word = "unknown";
  for_each_kind([&](auto kind) {
    if (kind.kSource == source) word = kind.kWord;
  });
  return word;
}

std::optional<SourceKind> kind_named(std::string_view word) {
  std::optional<SourceKind> source;
  for_each_kind([&](auto kind) {
    if (kind.kWord == word) source = kind.kSource;
  });
  return source;
}

}  // namespace fathom
