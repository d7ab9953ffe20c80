#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "console/http/fan_out.hpp"
#include "console/http/request.hpp"

namespace fathom::console {

/// What is said to a request.
struct Answer {
  int status = 200;
  std::string type = "application/json";  ///< of the body, MIME
  std::string cache = "no-store";         ///< Cache-Control
  std::string etag;                       ///< empty: none
  std::string body;
  std::string_view asset;  ///< a body that lives as long as the process, instead
  /// Events follow the body until the connection ends: no length is said.
  std::shared_ptr<FanOut::Client> stream;

  [[nodiscard]] std::string_view content() const { return asset.empty() ? std::string_view(body) : asset; }
};

/// Status and headers up to and including the empty line, with the guards that every answer carries: nothing
/// but the console's own files may run in or around the page. `secure`: it goes through TLS.
[[nodiscard]] std::string head_of(const Answer& answer, bool keep_alive, bool secure);

/// In words what is refused before anything looks at where it wanted to go. Plain text.
[[nodiscard]] Answer answer_to(const Refusal& refusal);

/// A connection that comes in clear where there is TLS.
inline constexpr const char* kPlainHttp = "plain_http";

}  // namespace fathom::console
