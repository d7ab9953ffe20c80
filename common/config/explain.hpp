#pragma once

#include <string>
#include <vector>

#include "base/field.hpp"

namespace fathom::config {

/// One key of a configuration file, for people.
struct FieldRow {
  std::string key;  ///< dotted path; "[]" for each element of a list, "*" for each name
  FieldInfo info;
  std::string range;         ///< e.g. "1 to 2000", "true or false"; empty where anything will do
  std::string default_text;  ///< empty where there is none
};

/// Key, unit, range, default and sentence as aligned text, a line each.
[[nodiscard]] std::string explain_text(const std::vector<FieldRow>& rows);

}  // namespace fathom::config
