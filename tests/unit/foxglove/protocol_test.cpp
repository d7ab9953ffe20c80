// The texts of the Foxglove WebSocket protocol.

#include "foxglove/protocol.hpp"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fathom::foxglove {
namespace {

TEST(FoxgloveProtocol, AMessageHasItsHead) {
  const MessageHead head = message_head(0x04030201, 0x0C0B0A0908070605);
  for (std::size_t i = 0; i < head.size(); ++i) EXPECT_EQ(head[i], i == 0 ? 1 : i) << i;
}

TEST(FoxgloveProtocol, TheServerSaysWhatItHas) {
  const auto said =
      nlohmann::json::parse(advertisement({{3, "fathom/v1/x", "fathom::v1::X", "module \"quoted\"\n"}}));
  EXPECT_EQ(said.at("op"), "advertise");
  const auto& channel = said.at("channels").at(0);
  EXPECT_EQ(channel.at("id"), 3);
  EXPECT_EQ(channel.at("encoding"), "cdr");
  EXPECT_EQ(channel.at("schemaEncoding"), "omgidl");
  EXPECT_EQ(channel.at("schema"), "module \"quoted\"\n");
  const auto info = nlohmann::json::parse(server_info("auv", "7"));
  EXPECT_EQ(info.at("op"), "serverInfo");
  EXPECT_TRUE(info.at("capabilities").empty());
  EXPECT_EQ(info.at("sessionId"), "7");
  EXPECT_TRUE(nlohmann::json::accept(warning("not \xFF utf-8")));
}

TEST(FoxgloveProtocol, AWishIsReadStrictly) {
  const auto wish = wish_of(
      R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2},{"id":4294967295,"channelId":0}]})");
  ASSERT_TRUE(wish.ok());
  ASSERT_EQ(wish.value().subscribe.size(), 2U);
  EXPECT_EQ(wish.value().subscribe[1].id, 4'294'967'295U);
  EXPECT_EQ(wish_of(R"({"op":"unsubscribe","subscriptionIds":[1,2,3]})").value().unsubscribe.size(), 3U);
  EXPECT_TRUE(wish_of(R"({"op":"getParameters","parameterNames":[]})").value().subscribe.empty())
      << "not on offer, no harm";
  for (const char* bad :
       {"", "[]", "{}", R"({"op":7})", R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":{}})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":2}]})",
        R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":2}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1}]})",
        R"({"op":"unsubscribe","subscriptionIds":["1"]})"}) {
    EXPECT_FALSE(wish_of(bad).ok()) << bad;
  }
  std::string many = R"({"op":"unsubscribe","subscriptionIds":[0)";
  for (std::size_t i = 0; i < kMostWishes; ++i) many += ",1";
  EXPECT_FALSE(wish_of(many + "]}").ok());
}

TEST(FoxgloveProtocol, TheFirstSubprotocolThatWeSpeakIsChosen) {
  EXPECT_EQ(chosen_subprotocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(chosen_subprotocol("other, foxglove.sdk.v1 ,foxglove.websocket.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(chosen_subprotocol(""), "");
  EXPECT_EQ(chosen_subprotocol("foxglove.websocket.v2"), "");
}

}  // namespace
}  // namespace fathom::foxglove
