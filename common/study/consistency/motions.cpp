#include "study/consistency/motions.hpp"

#include <cmath>
#include <numbers>

#include "base/units.hpp"
#include "sim/random.hpp"
#include "study/instruments.hpp"

namespace fathom::study::motions {
namespace {

constexpr double kEver_s = 3600.0;
constexpr double kRest_s = 60.0;
constexpr double kDive_s = 180.0;

struct Chance {
  explicit Chance(std::uint64_t seed) : random(seed, "motion") {}
  double heading() { return random.uniform(-std::numbers::pi, std::numbers::pi); }
  double phase() { return random.uniform(0.0, 2.0 * std::numbers::pi); }
  double sign() { return random.chance(0.5) ? 1.0 : -1.0; }
  sim::Random random;
};

/// Half-degree motion of a hull in small waves.
void rock(Manoeuvres& m, Chance& chance, double amplitude_rad) {
  m.bank_rad.swing(amplitude_rad, 3.1, chance.phase());
  m.pitch_rad.swing(0.6 * amplitude_rad, 4.3, chance.phase());
  m.heading_rad.swing(0.3 * amplitude_rad, 7.9, chance.phase());
}

Manoeuvres submersible(Chance& chance) {
  Manoeuvres m;
  m.heading_rad = Profile(chance.heading());
  m.sway_per_turn_m = 0.4;
  m.medium_N_m_s = {chance.random.normal(0.2), chance.random.normal(0.2)};
  m.medium_share = Profile(0.0).step(kRest_s, 10.0, 1.0);
  rock(m, chance, 0.3 * kRadPerDeg);
  return m;
}

void surface_run(Manoeuvres& m, double from_s, double turn_sign) {
  m.speed_m_s.step(from_s, 10.0, 2.0);
  for (double t = from_s + 20.0; t < kDive_s - 25.0; t += 25.0)
    m.heading_rad.step(t, 14.0, turn_sign * 90.0 * kRadPerDeg);
}

/// Down with 15 degrees of pitch for ten metres or so.
void dive(Manoeuvres& m) {
  m.pitch_rad.step(kDive_s, 6.0, -15.0 * kRadPerDeg).step(kDive_s + 20.0, 6.0, 15.0 * kRadPerDeg);
}

void lawn(Manoeuvres& m) {
  double side = 1.0;
  for (double t = kDive_s + 60.0; t < kEver_s; t += 90.0) {
    m.heading_rad.step(t, 20.0, side * 90.0 * kRadPerDeg).step(t + 30.0, 20.0, side * 90.0 * kRadPerDeg);
    side = -side;
  }
}

Manoeuvres aircraft(Chance& chance) {
  Manoeuvres m;
  m.heading_rad = Profile(chance.heading());
  m.coordinated = true;
  m.angle_of_attack_rad = 3.0 * kRadPerDeg;
  m.pitch_rad = Profile(3.0 * kRadPerDeg);
  m.speed_m_s = Profile(45.0);
  m.medium_N_m_s = {chance.random.normal(4.0), chance.random.normal(4.0)};
  m.bank_rad.swing(1.0 * kRadPerDeg, 2.7, chance.phase());
  m.pitch_rad.swing(0.5 * kRadPerDeg, 3.9, chance.phase());
  return m;
}

void circuit(Manoeuvres& m, double from_s, double side) {
  for (double t = from_s; t < kEver_s; t += 60.0) m.heading_rad.step(t, 16.0, side * 90.0 * kRadPerDeg);
  for (double t = from_s + 100.0; t < kEver_s; t += 200.0)
    m.pitch_rad.step(t, 8.0, 5.0 * kRadPerDeg).step(t + 40.0, 8.0, -5.0 * kRadPerDeg);
}

Manoeuvres car(Chance& chance, double slope_rad) {
  Manoeuvres m;
  m.heading_rad = Profile(chance.heading());
  m.bank_rad = Profile(chance.random.normal(1.0 * kRadPerDeg));
  m.pitch_rad = Profile(chance.random.normal(1.0 * kRadPerDeg));
  m.pitch_rad.swing(slope_rad, 97.0, chance.phase());
  m.bank_rad.swing(0.4 * kRadPerDeg, 1.9, chance.phase());
  m.pitch_rad.swing(0.3 * kRadPerDeg, 1.3, chance.phase());
  return m;
}

/// Goes from one random height to the next: smooth, and with the spectrum of noise at its lowest frequencies.
/// The root of its mean square is `rms`, its spectrum at zero that of noise of `rms` lasting `lasts_s`.
void wander(Profile& out, sim::Random& random, double rms, double lasts_s) {
  constexpr double kShare = 0.8096;  // mean of s^2 + (1 - s)^2, s the step of a profile
  const double over_s = kShare * lasts_s;
  const double sigma = rms / std::sqrt(kShare);
  double height = 0.0;
  for (double t = 0.0; t < kEver_s; t += over_s) {
    const double next = random.normal(sigma);
    out.step(t, over_s, next - height);
    height = next;
  }
}

/// A unit ahead of the rear axle and mounted askew, on springs. Slip and bounce are as large as the filter is
/// told, and slip lasts as long; springs swing.
void roll_on_wheels(Manoeuvres& m, std::uint64_t seed) {
  sim::Random random(seed, "wheels");
  wander(m.slip_m_s, random, kWheels_m_s, kWheelsLast_s);
  for (const double period_s : {0.7, 0.9, 1.1})
    m.bounce_m_s.swing(kWheels_m_s * std::sqrt(2.0 / 3.0), period_s,
                       random.uniform(0.0, 2.0 * std::numbers::pi));
  m.sway_per_turn_m = -(kAheadOfAxle_m + random.normal(kAxleKnown_m));
  m.angle_of_attack_rad = random.normal(kWheelsAskew_rad);
  m.crab_rad = random.normal(kWheelsAskew_rad);
}

void town_turns(Manoeuvres& m, Chance& chance, double from_s) {
  for (double t = from_s; t < kEver_s; t += 40.0) {
    m.heading_rad.step(t, 7.0, chance.sign() * 90.0 * kRadPerDeg);
    m.speed_m_s.step(t - 6.0, 6.0, -6.0).step(t + 8.0, 7.0, 6.0);
  }
}

}  // namespace

Manoeuvres survey_straight(std::uint64_t seed) {
  Chance chance(seed);
  Manoeuvres m = submersible(chance);
  surface_run(m, kRest_s, chance.sign());
  dive(m);
  return m;
}

Manoeuvres survey_lawn(std::uint64_t seed) {
  Chance chance(seed);
  Manoeuvres m = submersible(chance);
  surface_run(m, kRest_s, chance.sign());
  dive(m);
  lawn(m);
  return m;
}

Manoeuvres survey_yoyo(std::uint64_t seed) {
  Chance chance(seed);
  Manoeuvres m = submersible(chance);
  surface_run(m, kRest_s, chance.sign());
  dive(m);
  double side = 1.0;
  for (double t = kDive_s + 60.0; t < kEver_s; t += 60.0, side = -side)
    m.pitch_rad.step(t, 8.0, -20.0 * side * kRadPerDeg).step(t + 25.0, 8.0, 20.0 * side * kRadPerDeg);
  for (double t = kDive_s + 100.0; t < kEver_s; t += 180.0) m.heading_rad.step(t, 25.0, 60.0 * kRadPerDeg);
  return m;
}

Manoeuvres survey_under_way(std::uint64_t seed) {
  Chance chance(seed);
  Manoeuvres m = submersible(chance);
  m.speed_m_s = Profile(2.0);
  m.medium_share = Profile(1.0);
  const double side = chance.sign();
  for (double t = 30.0; t < kDive_s - 25.0; t += 25.0) m.heading_rad.step(t, 14.0, side * 90.0 * kRadPerDeg);
  dive(m);
  lawn(m);
  return m;
}

Manoeuvres boat_in_swell(std::uint64_t seed) {
  Chance chance(seed);
  Manoeuvres m = submersible(chance);
  m.speed_m_s = Profile(4.0);
  m.medium_share = Profile(1.0);
  const double side = chance.sign();
  for (double t = 40.0; t < kEver_s; t += 70.0) m.heading_rad.step(t, 20.0, side * 75.0 * kRadPerDeg);
  for (const double period_s : {6.1, 7.7, 9.4}) {
    m.heave_m_s.swing(0.5, period_s, chance.phase());
    m.bank_rad.swing(3.0 * kRadPerDeg, period_s, chance.phase());
    m.pitch_rad.swing(2.0 * kRadPerDeg, period_s, chance.phase());
  }
  return m;
}

Manoeuvres flight_straight(std::uint64_t seed) {
  Chance chance(seed);
  return aircraft(chance);
}

Manoeuvres flight_circuit(std::uint64_t seed) {
  Chance chance(seed);
  Manoeuvres m = aircraft(chance);
  circuit(m, 60.0, chance.sign());
  return m;
}

Manoeuvres flight_banks(std::uint64_t seed) {
  Chance chance(seed);
  Manoeuvres m = aircraft(chance);
  double side = chance.sign();
  for (double t = 90.0; t < kEver_s; t += 60.0, side = -side)
    m.heading_rad.step(t, 30.0, side * 330.0 * kRadPerDeg);
  return m;
}

Manoeuvres flight_aerobatic(std::uint64_t seed) {
  Chance chance(seed);
  Manoeuvres m = aircraft(chance);
  double side = chance.sign();
  for (double t = 60.0; t < kEver_s; t += 120.0, side = -side) {
    m.bank_rad.step(t, 6.0, side * 360.0 * kRadPerDeg);
    m.pitch_rad.step(t + 15.0, 6.0, 57.0 * kRadPerDeg).step(t + 23.0, 8.0, -57.0 * kRadPerDeg);
    m.heading_rad.step(t + 45.0, 14.0, side * 270.0 * kRadPerDeg);
    m.bank_rad.step(t + 75.0, 4.0, -side * 90.0 * kRadPerDeg).step(t + 81.0, 4.0, side * 90.0 * kRadPerDeg);
    m.heading_rad.step(t + 95.0, 16.0, -side * 180.0 * kRadPerDeg);
  }
  return m;
}

Manoeuvres flight_from_runway(std::uint64_t seed) {
  Chance chance(seed);
  Manoeuvres m = aircraft(chance);
  m.speed_m_s = Profile(0.0).step(kRest_s, 20.0, 45.0);
  m.medium_share = Profile(0.0).step(kRest_s + 18.0, 6.0, 1.0);
  m.pitch_rad = Profile(3.0 * kRadPerDeg).step(kRest_s + 16.0, 6.0, 8.0 * kRadPerDeg);
  m.pitch_rad.step(kRest_s + 50.0, 8.0, -8.0 * kRadPerDeg);
  m.bank_rad = Profile(0.0);
  circuit(m, kRest_s + 70.0, chance.sign());
  return m;
}

Manoeuvres drive_town(std::uint64_t seed) {
  Chance chance(seed);
  Manoeuvres m = car(chance, 1.0 * kRadPerDeg);
  m.speed_m_s = Profile(11.0);
  town_turns(m, chance, 40.0);
  return m;
}

Manoeuvres drive_highway(std::uint64_t seed) {
  Chance chance(seed);
  Manoeuvres m = car(chance, 1.0 * kRadPerDeg);
  m.bank_rad = Profile(chance.random.normal(1.0 * kRadPerDeg));
  m.pitch_rad = Profile(chance.random.normal(1.0 * kRadPerDeg));
  m.speed_m_s = Profile(0.0).step(kRest_s, 15.0, 30.0);
  const double side = chance.sign();
  for (double t = kRest_s + 60.0; t < kEver_s; t += 80.0)
    m.heading_rad.step(t, 30.0, side * 40.0 * kRadPerDeg).step(t + 40.0, 30.0, -side * 25.0 * kRadPerDeg);
  for (double t = kRest_s + 100.0; t < kEver_s; t += 120.0)
    m.speed_m_s.step(t, 6.0, -10.0).step(t + 20.0, 15.0, 10.0);
  return m;
}

Manoeuvres roll_through_town(std::uint64_t seed) {
  Manoeuvres m = drive_town(seed);
  roll_on_wheels(m, seed);
  return m;
}

Manoeuvres roll_on_highway(std::uint64_t seed) {
  Manoeuvres m = drive_highway(seed);
  roll_on_wheels(m, seed);
  return m;
}

Manoeuvres drive_mountain(std::uint64_t seed) {
  Chance chance(seed);
  Manoeuvres m = car(chance, 7.0 * kRadPerDeg);
  m.speed_m_s = Profile(14.0);
  double side = chance.sign();
  for (double t = 45.0; t < kEver_s; t += 35.0, side = -side) {
    m.heading_rad.step(t, 12.0, side * 165.0 * kRadPerDeg);
    m.speed_m_s.step(t - 6.0, 6.0, -8.0).step(t + 13.0, 7.0, 8.0);
  }
  return m;
}

Manoeuvres roll_in_mountains(std::uint64_t seed) {
  Manoeuvres m = drive_mountain(seed);
  roll_on_wheels(m, seed);
  return m;
}

}  // namespace fathom::study::motions
