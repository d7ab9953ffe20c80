#include "study/survey/survey_usbl.hpp"

namespace fathom::study {
namespace {

constexpr double kUsblShare = 0.01;
constexpr double kUsblFloor_m = 0.3;
constexpr double kUsblLatency_s = 2.0;

}  // namespace

void add_survey_usbl(sim::Scenario& scenario) {
  sim::UsblConfig& usbl = scenario.sensors.of<UsblSample>();
  usbl.enabled = true;
  usbl.rate_hz = 0.2;
  usbl.range_fraction = kUsblShare;
  usbl.floor_m = kUsblFloor_m;
  usbl.latency_s = usbl.maximum_latency_s = kUsblLatency_s;
  usbl.ship_N_m = {150.0, 300.0, 5.0};
}

estimation::SensorConfig told_survey_usbl() {
  auto usbl = estimation::default_sensor(SourceKind::usbl, "usbl");
  usbl.sigma = {kUsblFloor_m, kUsblFloor_m, kUsblFloor_m};
  return usbl;
}

}  // namespace fathom::study
