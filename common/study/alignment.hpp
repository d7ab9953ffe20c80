#pragma once

#include "study/study.hpp"

namespace fathom::study {

/// In-motion alignment of a vehicle dropped from an aircraft, with the autopilot regulating the navigated
/// attitude: the coarse method as published, its printed form behind the engine's own conditions, its robust
/// form, and the fine one on top of it.
class AlignmentStudy final : public Study {
 public:
  [[nodiscard]] std::string_view name() const override { return "alignment"; }
  [[nodiscard]] std::string_view description() const override {
    return "roll and pitch of a vehicle dropped from an aircraft, found while it runs";
  }
  [[nodiscard]] std::vector<std::string_view> cases() const override;
  [[nodiscard]] std::vector<std::string_view> methods() const override;
  [[nodiscard]] std::vector<Metric> metrics() const override;
  [[nodiscard]] int default_runs() const override { return 100; }
  void run(const RunRequest& request, Scores& scores) const override;
};

}  // namespace fathom::study
