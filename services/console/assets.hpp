#pragma once

#include <span>
#include <string_view>

namespace fathom::console {

/// A file of the web application, compiled into the executable.
struct Asset {
  std::string_view path;  ///< as asked for, e.g. "/js/main.js"
  std::string_view type;  ///< MIME type
  std::string_view etag;
  std::string_view bytes;
};

/// Every file; the definition is written by the build from services/console/web and the npm packages.
[[nodiscard]] std::span<const Asset> assets();

/// Null when there is none. "/" is the page.
[[nodiscard]] const Asset* find_asset(std::string_view path);

}  // namespace fathom::console
