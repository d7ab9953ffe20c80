#pragma once

#include "study/study.hpp"

namespace fathom::study {

/// The hydrodynamics-embedded filter: as printed, with what it lacks, and its idea as a virtual velocity log
/// of the fusion engine, against inertial navigation and DVL-aided navigation without a model.
///
/// A REMUS 100 with an autopilot runs 199 s with small turns, or surveys lanes and loses its DVL after 150 s
/// for 300 s. IMU 1 deg/h, 0.05 deg/sqrt(h), 0.5 mg; DVL 10 Hz, 0.01 m/s, 0.3 %; tilt 1 deg, heading 1.5 deg
/// handed over.
class HydroStudy final : public Study {
 public:
  [[nodiscard]] std::string_view name() const override { return "hydro"; }
  [[nodiscard]] std::string_view description() const override;
  [[nodiscard]] std::vector<std::string_view> cases() const override;
  [[nodiscard]] std::vector<std::string_view> methods() const override;
  [[nodiscard]] std::vector<Metric> metrics() const override;
  [[nodiscard]] int default_runs() const override { return 25; }
  void run(const RunRequest& request, Scores& scores) const override;
};

}  // namespace fathom::study
