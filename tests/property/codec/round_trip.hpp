#pragma once

// What the round-trip tests of binary protocols share.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "codec/codec.hpp"

namespace fathom::test {

inline constexpr TimeNs kSomeTime_ns = 1'780'000'000'123'456'789;
inline constexpr int kRuns = 300;

class Collector : public codec::Sink {
 public:
  void on_sample(const codec::Decoded& decoded) override { samples.push_back(decoded); }
  void on_rejected(const codec::Rejected& rejected) override { rejects.push_back(rejected); }
  std::vector<codec::Decoded> samples;
  std::vector<codec::Rejected> rejects;
};

template <class Container>
std::vector<codec::Decoded> read(std::unique_ptr<codec::Codec> codec, const Container& bytes) {
  Collector sink;
  codec->feed({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, sink);
  codec->finish(sink);
  EXPECT_TRUE(sink.rejects.empty());
  EXPECT_EQ(codec->totals().skipped_bytes, 0U);
  return sink.samples;
}

class RoundTrip : public ::testing::Test {
 protected:
  double draw(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  std::array<double, 3> draw3(double limit) {
    return {draw(-limit, limit), draw(-limit, limit), draw(-limit, limit)};
  }
  bool chance(double p) { return draw(0.0, 1.0) < p; }

  DvlSample draw_dvl(DvlFrame frame) {
    DvlSample s;
    s.recorded_frame = frame;
    s.velocity_D_m_s = draw3(5.0);
    s.error_velocity_m_s = draw(-0.1, 0.1);
    s.beam_angle_rad = (chance(0.5) ? 20.0 : 30.0) * kRadPerDeg;
    s.altitude_m = draw(0.5, 900.0);
    s.beam_range_m.fill(s.altitude_m);
    s.sound_speed_m_s = std::floor(draw(1400.0, 1600.0));
    // What the leader can carry, so that turning back uses the same angles.
    s.heading_rad = std::floor(draw(0.0, 35'999.0)) * 0.01 * kRadPerDeg;
    s.pitch_rad = std::floor(draw(-4'000.0, 4'000.0)) * 0.01 * kRadPerDeg;
    s.roll_rad = std::floor(draw(-4'000.0, 4'000.0)) * 0.01 * kRadPerDeg;
    return s;
  }

 private:
  std::mt19937 random_{20'260'101};
};

inline void expect_same3(const std::array<double, 3>& a, const std::array<double, 3>& b, double relative,
                         double absolute) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], relative * std::abs(a[i]) + absolute);
}

}  // namespace fathom::test
