#include "orders/order.hpp"

#include <cmath>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace fathom::orders {
namespace {

Command command_of(std::string_view text) {
  const auto order = order_of(text);
  EXPECT_TRUE(order) << text;
  return order ? std::get<Command>(order.value()) : Command{};
}
ToldFix told_of(std::string_view text) {
  const auto order = order_of(text);
  EXPECT_TRUE(order) << text;
  return order ? std::get<ToldFix>(order.value()) : ToldFix{};
}
std::string fault_of(std::string_view text) {
  const auto order = order_of(text);
  return order ? "" : order.error().message;
}

TEST(Order, OfEachKindBecomesItsCommand) {
  const Command acknowledge = command_of(R"({"kind": "acknowledge_alarm", "target": "gps_outage"})");
  EXPECT_EQ(acknowledge.kind, CommandKind::acknowledge_alarm);
  EXPECT_EQ(acknowledge.target, Name("gps_outage"));
  EXPECT_EQ(command_of(R"({"kind": "realign"})").kind, CommandKind::realign);
  EXPECT_EQ(command_of(R"({"kind": "enable_source", "target": "gps"})").kind, CommandKind::enable_source);
  EXPECT_EQ(command_of(R"({"kind": "disable_source", "target": "gps"})").kind, CommandKind::disable_source);
  const Command position = command_of(
      R"({"kind": "set_position", "lat_deg": 36.4, "lon_deg": -127.4, "depth_m": 5, "sigma_m": 10})");
  EXPECT_EQ(position.kind, CommandKind::set_position);
  EXPECT_NEAR(position.latitude_rad, 36.4 * M_PI / 180, 1e-12);
  EXPECT_NEAR(position.longitude_rad, -127.4 * M_PI / 180, 1e-12);
  EXPECT_EQ(position.depth_m, 5);
  EXPECT_EQ(describe(position), "set_position 36.400000 deg N -127.400000 deg E depth 5.0 m sigma 10.0 m");
  EXPECT_FALSE(position.confirmed);
  const Command meant = command_of(
      R"({"kind": "set_position", "lat_deg": 1, "lon_deg": 2, "depth_m": 5, "sigma_m": 10, "confirmed": true})");
  EXPECT_TRUE(meant.confirmed);
}

TEST(Order, OfAToldPositionIsNoCommand) {
  const ToldFix told =
      told_of(R"({"kind": "fix", "lat_deg": 36.4, "lon_deg": -127.4, "sigma_m": 20, "age_s": 600})");
  EXPECT_NEAR(told.fix.latitude_rad, 36.4 * M_PI / 180, 1e-12);
  EXPECT_NEAR(told.fix.longitude_rad, -127.4 * M_PI / 180, 1e-12);
  EXPECT_EQ(told.fix.sigma_m, 20.0);
  EXPECT_EQ(told.fix.header.sensor, Name("operator"));
  EXPECT_FALSE(known(told.fix.depth_m));
  EXPECT_EQ(told.age_s, 600.0);
  EXPECT_EQ(describe(told), "fix of operator 36.400000 deg N -127.400000 deg E sigma 20.0 m, 600 s ago");
  const ToldFix deep =
      told_of(R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2, "sigma_m": 5, "depth_m": 12, "from": "ship"})");
  EXPECT_EQ(deep.fix.depth_m, 12.0);
  EXPECT_EQ(deep.fix.header.sensor, Name("ship"));
  EXPECT_EQ(deep.age_s, 0.0);
}

