#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "health/navigation/order_watch.hpp"
#include "timeline.hpp"

namespace fathom::health {
namespace {

using testing::HasSubstr;

ServiceStatus sign(std::uint64_t orders_not_done, std::uint32_t pid = 100) {
  ServiceStatus status;
  status.header.sensor = "fusion";
  status.pid = pid;
  status.counters.push_back({"orders_not_done", orders_not_done});
  return status;
}

TEST(OrderRefused, EachOrderThatFusionDidNotDoIsAnEventWithWhoGaveIt) {
  OrderWatch watch;
  AlarmBook book;
  watch.add(sign(3), book, at(0.0));
  EXPECT_EQ(book.find("order_refused"), nullptr) << "of before the monitor was there";
  Command order;
  order.header = header("console:anna", 1.0);
  order.kind = CommandKind::disable_source;
  order.target = "gps";
  watch.apply(order, book, at(1.0));
  Command acknowledgement;
  acknowledgement.header = header("console:bert", 1.5);
  watch.apply(acknowledgement, book, at(1.5));
  watch.add(sign(3), book, at(2.0));
  EXPECT_EQ(book.find("order_refused"), nullptr);
  watch.add(sign(4), book, at(3.0));
  const Alarm* alarm = book.find("order_refused");
  ASSERT_NE(alarm, nullptr);
  EXPECT_THAT(alarm->text, HasSubstr("fusion has not done an order"));
  EXPECT_THAT(alarm->text, HasSubstr("disable_source gps of console:anna"));
  EXPECT_EQ(book.acknowledge("order_refused"), 1);
  EXPECT_EQ(book.find("order_refused"), nullptr);
  watch.add(sign(4), book, at(4.0));
  EXPECT_EQ(book.find("order_refused"), nullptr) << "said once";
  watch.add(sign(1, 101), book, at(5.0));
  EXPECT_NE(book.find("order_refused"), nullptr) << "of a fusion that was started again";
}

}  // namespace
}  // namespace fathom::health
