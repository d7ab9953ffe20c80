// No struct of an engine's state forgets a field: what fields() names or leaves out on purpose covers it.

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "archive/reader.hpp"
#include "archive/writer.hpp"
#include "estimation/fields/imu_preprocessor.hpp"
#include "estimation/fields/measurement.hpp"
#include "estimation/fields/navigator.hpp"

namespace fathom::estimation {
namespace {

/// Notes which bytes of an object are named.
class Coverage : public archive::Visitor<Coverage> {
 public:
  static constexpr bool kReads = false;

  explicit Coverage(const void* object) : begin_(static_cast<const char*>(object)) {}

  [[nodiscard]] static bool since(std::uint32_t /*version*/) { return true; }
  void flag(const char* /*name*/, const bool& value) { note(value); }
  template <class T>
  void whole(const char* /*name*/, const T& value, archive::Whole /*limit*/ = {}) {
    note(value);
  }
  void number(const char* /*name*/, const double& value, archive::Range /*limit*/) { note(value); }
  template <class T>
  void choice(const char* /*name*/, const T& value, std::type_identity_t<T> /*last*/) {
    note(value);
  }
  void name(const char* /*name*/, const Name& value) { note(value); }
  template <class... T>
  void alternative(const std::variant<T...>& value) {
    note(value);
  }
  void open(const char* /*name*/, std::size_t /*index*/) {}
  void close() {}
  template <class T>
  void left_out(const T& value) {
    note(value);
  }

  /// Bytes in the middle or at the end that nobody named and no alignment explains.
  [[nodiscard]] std::string holes(std::size_t size, std::size_t aligned) {
    std::sort(named_.begin(), named_.end());
    named_.emplace_back(size, size);
    std::string out;
    std::size_t reached = 0;
    for (const auto& [first, end] : named_) {
      if (first > reached && !padding(reached, first, aligned))
        out += std::to_string(first - reached) + " bytes at " + std::to_string(reached) + "; ";
      reached = std::max(reached, end);
    }
    return out;
  }

 private:
  static bool padding(std::size_t first, std::size_t end, std::size_t aligned) {
    for (std::size_t alignment = 2; alignment <= aligned; alignment *= 2)
      if (end % alignment == 0 && end - first < alignment) return true;
    return false;
  }
  template <class T>
  void note(const T& value) {
    const auto* at = reinterpret_cast<const char*>(&value);
    // What is not part of the object, as a local that stands for one, does not count.
    if (at < begin_ || at - begin_ > 1'000'000) return;
    const auto first = static_cast<std::size_t>(at - begin_);
    named_.emplace_back(first, first + sizeof(T));
  }

  const char* begin_;
  std::vector<std::pair<std::size_t, std::size_t>> named_;
};

template <class T>
std::string holes(const T& object) {
  Coverage coverage(&object);
  coverage("it", object);
  return coverage.holes(sizeof(T), alignof(T));
}

TEST(StateFields, NoneIsForgotten) {
  const EngineConfig config;
  const estimation::Setup setup(config);
  const Navigator navigator(setup);
  EXPECT_EQ(holes(navigator), "");
  EXPECT_EQ(holes(navigator.filter()), "");
  EXPECT_EQ(holes(Instrument()), "");
  EXPECT_EQ(holes(RestWindow()), "");
  EXPECT_EQ(holes(DropAlignment()), "");
  EXPECT_EQ(holes(StabilityGate()), "");
  EXPECT_EQ(holes(TiltFilter()), "");
  EXPECT_EQ(holes(SpeedTrack()), "");
  EXPECT_EQ(holes(UnderWay()), "");
  EXPECT_EQ(holes(hydro::WaterVelocity()), "");
  EXPECT_EQ(holes(ImuPreprocessor(setup)), "");
  EXPECT_EQ(holes(ImuStep()), "");
  EXPECT_EQ(holes(Measurement()), "");
}

TEST(StateFields, NoneOfASampleIsForgotten) {
  EXPECT_EQ(holes(Command()), "");
  EXPECT_EQ(holes(GpsSample()), "");
  EXPECT_EQ(holes(DvlSample()), "");
  EXPECT_EQ(holes(DepthSample()), "");
  EXPECT_EQ(holes(HeadingSample()), "");
  EXPECT_EQ(holes(UsblSample()), "");
  EXPECT_EQ(holes(AirspeedSample()), "");
  EXPECT_EQ(holes(PropulsionSample()), "");
  EXPECT_EQ(holes(FinsSample()), "");
}

TEST(StateFields, OfAnOlderStateConsiderAnewWhatThatDidNotHold) {
  EngineConfig config;
  config.sensors = {default_sensor(SourceKind::gps, "gps"), default_sensor(SourceKind::usbl, "usbl"),
                    default_sensor(SourceKind::range, "modem")};
  const estimation::Setup setup(config);
  Navigator navigator(setup);
  navigator.start(InitialState{}, kNsPerSecond);
  const std::array<std::pair<std::uint32_t, int>, 3> ends{{{3, setup.index.estimated()},
                                                           {18, setup.index.of(Group::usbl_bias)},
                                                           {19, setup.index.of(Group::beacon_place)}}};
  int held = 0;
  for (const auto& [version, later] : ends) {
    ASSERT_GT(later, held);
    held = later;
    std::vector<std::byte> image;
    archive::Writer writer(image, version);
    writer("navigator", navigator);
    archive::Reader reader(image);
    reader.set_version(version);
    Navigator read(setup);
    reader("navigator", read);
    ASSERT_TRUE(reader.good()) << reader.complaint();
    for (int i = 0; i < setup.index.size(); ++i) {
      for (int j = 0; j < i; ++j)
        EXPECT_EQ(read.filter()(i, j), i < later ? navigator.filter()(i, j) : 0.0) << i << " " << j;
      const double begins = setup.initial_sigma[static_cast<std::size_t>(i)];
      EXPECT_EQ(read.filter()(i, i), i < later ? navigator.filter()(i, i) : begins * begins) << i;
    }
  }
}

struct Forgetful {
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self) {
    archive("a", self.a, fathom::archive::finite());
    archive("c", self.c, fathom::archive::finite());
  }
  double a = 0.0;
  double b = 0.0;
  double c = 0.0;
};

TEST(StateFields, AForgottenOneIsNoticed) {
  EXPECT_EQ(holes(Forgetful()), "8 bytes at 8; ");
}

}  // namespace
}  // namespace fathom::estimation
