// Which instrument stands behind a measurement.
#include "estimation/navigator/instruments.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "estimation/aiding/registry.hpp"
#include "geo/wgs84.hpp"

namespace fathom::estimation {
namespace {

class BehindBeacons : public ::testing::Test {
 protected:
  static EngineConfig config() {
    EngineConfig out;
    out.sensors = {default_sensor(SourceKind::range, "modem"), default_sensor(SourceKind::range, "other"),
                   default_sensor(SourceKind::usbl, "usbl")};
    return out;
  }
  Instrument* of(const EventSample& sample, int sensor, TimeNs stamp_ns = 1) {
    Measurement one;
    one.sensor = sensor;
    one.source = source_of(sample);
    one.sample = sample;
    Instrument& instrument = instruments_.behind(setup_, one);
    instrument.stamp_ns = stamp_ns;
    return &instrument;
  }
  Instrument* range(const Name& address, double north_m = kUnknown, int sensor = 0, TimeNs stamp_ns = 1) {
    const geo::Geodetic place = geo::moved_by({0.6, 0.2, 0.0}, {north_m, 0.0, 0.0});
    RangeSample sample;
    sample.beacon = address;
    sample.beacon_latitude_rad = place.latitude_rad;
    sample.beacon_longitude_rad = place.longitude_rad;
    return of(sample, sensor, stamp_ns);
  }

  estimation::Setup setup_{config()};
  Instruments instruments_{setup_};
};

TEST_F(BehindBeacons, AnAddressTellsThemApart) {
  Instrument* const first = range("1", 0.0);
  EXPECT_NE(range("2", 0.0), first);
  EXPECT_NE(range("1", 0.0, 1), first);
  EXPECT_EQ(range("1", 5'000.0), first);  // it has moved, or nobody knows where it is
  EXPECT_EQ(range("1"), first);
}

TEST_F(BehindBeacons, WithoutAnAddressThePlaceDoes) {
  Instrument* const first = range({}, 0.0);
  EXPECT_NE(range({}, 500.0), first);
  EXPECT_EQ(range({}, 80.0), first);
  EXPECT_EQ(range({}, 160.0), first);  // one that drifts
  EXPECT_EQ(range({}), &instruments_.sensors[0]);
}

TEST_F(BehindBeacons, AnInvertedAcousticFixIsOfOneAndAnotherOfNone) {
  UsblSample sample;
  sample.transponder = "3";
  for (const UsblFrame frame : {UsblFrame::geodetic, UsblFrame::ned, UsblFrame::vessel_frd}) {
    sample.frame = frame;
    EXPECT_EQ(of(sample, 2), &instruments_.sensors[2]);
  }
  sample.frame = UsblFrame::vehicle_frd;
  Instrument* const third = of(sample, 2);
  EXPECT_NE(third, &instruments_.sensors[2]);
  sample.transponder = "4";
  EXPECT_NE(of(sample, 2), third);
}

TEST_F(BehindBeacons, TheOneThatWasNotHeardForLongestMakesRoom) {
  std::set<Instrument*> all;
  for (int i = 0; i < kMaxBeacons; ++i) {
    Instrument* const one = range(std::string_view(std::to_string(i)), kUnknown, 0, 100 + i);
    one->rejections[0].count = 1 + i;
    all.insert(one);
  }
  EXPECT_EQ(all.size(), static_cast<std::size_t>(kMaxBeacons));
  Instrument* const second = range("1", kUnknown, 0, 200);
  EXPECT_EQ(second->rejections[0].count, 2);
  Instrument* const late = range("late", kUnknown, 0, 201);
  EXPECT_EQ(late->rejections[0].count, 0);
  EXPECT_EQ(range("1")->rejections[0].count, 2);
  EXPECT_EQ(range("0")->rejections[0].count, 0);  // forgotten
}

TEST_F(BehindBeacons, ACopyHoldsThoseOfTheOriginalAndNoOther) {
  range("1")->rejections[0].count = 7;
  const Instruments before = instruments_;
  range("2")->rejections[0].count = 8;
  Instruments copy = instruments_;
  EXPECT_EQ(copy.beacon_count, 2U);
  EXPECT_EQ(copy.beacons[1].instrument.rejections[0].count, 8);
  copy = before;
  EXPECT_EQ(copy.beacon_count, 1U);
  EXPECT_EQ(copy.beacons[0].instrument.rejections[0].count, 7);
  EXPECT_EQ(copy.beacons[1].instrument.rejections[0].count, 0);
  EXPECT_EQ(copy.beacons[1].sensor, -1);
}

}  // namespace
}  // namespace fathom::estimation
