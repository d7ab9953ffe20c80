#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"

/// The WebSocket protocol of Foxglove, version 1, as far as a server needs it that only tells: texts that it
/// says, texts that it hears, and the head of a message. Pure.
namespace fathom::foxglove {

/// Subprotocols that we speak, in the words of the handshake. They agree in what is used here.
inline constexpr std::array<std::string_view, 2> kSubprotocols{"foxglove.websocket.v1", "foxglove.sdk.v1"};
/// The first of what a client offers ("a, b") that we speak; empty when there is none.
[[nodiscard]] std::string_view chosen_subprotocol(std::string_view offered);

/// A topic on offer.
struct Channel {
  std::uint32_t id = 0;
  std::string topic;
  std::string schema_name;  ///< of the message's type, e.g. fathom::v1::NavState
  std::string schema;       ///< its definition in IDL that needs nothing else
};

[[nodiscard]] std::string server_info(std::string_view name, std::string_view session);
/// That these are on offer, encoded as cdr with schemas in omgidl.
[[nodiscard]] std::string advertisement(const std::vector<Channel>& channels);
/// What a person who looks at the client has to know.
[[nodiscard]] std::string warning(std::string_view text);

struct Subscription {
  std::uint32_t id = 0;
  std::uint32_t channel = 0;
};
/// What a client asks for.
struct Wish {
  std::vector<Subscription> subscribe;
  std::vector<std::uint32_t> unsubscribe;
};
inline constexpr std::size_t kMostWishes = 1024;  ///< in one text

/// A text of a client. What we do not offer (services, parameters, messages of its own) is an empty wish. The
/// error says what was wrong and what was expected.
[[nodiscard]] Result<Wish> wish_of(std::string_view text);

/// What stands before the bytes of a message.
using MessageHead = std::array<std::uint8_t, 13>;
[[nodiscard]] MessageHead message_head(std::uint32_t subscription, TimeNs received_ns);

}  // namespace fathom::foxglove
