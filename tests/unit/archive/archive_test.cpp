#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "archive/covariance.hpp"
#include "archive/layout.hpp"
#include "archive/reader.hpp"
#include "archive/values.hpp"
#include "archive/writer.hpp"
#include "base/unknown.hpp"

namespace fathom::archive {
namespace {

enum class Colour : std::uint8_t { red, green, blue };

struct Part {
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self) {
    archive("count", self.count, kCount);
    archive("speed_m_s", self.speed_m_s, or_unknown(within(-10.0, 10.0)));
  }
  int count = 0;
  double speed_m_s = kUnknown;
};

struct Whole_ {
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self) {
    archive("on", self.on);
    archive("colour", self.colour, Colour::blue);
    archive("name", self.name);
    archive("stamp_ns", self.stamp_ns, kInstant);
    archive("sequence", self.sequence);
    archive("parts", self.parts);
    archive("v", self.v, finite());
    archive("either", self.either);
    archive("q", self.q);
    if (archive.since(2)) archive("later", self.later, within(0.0, 1.0));
  }
  bool on = false;
  Colour colour = Colour::red;
  Name name;
  TimeNs stamp_ns = 0;
  std::uint64_t sequence = 0;
  std::array<Part, 2> parts;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  std::variant<Part, geo::Geodetic> either;
  geo::Quaternion q;
  double later = 0.5;
};

Whole_ example() {
  Whole_ out;
  out.on = true;
  out.colour = Colour::green;
  out.name = "imu0";
  out.stamp_ns = -5;
  out.sequence = std::numeric_limits<std::uint64_t>::max();
  out.parts[1] = {7, 1.5};
  out.v = {1.0, -0.0, 1e-310};
  out.either = geo::Geodetic{0.1, 0.2, 300.0};
  return out;
}

std::vector<std::byte> bytes_of(const Whole_& value, std::uint32_t version = 2) {
  std::vector<std::byte> out;
  Writer writer(out, version);
  writer("it", value);
  return out;
}

std::string complaint(std::vector<std::byte> bytes) {
  Reader reader(bytes, 2);
  Whole_ out;
  reader("it", out);
  reader.expect_end();
  return reader.complaint();
}

TEST(Archive, ReadsWhatWasWrittenToTheBit) {
  const std::vector<std::byte> bytes = bytes_of(example());
  Reader reader(bytes, 2);
  Whole_ out;
  reader("it", out);
  reader.expect_end();
  ASSERT_TRUE(reader.good()) << reader.complaint();
  EXPECT_EQ(out.name, "imu0");
  EXPECT_EQ(out.stamp_ns, -5);
  EXPECT_TRUE(std::isnan(out.parts[0].speed_m_s));
  EXPECT_TRUE(std::signbit(out.v.y()));
  EXPECT_EQ(bytes_of(out), bytes);
}

TEST(Archive, IsLittleEndianOfFixedWidth) {
  std::vector<std::byte> out;
  Writer writer(out, 1);
  const std::int64_t stamp = 0x0102030405060708;
  writer("stamp", stamp, kAnyWhole);
  const Name name = "ab";
  writer("name", name);
  const std::vector<std::byte> expected{std::byte{8}, std::byte{7},   std::byte{6},  std::byte{5},
                                        std::byte{4}, std::byte{3},   std::byte{2},  std::byte{1},
                                        std::byte{2}, std::byte{'a'}, std::byte{'b'}};
  EXPECT_EQ(out, expected);
}

TEST(Archive, SaysWhichFieldIsWrongAndWhatWasExpected) {
  Whole_ bad = example();
  bad.parts[1].count = -5;
  EXPECT_EQ(complaint(bytes_of(bad)), "it.parts[1].count is -5, 0 to 1000000000 was expected");
  bad = example();
  bad.parts[0].speed_m_s = 11.0;
  EXPECT_EQ(complaint(bytes_of(bad)), "it.parts[0].speed_m_s is 11, -10 to 10, or unknown, was expected");
  bad = example();
  bad.v.z() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(complaint(bytes_of(bad)), "it.v[2] is inf, a finite number was expected");
  bad = example();
  bad.v.z() = kUnknown;
  EXPECT_EQ(complaint(bytes_of(bad)), "it.v[2] is nan, a finite number was expected");
  bad = example();
  bad.q.w = 0.5;
  EXPECT_EQ(complaint(bytes_of(bad)), "it.q: a quaternion of unit length was expected");
  bad = example();
  bad.stamp_ns = std::numeric_limits<TimeNs>::max();
  EXPECT_NE(complaint(bytes_of(bad)), "");
}

