#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "dataset/score.hpp"
#include "samples/alignment/help.hpp"
#include "samples/innovation_tally.hpp"
#include "samples/nav_state.hpp"
#include "samples/verdict.hpp"

/// What a report is made of, wherever it came from: a run over a data set, or a recording.
namespace fathom::report {

/// A navigation state as the page shows it. Times are seconds of the data set, angles radians.
struct StateRow {
  double t_s = 0.0;
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double altitude_m = kUnknown;
  std::array<double, 3> velocity_N_m_s{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> rpy_rad{kUnknown, kUnknown, kUnknown};
  std::array<double, 4> covariance_NE_m2{kUnknown, kUnknown, kUnknown, kUnknown};  ///< row-major
  std::array<double, 3> position_sigma_N_m{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> velocity_sigma_N_m_s{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> rpy_sigma_rad{kUnknown, kUnknown, kUnknown};
  NavMode mode = NavMode::none;
  double gps_outage_s = kUnknown;
  std::uint32_t resets = 0;
};
[[nodiscard]] StateRow row_of(const NavState& state, double t_s);

/// The error of a state against the reference, at a row of the states.
struct ErrorRow {
  double t_s = 0.0;
  dataset::NavError error;
  std::array<double, 3> position_sigma_N_m{kUnknown, kUnknown, kUnknown};
};

/// A final verdict, by what its plot needs. Innovations are divided by their sigmas.
struct Judged {
  double t_s = 0.0;
  VerdictKind kind = VerdictKind::used;
  std::uint8_t dimensions = 0;
  std::array<float, 3> normalised{};
  float test_ratio = 0.0F;
};
/// All verdicts of one aiding model on one source.
struct Source {
  SourceKind kind = SourceKind::gps;
  std::string sensor;
  std::string model;
  std::array<std::uint64_t, kVerdictKinds> counts{};
  InnovationTally innovations;
  std::vector<Judged> judged;  ///< at most kMostJudged, evenly thinned beyond
  std::uint64_t stride = 1;
  static constexpr std::size_t kMostJudged = 400'000;

  void add(const Verdict& verdict, double t_s);
  [[nodiscard]] std::uint64_t total() const;
  [[nodiscard]] std::uint64_t of(VerdictKind what) const { return counts[static_cast<std::size_t>(what)]; }
};

/// A stretch without fixes of GPS, and what was forecast of its end when it began.
struct Outage {
  double begin_s = 0.0;
  double end_s = 0.0;
  double sigma_before_m = kUnknown;  ///< horizontal
  double sigma_after_m = kUnknown;   ///< before the fix that ended it
  double forecast_95_m = kUnknown;
  double error_m = kUnknown;  ///< horizontal, against the reference
};

struct PhaseChange {
  double t_s = 0.0;
  AlignmentPhase phase = AlignmentPhase::none;
};

struct Place {
  double t_s = 0.0;
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
};

/// A service of the vehicle, by its life signs in a recording.
struct ServiceRow {
  std::string name;
  std::string host;
  double first_s = kUnknown;  ///< life sign
  double last_s = kUnknown;
  std::size_t processes = 0;       ///< more than one: it was started again
  double longest_silence_s = 0.0;  ///< between two of them
  double clock_set_s = 0.0;        ///< the farthest that its host's clock was set
  bool ended_early = false;        ///< it gave none up to the end
  std::string complaint;           ///< why it was not healthy; the first one
};

/// What the vehicle itself tells of the run.
struct Told {
  double t_s = 0.0;
  std::string text;
};

struct Material {
  std::string title;
  std::string source;
  std::string config;
  std::string config_hash;
  std::string version;
  double begin_s = kUnknown;  ///< of the inertial samples
  double end_s = kUnknown;
  std::uint64_t imu_samples = 0;
  double imu_step_s = kUnknown;                 ///< the middle one
  std::vector<std::array<double, 2>> imu_gaps;  ///< begin and length, s
  std::vector<StateRow> states;
  std::vector<ErrorRow> errors;
  dataset::Score score;
  std::vector<Place> reference;
  std::vector<Place> fixes;
  std::vector<Source> sources;
  std::vector<Outage> outages;
  std::vector<PhaseChange> phases;
  double start_heading_error_rad = 0.0;  ///< found and corrected; 0: nothing
  /// By sensor, how many times as much it scattered at most as is said of it; those that did as is said are
  /// left out.
  std::map<std::string, double> noise_factors;
  std::vector<FoundBias> biases;     ///< of the inertial unit, that are larger than is said of them
  std::vector<ServiceRow> services;  ///< of a recording, by name
  std::vector<Told> told;            ///< of a recording, the likeliest cause first
  /// Rows of each sensor in the data.
  std::map<std::string, std::uint64_t> samples;
};

/// What a person should look at, the worst first.
struct Finding {
  enum class Weight : std::uint8_t { bad, caution, good };
  Weight weight = Weight::good;
  std::string text;    ///< one or two sentences
  std::string anchor;  ///< the section that shows it
};
[[nodiscard]] std::vector<Finding> findings(const Material& material);

/// A whole page, without anything from elsewhere.
[[nodiscard]] std::string page(const Material& material);

}  // namespace fathom::report
