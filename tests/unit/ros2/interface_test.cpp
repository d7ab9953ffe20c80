// Interfaces of ROS 2: their IDL, and the hashes that ROS 2 publishes for them.

#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ros2/interface/description.hpp"
#include "ros2/messages/graph.hpp"
#include "ros2/messages/sensors.hpp"

namespace fathom::ros2 {
namespace {

using ::testing::HasSubstr;

struct Known {
  const char* type;
  const char* hash;
};

class KnownHash : public ::testing::TestWithParam<Known> {};

// As published for Iron, Jazzy and later.
INSTANTIATE_TEST_SUITE_P(
    Of, KnownHash,
    ::testing::Values(
        Known{"std_msgs/msg/String", "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"},
        Known{"std_msgs/msg/Header", "f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01"},
        Known{"builtin_interfaces/msg/Time",
              "b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197"},
        Known{"sensor_msgs/msg/Imu", "7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b"},
        Known{"sensor_msgs/msg/NavSatFix",
              "62223ab3fe210a15976021da7afddc9e200dc9ec75231c1b6a557fc598a65404"},
        Known{"sensor_msgs/msg/NavSatStatus",
              "d1ed3befa628e09571bd273b888ba1c1fd187c9a5e0006b385d7e5e9095a3204"},
        Known{"nav_msgs/msg/Odometry", "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"},
        Known{"geometry_msgs/msg/PoseWithCovarianceStamped",
              "26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e"},
        Known{"geometry_msgs/msg/PoseWithCovariance",
              "9a7c0fd234b7f45c6098745ecccd773ca1085670e64107135397aee31c02e1bb"},
        Known{"geometry_msgs/msg/Pose", "d501954e9476cea2996984e812054b68026ae0bfae789d9a10b23daf35cc90fa"},
        Known{"geometry_msgs/msg/Point", "6963084842a9b04494d6b2941d11444708d892da2f4b09843b9c43f42a7f6881"},
        Known{"geometry_msgs/msg/Quaternion",
              "8a765f66778c8ff7c8ab94afcc590a2ed5325a1d9a076ffff38fbce36f458684"},
        Known{"geometry_msgs/msg/Vector3",
              "cc12fe83e4c02719f1ce8070bfd14aecd40f75a96696a67a2a1f37f7dbb0765d"},
        Known{"geometry_msgs/msg/Twist", "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a"},
        Known{"geometry_msgs/msg/TwistWithCovariance",
              "49f574f033f095d8b6cd1beaca5ca7925e296e84af1716d16c89d38b059c8c18"},
        Known{"geometry_msgs/msg/Transform",
              "beb83fbe698636351461f6f35d1abb20010c43d55374d81bd041f1ba2581fddc"},
        Known{"geometry_msgs/msg/TransformStamped",
              "0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206"},
        Known{"tf2_msgs/msg/TFMessage", "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
        Known{"geometry_msgs/msg/TwistWithCovarianceStamped",
              "77b67434531e6529b7a0091357b186b6ebdb17fd9ffd3e0c7ce9d3fb11a44563"},
        Known{"diagnostic_msgs/msg/DiagnosticArray",
              "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"},
        Known{"sensor_msgs/msg/FluidPressure",
              "22dfb2b145a0bd5a31a1ac3882a1b32148b51d9b2f3bab250290d66f3595bc32"},
        Known{"rmw_dds_common/msg/ParticipantEntitiesInfo",
              "91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"}));

TEST_P(KnownHash, IsWhatTheIdlGives) {
  const auto hash = type_hash(interfaces_of(Distro::jazzy), GetParam().type);
  ASSERT_TRUE(hash.ok()) << hash.error().message;
  EXPECT_EQ(hash.value(), std::string("RIHS01_") + GetParam().hash);
}

TEST(TypeHash, IsThereForEveryInterface) {
  for (const Distro distro : {Distro::humble, Distro::jazzy, Distro::kilted}) {
    EXPECT_EQ(interfaces_of(distro).size(), 30U);
    for (const auto& [name, type] : interfaces_of(distro)) {
      EXPECT_TRUE(type_hash(interfaces_of(distro), name).ok()) << name;
    }
  }
}

TEST(TypeHash, NamesWhatIsNotThere) {
  const auto incomplete =
      parse_idl("module a { module msg { module dds_ { struct B_ { c::msg::dds_::D_ d; }; }; }; };");
  ASSERT_TRUE(incomplete.ok()) << incomplete.error().message;
  const auto hash = type_hash(incomplete.value(), "a/msg/B");
  ASSERT_FALSE(hash.ok());
  EXPECT_THAT(hash.error().message, HasSubstr("a/msg/B: is made of c/msg/D"));
  EXPECT_THAT(type_hash(incomplete.value(), "a/msg/E").error().message, HasSubstr("a/msg/E"));
}

TEST(Humble, HasLongerIdentities) {
  EXPECT_EQ(interfaces_of(Distro::humble).at("rmw_dds_common/msg/Gid").fields.at(0).capacity, 24U);
  EXPECT_EQ(interfaces_of(Distro::kilted).at("rmw_dds_common/msg/Gid").fields.at(0).capacity, 16U);
}

TEST(ParseIdl, UnderstandsEveryKindOfField) {
  const auto found = parse_idl(R"(
    // comment
    #include "other.idl"
    module p { module msg { module dds_ {
      @final struct Part_ { octet o; };
      struct All_ {
        boolean b; int8 i8; uint8 u8; short i16; unsigned short u16; long i32; unsigned long u32;
        long long i64; unsigned long long u64; float f; double d; string s; string<12> bs;
        double array[7]; sequence<Part_> list; sequence<Part_, 5> most; q::msg::dds_::Other_ far;
      };
    }; }; };)");
  ASSERT_TRUE(found.ok()) << found.error().message;
  const auto& fields = found.value().at("p/msg/All").fields;
  const std::vector<FieldDescription> expected{
      {"b", Basic::boolean, Container::none, 0, 0, ""},
      {"i8", Basic::int8, Container::none, 0, 0, ""},
      {"u8", Basic::uint8, Container::none, 0, 0, ""},
      {"i16", Basic::int16, Container::none, 0, 0, ""},
      {"u16", Basic::uint16, Container::none, 0, 0, ""},
      {"i32", Basic::int32, Container::none, 0, 0, ""},
      {"u32", Basic::uint32, Container::none, 0, 0, ""},
      {"i64", Basic::int64, Container::none, 0, 0, ""},
      {"u64", Basic::uint64, Container::none, 0, 0, ""},
      {"f", Basic::float32, Container::none, 0, 0, ""},
      {"d", Basic::float64, Container::none, 0, 0, ""},
      {"s", Basic::string, Container::none, 0, 0, ""},
      {"bs", Basic::bounded_string, Container::none, 0, 12, ""},
      {"array", Basic::float64, Container::array, 7, 0, ""},
      {"list", Basic::nested, Container::sequence, 0, 0, "p/msg/Part"},
      {"most", Basic::nested, Container::bounded_sequence, 5, 0, "p/msg/Part"},
      {"far", Basic::nested, Container::none, 0, 0, "q/msg/Other"}};
  EXPECT_EQ(fields, expected);
}

TEST(ParseIdl, SaysWhereItStopped) {
  const auto message = [](const char* text) {
    const auto found = parse_idl(text);
    return found.ok() ? std::string("understood") : found.error().message;
  };
  EXPECT_EQ(message("module a {\n union B {};\n};"), "line 2: is union, expected module or struct");
  EXPECT_EQ(message("struct A { double x; }"), "line 1: the text ends, expected ;");
  EXPECT_EQ(message("struct A { double x[0]; };"), "line 1: is 0, expected a number above 0");
  EXPECT_EQ(message("struct A {\ndouble x[99999999999]; };"),
            "line 2: is 99999999999, expected a number above 0");
  EXPECT_EQ(message("struct A { unsigned double x; };"), "line 1: is double, expected short or long");
  EXPECT_EQ(message("struct A { double x; }; struct A { double y; };"),
            "line 1: the text ends, expected A only once");
  EXPECT_EQ(message("struct A { };"), "line 1: the text ends, expected fields in A");
  EXPECT_EQ(message("struct A { sequence<double> x[3]; };"), "line 1: is 3, expected no array of sequences");
}

TEST(DdsTypeName, IsMangled) {
  EXPECT_EQ(dds_type_name("sensor_msgs/msg/Imu"), "sensor_msgs::msg::dds_::Imu_");
}

/// Describes a plain message by what fields() shows of it.
struct Describer {
  TypeDescription out;

  template <class T>
  void operator()(const char* name, const T& value) {
    FieldDescription field;
    field.name = name;
    describe(field, value);
    out.fields.push_back(field);
  }

 private:
  template <class T>
  static void describe(FieldDescription& field, const T& /*value*/) {
    if constexpr (std::is_same_v<T, bool>)
      field.basic = Basic::boolean;
    else if constexpr (std::is_same_v<T, std::int8_t>)
      field.basic = Basic::int8;
    else if constexpr (std::is_same_v<T, std::uint8_t>)
      field.basic = Basic::uint8;
    else if constexpr (std::is_same_v<T, std::uint16_t>)
      field.basic = Basic::uint16;
    else if constexpr (std::is_same_v<T, std::int32_t>)
      field.basic = Basic::int32;
    else if constexpr (std::is_same_v<T, std::uint32_t>)
      field.basic = Basic::uint32;
    else if constexpr (std::is_same_v<T, float>)
      field.basic = Basic::float32;
    else if constexpr (std::is_same_v<T, double>)
      field.basic = Basic::float64;
    else if constexpr (std::is_same_v<T, std::string>)
      field.basic = Basic::string;
    else if constexpr (std::is_same_v<T, Octet>)
      field.basic = Basic::byte;
    else
      field.nested_type = T::kType;
  }
  template <class T, std::size_t N>
  static void describe(FieldDescription& field, const std::array<T, N>& /*values*/) {
    describe(field, T{});
    field.container = Container::array;
    field.capacity = N;
  }
  template <class T>
  static void describe(FieldDescription& field, const std::vector<T>& /*values*/) {
    describe(field, T{});
    field.container = Container::sequence;
  }
};

template <class Message>
void expect_as_in_the_idl(Distro distro) {
  Describer describer;
  const Message message;
  Message::fields(describer, message);
  const auto found = interfaces_of(distro).find(Message::kType);
  ASSERT_NE(found, interfaces_of(distro).end()) << Message::kType;
  std::vector<FieldDescription> idl = found->second.fields;
  for (FieldDescription& field : idl) {  // a bound is no matter of the plain value
    if (field.basic == Basic::bounded_string) field.basic = Basic::string;
    field.string_capacity = 0;
  }
  EXPECT_EQ(describer.out.fields, idl) << Message::kType;
}

TEST(PlainMessages, HaveTheFieldsOfTheIdl) {
  const Distro d = Distro::jazzy;
  expect_as_in_the_idl<Time>(d);
  expect_as_in_the_idl<Header>(d);
  expect_as_in_the_idl<Vector3>(d);
  expect_as_in_the_idl<Point>(d);
  expect_as_in_the_idl<Quaternion>(d);
  expect_as_in_the_idl<Pose>(d);
  expect_as_in_the_idl<PoseWithCovariance>(d);
  expect_as_in_the_idl<PoseWithCovarianceStamped>(d);
  expect_as_in_the_idl<Twist>(d);
  expect_as_in_the_idl<TwistWithCovariance>(d);
  expect_as_in_the_idl<TwistWithCovarianceStamped>(d);
  expect_as_in_the_idl<Transform>(d);
  expect_as_in_the_idl<TransformStamped>(d);
  expect_as_in_the_idl<TFMessage>(d);
  expect_as_in_the_idl<Odometry>(d);
  expect_as_in_the_idl<GeoPoint>(d);
  expect_as_in_the_idl<GeoPose>(d);
  expect_as_in_the_idl<GeoPoseStamped>(d);
  expect_as_in_the_idl<Imu>(d);
  expect_as_in_the_idl<NavSatStatus>(d);
  expect_as_in_the_idl<NavSatFix>(d);
  expect_as_in_the_idl<FluidPressure>(d);
  expect_as_in_the_idl<Dvl>(d);
  expect_as_in_the_idl<KeyValue>(d);
  expect_as_in_the_idl<DiagnosticStatus>(d);
  expect_as_in_the_idl<DiagnosticArray>(d);
  expect_as_in_the_idl<Gid<16>>(d);
  expect_as_in_the_idl<NodeEntitiesInfo<16>>(d);
  expect_as_in_the_idl<ParticipantEntitiesInfo<16>>(d);
  expect_as_in_the_idl<Gid<24>>(Distro::humble);
}

}  // namespace
}  // namespace fathom::ros2
