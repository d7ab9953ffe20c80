#include "console/http/answer.hpp"

#include <array>
#include <utility>

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/status.hpp>

namespace fathom::console {
namespace {

namespace http = boost::beast::http;
using Head = http::response<http::empty_body>;

constexpr std::array<std::pair<const char*, const char*>, 5> kGuards{{
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src "
     "'self'; "
     "manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
}};
/// Browsers that have been here by https ask this host by nothing else, for thirty days.
constexpr const char* kStrictTransport = "max-age=2592000";

std::string serialized(Head& head) {
  std::string out;
  http::response_serializer<http::empty_body> serializer(head);
  serializer.split(true);  // the head alone
  boost::system::error_code error;
  while (!serializer.is_header_done() && !error) {
    serializer.next(error, [&](boost::system::error_code&, const auto& buffers) {
      const std::size_t before = out.size();
      for (auto at = boost::asio::buffer_sequence_begin(buffers);
           at != boost::asio::buffer_sequence_end(buffers); ++at) {
        const boost::asio::const_buffer piece(*at);
        out.append(static_cast<const char*>(piece.data()), piece.size());
      }
      serializer.consume(out.size() - before);
    });
  }
  return out;
}

}  // namespace

std::string head_of(const Answer& answer, bool keep_alive, bool secure) {
  Head head(http::int_to_status(static_cast<unsigned>(answer.status)), 11);
  for (const auto& [name, value] : kGuards) head.set(name, value);
  if (secure) head.set(http::field::strict_transport_security, kStrictTransport);
  if (answer.status == 405) head.set(http::field::allow, "GET, HEAD, POST");
  head.set(http::field::cache_control, answer.cache);
  if (!answer.etag.empty()) head.set(http::field::etag, answer.etag);
  if (answer.status != 304) head.set(http::field::content_type, answer.type);
  if (answer.stream) {
    head.set("X-Accel-Buffering", "no");  // proxies pass on each event as it comes
  } else if (answer.status != 304) {
    head.content_length(answer.content().size());
  }
  head.keep_alive(keep_alive && !answer.stream);
  return serialized(head);
}

Answer answer_to(const Refusal& refusal) {
  const auto words = http::obsolete_reason(http::int_to_status(static_cast<unsigned>(refusal.status)));
  Answer out;
  out.status = refusal.status;
  out.type = "text/plain";
  out.body = std::string(words.data(), words.size()) + ": " + refusal.reason + "\n";
  if (refusal.reason == kPlainHttp) out.body += "This console speaks https only.\n";
  return out;
}

}  // namespace fathom::console
