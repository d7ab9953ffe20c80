#include "health/writers/writer_change.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "health/navigation/order_watch.hpp"
#include "unit/health/timeline.hpp"

namespace fathom::health {
namespace {

using ::testing::HasSubstr;

WriterGuid writer(std::uint8_t process, std::uint8_t entity = 1) {
  WriterGuid out{};
  out[0] = process;
  out[15] = entity;
  return out;
}

std::string describe(const WriterGuid& id) {
  return "process " + std::to_string(id[0]);
}

TEST(WriterChangeTest, AnotherProcessIsAnEventThatNamesBoth) {
  WriterChange watch({"fusion"});
  AlarmBook book("auv");
  const auto go = [&](double t, std::uint8_t process, std::uint8_t entity = 1) {
    watch.heard_imu("imu", writer(process, entity), at(t));
    watch.heard(nav(t), writer(static_cast<std::uint8_t>(10 + process), entity), at(t));
    watch.report(book, at(t), describe);
  };
  go(1.0, 1);
  go(2.0, 1, 2);  // a writer that follows another one of its process
  EXPECT_EQ(book.find("imu_writer_changed:imu"), nullptr);
  go(3.0, 2);
  const Alarm* imu = book.find("imu_writer_changed:imu");
  ASSERT_NE(imu, nullptr);
  EXPECT_EQ(imu->text, "Inertial unit imu comes from process 2 now, before it came from process 1.");
  EXPECT_FALSE(imu->acknowledged);
  const Alarm* navigation = book.find("nav_writer_changed");
  ASSERT_NE(navigation, nullptr);
  EXPECT_EQ(navigation->text,
            "The navigation state comes from process 12 now, before it came from process 11.");
  book.acknowledge("*");
  go(5.0, 2);
  EXPECT_EQ(book.find("nav_writer_changed"), nullptr);
}

TEST(WriterChangeTest, WhoWritesInBetweenIsNamed) {
  WriterChange watch({"fusion"});
  AlarmBook book("auv");
  watch.heard_imu("imu", writer(1), at(1.0));
  watch.report(book, at(1.0), describe);
  for (const std::uint8_t process : {2, 1, 2, 1}) watch.heard_imu("imu", writer(process), at(1.05));
  watch.report(book, at(1.1), describe);
  ASSERT_NE(book.find("imu_writer_changed:imu"), nullptr);
  EXPECT_EQ(book.find("imu_writer_changed:imu")->text,
            "Inertial unit imu comes from process 2 in turn with process 1.");
  for (const std::uint8_t process : {2, 1, 2}) watch.heard_imu("imu", writer(process), at(1.15));
  watch.report(book, at(1.2), describe);
  EXPECT_EQ(book.find("imu_writer_changed:imu")->text,
            "Inertial unit imu comes from process 2 now, before it came from process 1.");
}

TEST(WriterChangeTest, TwoThatWriteByTurnsFillNoLog) {
  WriterChange watch({"fusion"});
  AlarmBook book("auv");
  for (int i = 0; i < 600; ++i) {
    const double t = 1.0 + 0.1 * i;
    watch.heard_imu("imu", writer(static_cast<std::uint8_t>(1 + i % 2)), at(t));
    watch.report(book, at(t), describe);
  }
  // Each is raised and cleared.
  const std::size_t told = book.take_transitions().size() / 2;
  EXPECT_GE(told, 4U + 4U) << "a few are told each, later ones in their turn";
  EXPECT_LE(told, 4U + 6U);
}

TEST(WriterChangeTest, AFusionThatNobodyExpectsIsHeldWhileItIsHeard) {
  WriterChange watch({"fusion", "fusion_standby"});
  AlarmBook book("auv");
  const auto go = [&](double t, const Name& instance) {
    NavState state = nav(t);
    state.header.sensor = instance;
    watch.heard(state, writer(1), at(t));
    watch.report(book, at(t), describe);
    watch.report(book, at(t + 0.9), describe);
  };
  go(1.0, "fusion");
  go(2.0, "fusion_standby");
  EXPECT_EQ(book.find("nav_writer_unexpected"), nullptr);
  go(3.0, "fusion_b");
  ASSERT_NE(book.find("nav_writer_unexpected"), nullptr);
  EXPECT_TRUE(book.any_active(Severity::critical));
  EXPECT_THAT(book.find("nav_writer_unexpected")->text, HasSubstr("no service fusion_b is expected"));
  go(4.0, "fusion");
  EXPECT_FALSE(book.any_active(Severity::critical));
}

TEST(OrderWatchTest, JudgesByTheStateBeforeTheOrder) {
  OrderWatch watch;
  AlarmBook book("auv");
  for (int i = 0; i < 200; ++i) watch.add(nav(0.02 * i));
  NavState after = nav(4.01);
  Command order;
  order.header = header("anna", 4.0);
  order.kind = CommandKind::set_position;
  order.latitude_rad = after.latitude_rad += 1e-3;  // has taken the order in already
  order.longitude_rad = after.longitude_rad;
  order.sigma_m = 1.0;
  watch.add(nav(4.2));
  after.header = header("fusion", 4.3);
  watch.add(after);
  watch.apply(order, book, at(4.3));
  const Alarm* held = book.find("position_order_held");
  ASSERT_NE(held, nullptr);
  EXPECT_NEAR(held->value, 6360.0, 30.0);
  EXPECT_NEAR(held->limit, 6.0 * std::sqrt(3.0), 1e-9);
  EXPECT_THAT(held->text, HasSubstr("anna has ordered a position 63"));
  order.confirmed = true;
  watch.apply(order, book, at(4.4));
  ASSERT_NE(book.find("position_order_far"), nullptr);
  EXPECT_EQ(book.find("position_order_far")->severity, Severity::critical);
}

TEST(OrderWatchTest, NearPositionsAndUnknownOnesAreNoNews) {
  OrderWatch watch;
  AlarmBook book("auv");
  Command order;
  order.header = header("anna", 4.0);
  order.kind = CommandKind::set_position;
  order.latitude_rad = 0.6;
  order.longitude_rad = 2.2;
  order.sigma_m = 1.0;
  watch.apply(order, book, at(4.0));  // nothing was heard yet
  NavState lost = nav(3.0);
  lost.latitude_rad = lost.longitude_rad = kUnknown;
  watch.add(lost);
  watch.apply(order, book, at(4.0));
  watch.add(nav(3.9));
  watch.apply(order, book, at(4.0));
  EXPECT_TRUE(book.all().empty());
}

}  // namespace
}  // namespace fathom::health
