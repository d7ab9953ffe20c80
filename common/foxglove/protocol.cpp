#include "foxglove/protocol.hpp"

#include <algorithm>
#include <limits>

#include <nlohmann/json.hpp>

#include "base/bytes/little_endian.hpp"

namespace fathom::foxglove {
namespace {

using nlohmann::json;

constexpr std::uint8_t kMessageData = 1;
constexpr int kLevelWarning = 1;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

bool is_id(const json& value) {
  return value.is_number_unsigned() &&
         value.get<std::uint64_t>() <= std::numeric_limits<std::uint32_t>::max();
}

}  // namespace

std::string_view chosen_subprotocol(std::string_view offered) {
  while (!offered.empty()) {
    const std::size_t comma = offered.find(',');
    const std::string_view one = trimmed(offered.substr(0, comma));
    const auto* known = std::find(kSubprotocols.begin(), kSubprotocols.end(), one);
    if (known != kSubprotocols.end()) return *known;
    offered = comma == std::string_view::npos ? std::string_view{} : offered.substr(comma + 1);
  }
  return {};
}

std::string server_info(std::string_view name, std::string_view session) {
  return json{{"op", "serverInfo"},
              {"name", name},
              {"capabilities", json::array()},
              {"supportedEncodings", json::array()},
              {"metadata", json::object()},
              {"sessionId", session}}
      .dump();
}

std::string advertisement(const std::vector<Channel>& channels) {
  json list = json::array();
  for (const Channel& one : channels)
    list.push_back({{"id", one.id},
                    {"topic", one.topic},
                    {"encoding", "cdr"},
                    {"schemaName", one.schema_name},
                    {"schema", one.schema},
                    {"schemaEncoding", "omgidl"}});
  return json{{"op", "advertise"}, {"channels", std::move(list)}}.dump();
}

std::string warning(std::string_view text) {
  return json{{"op", "status"}, {"level", kLevelWarning}, {"message", text}}.dump(
      -1, ' ', false, json::error_handler_t::replace);
}

Result<Wish> wish_of(std::string_view text) {
  const json said = json::parse(text.begin(), text.end(), nullptr, false);
  if (!said.is_object() || !said.contains("op") || !said["op"].is_string())
    return Error{"the text is no object with \"op\""};
  Wish wish;
  const auto op = said["op"].get<std::string>();
  if (op != "subscribe" && op != "unsubscribe") return wish;
  const char* key = op == "subscribe" ? "subscriptions" : "subscriptionIds";
  if (!said.contains(key) || !said[key].is_array()) return Error{op + " needs the list \"" + key + "\""};
  if (said[key].size() > kMostWishes)
    return Error{op + " has " + std::to_string(said[key].size()) + " entries, expected " +
                 std::to_string(kMostWishes) + " at most"};
  for (const json& one : said[key]) {
    if (op == "unsubscribe") {
      if (!is_id(one)) return Error{"\"subscriptionIds\" holds what is no number of 32 bits"};
      wish.unsubscribe.push_back(one.get<std::uint32_t>());
    } else {
      if (!one.is_object() || !one.contains("id") || !one.contains("channelId") || !is_id(one["id"]) ||
          !is_id(one["channelId"]))
        return Error{"\"subscriptions\" holds what has no \"id\" and \"channelId\" of 32 bits"};
      wish.subscribe.push_back({one["id"].get<std::uint32_t>(), one["channelId"].get<std::uint32_t>()});
    }
  }
  return wish;
}

MessageHead message_head(std::uint32_t subscription, TimeNs received_ns) {
  MessageHead out{kMessageData};
  store_le<std::uint32_t>(out, 1, subscription);
  store_le<std::uint64_t>(out, 5, static_cast<std::uint64_t>(received_ns));
  return out;
}

}  // namespace fathom::foxglove