TEST(Archive, FlagsChoicesNamesAndKindsAreNeverOutOfRange) {
  const std::vector<std::byte> good = bytes_of(example());
  const auto with = [&](std::size_t at, int value) {
    std::vector<std::byte> bytes = good;
    bytes[at] = static_cast<std::byte>(value);
    return complaint(bytes);
  };
  EXPECT_EQ(with(0, 2), "it.on is 2, 0 to 1 was expected");
  EXPECT_EQ(with(1, 3), "it.colour is 3, 0 to 2 was expected");
  EXPECT_EQ(with(2, 32), "it.name is 32, 0 to 31 was expected");
  // on, colour, name, stamp, sequence, two parts, v.
  const std::size_t kind = 1 + 1 + 5 + 8 + 8 + 2 * 12 + 24;
  EXPECT_EQ(with(kind, 2), "it.either.kind is 2, 0 to 1 was expected");
}

TEST(Archive, EveryCutAndEveryByteTooManyIsNoticed) {
  std::vector<std::byte> bytes = bytes_of(example());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string found = complaint({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)});
    ASSERT_NE(found.find("cut off"), std::string::npos) << size << found;
  }
  bytes.push_back({});
  EXPECT_EQ(complaint(bytes), " is 1 bytes too long, its end was expected");
}

TEST(Archive, AVersionOfBeforeIsReadWithoutWhatCameLater) {
  const std::vector<std::byte> old = bytes_of(example(), 1);
  EXPECT_EQ(old.size() + 8, bytes_of(example(), 2).size());
  Reader reader(old, 1);
  Whole_ out;
  reader("it", out);
  reader.expect_end();
  EXPECT_TRUE(reader.good()) << reader.complaint();
  EXPECT_EQ(out.later, 0.5);
}

TEST(Archive, TheLayoutTellsFieldsApart) {
  const auto fingerprint = [](std::uint32_t version, const auto& value) {
    Layout out(version);
    out("it", value);
    return out.fingerprint();
  };
  const Whole_ one;
  EXPECT_EQ(fingerprint(2, one), fingerprint(2, example()));
  EXPECT_NE(fingerprint(1, one), fingerprint(2, one));
  const Part part;
  EXPECT_NE(fingerprint(2, part), fingerprint(2, one));
}

using Square = Eigen::Matrix3d;

bool covariance_like(const Square& p) {
  return is_covariance(p.data(), 3, 3);
}

TEST(Covariance, IsSymmetricAndPositive) {
  Square p = Eigen::Vector3d(1e12, 1.0, 1e-12).asDiagonal();
  EXPECT_TRUE(covariance_like(p));
  p(0, 1) = p(1, 0) = 0.999e6;
  EXPECT_TRUE(covariance_like(p));
  p(0, 1) = p(1, 0) = 1.001e6;
  EXPECT_FALSE(covariance_like(p)) << "a correlation above one";
  p(0, 1) = 0.5e6;
  EXPECT_FALSE(covariance_like(p)) << "not symmetric";
  EXPECT_TRUE(covariance_like(Square::Zero()));
  p = Eigen::Vector3d(1.0, -1e-20, 1.0).asDiagonal();
  EXPECT_FALSE(covariance_like(p));
  p = Eigen::Vector3d(1.0, 0.0, 1.0).asDiagonal();
  p(0, 1) = p(1, 0) = 1e-9;
  EXPECT_FALSE(covariance_like(p)) << "what is known exactly correlates with nothing";
  p = Square::Identity();
  p(0, 1) = p(1, 0) = p(0, 2) = p(2, 0) = 0.9;
  p(1, 2) = p(2, 1) = -0.9;
  EXPECT_FALSE(covariance_like(p)) << "each pair is possible, the three are not";
  p = Square::Identity();
  p(2, 2) = kUnknown;
  EXPECT_FALSE(covariance_like(p));
}

}  // namespace
}  // namespace fathom::archive
