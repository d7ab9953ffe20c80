// Every message passes between fathom's bus and Cyclone DDS unharmed, both ways, and a node is found as such.

#include "bus/ros2/wire.hpp"

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/ros2/node.hpp"
#include "integration/ros2/peer.hpp"
#include "ros2/interface/description.hpp"
#include "ros2/messages/graph.hpp"
#include "ros2/messages/sensors.hpp"
#include "support/presence.hpp"

namespace fathom {
namespace {

using ros2::Distro;
using ::testing::Contains;
using ::testing::HasSubstr;

/// Gives every field another value.
struct Filler {
  int next = 1;

  template <class T>
  void operator()(const char* /*name*/, T& value) {
    fill(value);
  }

 private:
  template <class T>
  void fill(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      value = next++ % 2 == 0;
    } else if constexpr (std::is_floating_point_v<T>) {
      value = static_cast<T>(next++) + T{0.25};
    } else if constexpr (std::is_arithmetic_v<T>) {
      value = static_cast<T>(next++);
    } else if constexpr (std::is_same_v<T, std::string>) {
      value = std::string(static_cast<std::size_t>(next % 5), 'x') + std::to_string(next);
      ++next;
    } else if constexpr (std::is_same_v<T, ros2::Octet>) {
      value.value = static_cast<std::uint8_t>(next++);
    } else {
      T::fields(*this, value);
    }
  }
  template <class T, std::size_t N>
  void fill(std::array<T, N>& values) {
    for (T& value : values) fill(value);
  }
  template <class T>
  void fill(std::vector<T>& values) {
    values.resize(3);
    for (T& value : values) fill(value);
  }
};

template <class Message>
std::string bytes_of(const Message& message) {
  std::vector<char> room(65'536);
  room.resize(bus::ros2::encode(message, room));
  return {room.begin(), room.end()};
}

bus::ParticipantOptions graph_presence(std::uint32_t domain) {
  bus::ParticipantOptions out = test::presence(domain, "ros2_test");
  out.user_data = bus::ros2::kUserData;
  return out;
}

template <class Message>
void passes_through_cyclone(const char* type) {
  constexpr std::uint32_t kDomain = 70;
  bus::Participant participant(graph_presence(kDomain));
  bus::ros2::Node node(participant, {"/", "wire_test", Distro::jazzy});
  std::mutex mutex;
  std::optional<Message> received;
  bus::ros2::Publisher<Message> out(node, "/wire/out", bus::ros2::Quality::reliable);
  bus::ros2::Subscription<Message> back(node, "/wire/back", bus::ros2::Quality::reliable,
                                        [&](const Message& message, const bus::SampleInfo&) {
                                          const std::lock_guard lock(mutex);
                                          received = message;
                                        });
  const test::Peer peer("echo", kDomain, {type, "rt/wire/out", "rt/wire/back"});
  Message sent;
  Filler filler;
  Message::fields(filler, sent);
  ASSERT_TRUE(test::wait_until(
      [&] {
        EXPECT_TRUE(out.publish(sent));
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        const std::lock_guard lock(mutex);
        return received.has_value();
      },
      20.0))
      << type;
  const std::lock_guard lock(mutex);
  EXPECT_EQ(bytes_of(*received), bytes_of(sent)) << type;
  EXPECT_EQ(participant.counters().invalid_sample, 0U);
  EXPECT_EQ(participant.counters().incompatible_qos, 0U);
}

TEST(Ros2Wire, PassesThroughCyclone) {
  passes_through_cyclone<ros2::Odometry>("odometry");
  passes_through_cyclone<ros2::Imu>("imu");
  passes_through_cyclone<ros2::NavSatFix>("fix");
  passes_through_cyclone<ros2::FluidPressure>("pressure");
  passes_through_cyclone<ros2::Dvl>("dvl");
  passes_through_cyclone<ros2::TwistWithCovarianceStamped>("twist");
  passes_through_cyclone<ros2::PoseWithCovarianceStamped>("pose");
  passes_through_cyclone<ros2::GeoPoseStamped>("geopose");
  passes_through_cyclone<ros2::TFMessage>("tf");
  passes_through_cyclone<ros2::DiagnosticArray>("diagnostics");
}

// Whatever the bytes are: nothing throws, nothing takes memory that is not there.
TEST(Ros2Wire, RefusesBytesThatAreNoMessage) {
  ros2::DiagnosticArray message;
  Filler filler;
  ros2::DiagnosticArray::fields(filler, message);
  const std::string whole = bytes_of(message);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    ros2::DiagnosticArray out;
    EXPECT_FALSE(bus::ros2::decode<ros2::DiagnosticArray>(cut, out)) << length;
  }
  unsigned seed = 1;
  for (int i = 0; i < 20'000; ++i) {
    std::vector<char> changed(whole.begin(), whole.end());
    for (int k = 0; k < 4; ++k) {
      seed = seed * 1'664'525U + 1'013'904'223U;
      changed[4 + (seed >> 8U) % (changed.size() - 4)] = static_cast<char>(seed >> 24U);
    }
    ros2::DiagnosticArray out;
    (void)bus::ros2::decode<ros2::DiagnosticArray>(changed, out);
    EXPECT_LE(out.status.size(), changed.size());
  }
}

TEST(Ros2Wire, SaysWhatItCannotSend) {
  bus::Participant participant(graph_presence(70));
  bus::ros2::Node node(participant, {"/", "wire_test", Distro::jazzy});
  bus::ros2::Publisher<ros2::Imu> out(node, "/wire/large", bus::ros2::Quality::reliable);
  ros2::Imu message;
  message.header.frame_id = std::string(4000, 'x');
  EXPECT_FALSE(out.publish(message));
  EXPECT_EQ(participant.counters().write_failed, 1U);
  message.header.frame_id = "imu_link";
  EXPECT_TRUE(out.publish(message));
  EXPECT_THROW((bus::ros2::Publisher<ros2::Dvl>(node, "/wire/large", bus::ros2::Quality::reliable)),
               bus::BusError);
}

void is_found(Distro distro, std::uint32_t domain) {
  bus::Participant participant(graph_presence(domain));
  bus::ros2::Node node(participant, {"/auv", "the_node", distro});
  bus::ros2::Publisher<ros2::Odometry> odometry(node, "/auv/odometry", bus::ros2::Quality::reliable);
  bus::ros2::Publisher<ros2::TFMessage> gone(node, "/auv/gone", bus::ros2::Quality::latched);
  auto short_lived = std::make_unique<bus::ros2::Publisher<ros2::Imu>>(node, "/auv/short_lived",
                                                                       bus::ros2::Quality::reliable);
  bus::ros2::Subscription<ros2::Imu> imu(node, "/imu/data", bus::ros2::Quality::sensor_data,
                                         [](const ros2::Imu&, const bus::SampleInfo&) {});
  short_lived.reset();
  test::Peer peer("graph", domain, {}, distro == Distro::humble);
  const std::string text = peer.output();
  std::vector<std::string> writers;
  std::vector<std::string> readers;
  std::string of_node;
  std::map<std::string, std::vector<std::string>> publications;
  std::map<std::string, std::vector<std::string>> subscriptions;
  std::map<std::string, std::string> discovered;
  for (const std::string& line : test::lines_of(text)) {
    const std::vector<std::string> words = test::words_of(line);
    if (words[0] == "writer") writers.push_back(words[1]);
    if (words[0] == "reader") readers.push_back(words[1]);
    if (words[0] == "participant") of_node = words[1];
    if (words[0] == "publication") publications[words[1]] = words;
    if (words[0] == "subscription") subscriptions[words[1]] = words;
    if (words[0] == "discovered") discovered[words[1]] = words.size() > 2 ? words[2] : "";
  }
  EXPECT_THAT(text, HasSubstr("node /auv the_node\n"));
  EXPECT_THAT(text, Not(HasSubstr("not-zero")));
  ASSERT_EQ(writers.size(), 2U) << text;
  ASSERT_EQ(readers.size(), 1U) << text;
  EXPECT_THAT(discovered[of_node], HasSubstr("enclave=/;")) << text;
  const auto hash = [&](const char* type) {
    return "typehash=" + ros2::type_hash(ros2::interfaces_of(distro), type).value() + ";";
  };
  const auto expect = [&](const std::vector<std::string>& found, const char* topic, const char* type) {
    ASSERT_GE(found.size(), 4U) << topic << "\n" << text;
    EXPECT_EQ(found[2], topic);
    EXPECT_EQ(found[3], ros2::dds_type_name(type));
    if (distro == Distro::humble) {
      EXPECT_EQ(found.size(), 4U) << "Humble has no hashes";
    } else {
      ASSERT_EQ(found.size(), 5U) << text;
      EXPECT_EQ(found[4], hash(type));
    }
  };
  expect(subscriptions[readers[0]], "rt/imu/data", "sensor_msgs/msg/Imu");
  const bool first = publications[writers[0]].size() > 2 && publications[writers[0]][2] == "rt/auv/odometry";
  expect(publications[writers[first ? 0 : 1]], "rt/auv/odometry", "nav_msgs/msg/Odometry");
  expect(publications[writers[first ? 1 : 0]], "rt/auv/gone", "tf2_msgs/msg/TFMessage");
}

TEST(Ros2Graph, HasTheNodeOfJazzy) {
  is_found(Distro::jazzy, 71);
}
TEST(Ros2Graph, HasTheNodeOfHumble) {
  is_found(Distro::humble, 72);
}

}  // namespace
}  // namespace fathom
