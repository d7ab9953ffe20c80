#pragma once

#include <string>
#include <string_view>

namespace fathom {

/// Text between tags and in attributes of HTML, SVG and XML. Control characters become spaces.
[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace fathom
