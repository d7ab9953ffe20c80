#include "study/registry.hpp"

#include "study/alignment.hpp"
#include "study/consistency/consistency.hpp"
#include "study/gps_outage/gps_outage.hpp"
#include "study/hydro/hydro_study.hpp"
#include "study/rotating_arm/rotating_arm.hpp"
#include "study/starts/starts.hpp"
#include "study/survey/survey.hpp"

namespace fathom::study {

const std::vector<std::unique_ptr<const Study>>& study_registry() {
  static const auto all = [] {
    std::vector<std::unique_ptr<const Study>> studies;
    studies.push_back(std::make_unique<const AlignmentStudy>());
    studies.push_back(make_consistency_study());
    studies.push_back(make_starts_study());
    studies.push_back(make_gps_outage_study());
    studies.push_back(make_rotating_arm_study());
    studies.push_back(make_survey_study());
    studies.push_back(std::make_unique<HydroStudy>());
    return studies;
  }();
  return all;
}

const Study* find_study(std::string_view name) {
  for (const auto& study : study_registry())
    if (study->name() == name) return study.get();
  return nullptr;
}

}  // namespace fathom::study