TEST(Order, OfAToldPositionIsStampedWhenTheVehicleWasThere) {
  const ToldFix told = told_of(R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2, "sigma_m": 5, "age_s": 600})");
  SampleHeader header;
  header.vehicle = "auv";
  header.sensor = "console";
  const FixSample sample = sample_of(told, header, 1'000 * kNsPerSecond);
  EXPECT_EQ(sample.header.vehicle, Name("auv"));
  EXPECT_EQ(sample.header.sensor, Name("operator"));
  EXPECT_EQ(sample.header.received_ns, 1'000 * kNsPerSecond);
  EXPECT_EQ(sample.header.stamp_ns, 400 * kNsPerSecond);
  EXPECT_EQ(sample.sigma_m, 5.0);
}

TEST(Order, ThatIsNotExactlyOneIsRefused) {
  for (const char* bad :
       {"",
        "{",
        "[]",
        "null",
        R"({"kind": 5})",
        R"({"kind": "self_destruct"})",
        R"({"kind": "mark_at_rest", "value_s": 5})",
        R"({"kind": "realign", "target": "gps"})",
        R"({"kind": "enable_source"})",
        R"({"kind": "enable_source", "target": ""})",
        R"({"kind": "enable_source", "target": "a name that is far too long for a sensor"})",
        R"({"kind": "enable_source", "target": "two words"})",
        R"({"kind": "set_position", "lat_deg": 91, "lon_deg": 0, "depth_m": 0, "sigma_m": 1})",
        R"({"kind": "set_position", "lat_deg": 1, "lon_deg": 0, "depth_m": 0})",
        R"({"kind": "set_position", "lat_deg": 1, "lon_deg": 0, "depth_m": 0, "sigma_m": 1, "confirmed": 1})",
        R"({"kind": "realign", "confirmed": true})",
        R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2})",
        R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2, "sigma_m": 0})",
        R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2, "sigma_m": 5, "age_s": -1})",
        R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2, "sigma_m": 5, "age_s": 7201})",
        R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2, "sigma_m": 5, "from": "two words"})",
        R"({"kind": "set_position", "lat_deg": "1", "lon_deg": 0, "depth_m": 0, "sigma_m": 1})",
        R"({"kind": "set_position", "lat_deg": 1, "lon_deg": 0, "depth_m": 0, "sigma_m": 0})"}) {
    EXPECT_NE(fault_of(bad), "") << bad;
  }
}

TEST(Order, WithAKeyThatItDoesNotKnowIsRefusedByName) {
  const auto order = order_of(R"({"kind": "enable_source", "source": "gps"})");
  ASSERT_FALSE(order);
  EXPECT_EQ(order.error().message,
            "The order enable_source does not know the key \"source\", expected kind, target.");
}

TEST(Order, WithAKeyThatStandsTwiceIsRefusedByName) {
  EXPECT_EQ(
      fault_of(
          R"({"kind": "set_position", "lat_deg": 1, "lon_deg": 0, "depth_m": 0, "sigma_m": 5, "lat_deg": 36})"),
      "lat_deg: is given twice, expected each key once.");
  EXPECT_NE(fault_of(R"({"kind": "realign", "kind": "realign"})"), "");
}

TEST(Order, IsJudgedInWords) {
  EXPECT_EQ(fault_of(std::string(100'000, '[')).find("0.0.0"), 0U);
  EXPECT_EQ(fault_of(R"({"kind": "set_position", "lat_deg": 1e400})"),
            "lat_deg: is 1e400, expected a number between -1.8e308 and 1.8e308.");
  EXPECT_NE(fault_of("{\"kind\"").find("syntax error"), std::string::npos);
}

TEST(Order, OfAPositionSaysThatItWaitsOrMayWait) {
  const std::string place =
      R"("kind": "set_position", "lat_deg": 36.4, "lon_deg": 127.4, "depth_m": 5, "sigma_m": 10)";
  const Command order = command_of("{" + place + "}");
  const Command confirmed = command_of("{" + place + R"(, "confirmed": true})");
  const health::Departure far{900.0, 60.0};
  EXPECT_TRUE(waits_for_confirmation(order, far));
  EXPECT_EQ(
      waiting_text(order, far),
      "This position lies 900 m from where navigation is, and 60 m are expected at most. It is held for "
      "60 s, until it is confirmed.");

  EXPECT_FALSE(waits_for_confirmation(order, std::nullopt)) << "fusion decides";
  EXPECT_NE(waiting_text(order, std::nullopt).find("has not been heard here"), std::string::npos);

  const health::Departure near{50.0, 60.0};
  EXPECT_FALSE(waits_for_confirmation(order, near));
  EXPECT_EQ(waiting_text(order, near), "");
  for (const auto& departure : {std::optional(far), std::optional<health::Departure>()}) {
    EXPECT_FALSE(waits_for_confirmation(confirmed, departure));
    EXPECT_EQ(waiting_text(confirmed, departure), "");
  }
  EXPECT_EQ(waiting_text(command_of(R"({"kind": "realign"})"), std::nullopt), "");
}

}  // namespace
}  // namespace fathom::orders
