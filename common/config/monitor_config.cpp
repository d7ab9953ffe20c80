#include "config/monitor_config.hpp"

#include <set>
#include <string>
#include <utility>

#include <arpa/inet.h>

#include "config/service_schema.hpp"

namespace fathom::config {
namespace {

using health::AlignmentWatchConfig;
using health::ExpectedSensor;
using health::ExpectedService;
using health::FixWatchConfig;
using health::ForecastWatchConfig;
using health::GpsOutageConfig;
using health::HealthConfig;
using health::NavWatchConfig;
using health::OutageLimits;
using health::RefusalWatchConfig;
using health::ServiceWatchConfig;
using health::StampWatchConfig;
using Fault = std::pair<std::string, std::string>;

std::vector<std::pair<std::string, Severity>> severities() {
  return {{"notice", Severity::notice}, {"warning", Severity::warning}, {"critical", Severity::critical}};
}

std::vector<std::pair<std::string, SourceKind>> sensor_kinds() {
  std::vector<std::pair<std::string, SourceKind>> words;
  for (std::size_t i = 0; i < kSourceKinds; ++i) {
    const auto kind = static_cast<SourceKind>(i);
    words.emplace_back(to_string(kind), kind);
  }
  return words;
}

}  // namespace

void describe(Schema<OutageLimits>& s) {
  s.field("limit_s", &OutageLimits::limit_s, "an outage begins when there was no usable fix for this long")
      .unit("s")
      .range(0.2, 3600);
  s.field("clear_fixes", &OutageLimits::clear_fixes, "it ends after this many usable fixes in a row")
      .range(1, 1000);
  s.field("clear_hold_s", &OutageLimits::clear_hold_s, "and these fixes are spread over at least this long")
      .unit("s")
      .range(0, 60);
}

void describe(Schema<ForecastWatchConfig>& s) {
  s.field("limit", &ForecastWatchConfig::limit,
          "which of fusion's forecast limits grades an outage; empty: its length alone");
  s.field("warning_s", &ForecastWatchConfig::warning_s,
          "an outage is a warning when the limit will be passed sooner than this")
      .unit("s")
      .range(0, 1e5);
  s.field("critical_s", &ForecastWatchConfig::critical_s, "and critical when sooner than this")
      .unit("s")
      .range(0, 1e5);
  s.field("hold_s", &ForecastWatchConfig::hold_s, "every forecast of this time has to say so")
      .unit("s")
      .range(0, 60);
  s.check([](const ForecastWatchConfig& forecast) -> Fault {
    if (forecast.critical_s > forecast.warning_s) return {"critical_s", "at most warning_s"};
    return {};
  });
}

void describe(Schema<GpsOutageConfig>& s) {
  s.include(&GpsOutageConfig::outage);
  s.field("warning_s", &GpsOutageConfig::warning_s,
          "an outage this long is a warning, a shorter one a notice")
      .unit("s")
      .range(0, 1e7);
  s.field("critical_s", &GpsOutageConfig::critical_s, "an outage this long is critical")
      .unit("s")
      .range(1, 1e7);
  s.field("expected", &GpsOutageConfig::expected,
          "the vehicle has GPS: the absence of a first fix is an alarm");
  s.field("first_fix_limit_s", &GpsOutageConfig::first_fix_limit_s, "how long the first fix may take")
      .unit("s")
      .range(1, 1e5);
  s.field("per_receiver_alarms", &GpsOutageConfig::per_receiver_alarms,
          "with several receivers, an alarm for each besides the common one");
  s.field("forecast", &GpsOutageConfig::forecast, "outages graded by what navigation forecasts");
  s.check([](const GpsOutageConfig& gps) -> Fault {
    if (gps.warning_s > gps.critical_s) return {"warning_s", "at most critical_s"};
    return {};
  });
}

void describe(Schema<NavWatchConfig>& s) {
  s.field("expected", &NavWatchConfig::expected, "a navigation state has to be there");
  s.field("rate_hz", &NavWatchConfig::rate_hz, "its rate: that of the inertial sensor")
      .unit("Hz")
      .range(1, 2000);
  s.field("missing_s", &NavWatchConfig::missing_s, "silent this long: an alarm").unit("s").range(0.05, 60);
  s.field("horizontal_95_limit_m", &NavWatchConfig::horizontal_95_limit_m,
          "a larger 95 % radius of the position is an alarm")
      .unit("m")
      .range(0.1, 1e6);
}

void describe(Schema<AlignmentWatchConfig>& s) {
  s.field("limit_s", &AlignmentWatchConfig::limit_s, "not aligned this long after the start: an alarm")
      .unit("s")
      .range(1, 1e5);
  s.field("regain_hold_s", &AlignmentWatchConfig::regain_hold_s,
          "a lost alignment must be back this long before its alarm clears")
      .unit("s")
      .range(0, 600);
}

void describe(Schema<ServiceWatchConfig>& s) {
  s.field("missing_s", &ServiceWatchConfig::missing_s, "no life sign (one a second) for this long: missing")
      .unit("s")
      .range(1.5, 600);
  s.field("degraded_hold_s", &ServiceWatchConfig::degraded_hold_s,
          "a service must call itself degraded this long before it is an alarm")
      .unit("s")
      .range(0, 600);
}

void describe(Schema<RefusalWatchConfig>& s) {
  s.field("limit_s", &RefusalWatchConfig::limit_s,
          "a sensor that fusion refuses throughout this time is an alarm")
      .unit("s")
      .range(0.1, 3600);
  s.field("minimum", &RefusalWatchConfig::minimum, "and at least so many of its measurements")
      .range(1, 10000);
}

void describe(Schema<FixWatchConfig>& s) {
  s.field("frozen_path_m", &FixWatchConfig::frozen_path_m,
          "a fix repeated bit by bit while the vehicle travelled this far is frozen")
      .unit("m")
      .range(0.1, 1e5);
  s.field("disagreement_m", &FixWatchConfig::disagreement_m,
          "fixes that moved this much otherwise than a velocity says are an alarm")
      .unit("m")
      .range(0.1, 1e5);
  s.field("window_s", &FixWatchConfig::window_s, "over at most this long").unit("s").range(1, 60);
}

void describe(Schema<StampWatchConfig>& s) {
  s.field("duplicates", &StampWatchConfig::duplicates, "so many repeated stamps of a sensor are an alarm")
      .range(1, 10000);
  s.field("window_s", &StampWatchConfig::window_s, "within this time").unit("s").range(1, 3600);
  s.field("clock_jump_s", &StampWatchConfig::clock_jump_s,
          "a lasting change of stamp against arrival by more than this is an alarm")
      .unit("s")
      .range(0.05, 3600);
}

void describe(Schema<ExpectedSensor>& s) {
  s.field("name", &ExpectedSensor::name, "of the sensor, as its bridge calls it").name().required();
  s.field("kind", &ExpectedSensor::kind, "what it measures").words(sensor_kinds()).required();
  s.field("rate_hz", &ExpectedSensor::rate_hz, "samples per second").unit("Hz").range(0.001, 4000).required();
  s.field("missing_s", &ExpectedSensor::missing_s,
          "silent this long: missing; 0: ten periods, at least two seconds")
      .unit("s")
      .range(0, 1e5);
  s.field("severity", &ExpectedSensor::severity, "of its absence").words(severities());
  s.check([](const ExpectedSensor& sensor) -> Fault {
    if (sensor.missing_s > 0.0 && sensor.missing_s * sensor.rate_hz < 1.5) {
      return {"missing_s", "0 or more than one and a half periods of rate_hz"};
    }
    return {};
  });
}

void describe(Schema<ExpectedService>& s) {
  s.field("name", &ExpectedService::name, "of the service, e.g. fusion").name().required();
  s.field("severity", &ExpectedService::severity, "of its absence").words(severities());
}

void describe(Schema<HealthConfig>& s) {
  s.field(
       "startup_s", &HealthConfig::startup_s,
       "sensors, services and the navigation state may stay unheard of this long after the monitor's start")
      .unit("s")
      .range(0, 3600);
  s.field("gps", &HealthConfig::gps, "GPS outages");
  s.field("navigation", &HealthConfig::nav, "the navigation state");
  s.field("alignment", &HealthConfig::alignment, "alignment");
  s.field("service_life_signs", &HealthConfig::service, "how services are judged");
  s.field("refusals", &HealthConfig::refusal, "sensors that talk but that fusion does not believe");
  s.field("fixes", &HealthConfig::fixes, "fixes that look healthy and are not");
  s.field("stamps", &HealthConfig::stamps, "times that sensors give their samples");
  s.field("sensors", &HealthConfig::sensors, "sensors that have to be there, at most 32");
  s.field("services", &HealthConfig::services, "services that have to be there, at most 32");
  s.check([](const HealthConfig& health) -> Fault {
    std::set<std::pair<SourceKind, Name>> sensors;
    for (const auto& sensor : health.sensors) {
      if (!sensors.insert({sensor.kind, sensor.name}).second) {
        return {"sensors", "each sensor once: " + sensor.name.str() + " is there twice"};
      }
    }
    std::set<Name> services;
    for (const auto& service : health.services) {
      if (!services.insert(service.name).second) {
        return {"services", "each service once: " + service.name.str() + " is there twice"};
      }
    }
    if (sensors.size() > health::SensorWatch::kMaxSensors) return {"sensors", "at most 32"};
    if (services.size() > health::ServiceWatch::kMaxServices) return {"services", "at most 32"};
    return {};
  });
}

void describe(Schema<JournalConfig>& s) {
  s.field("path", &JournalConfig::path,
          "file that every alarm is appended to, one JSON object a line; its folder is made; empty: none");
}

void describe(Schema<MetricsConfig>& s) {
  s.field("enabled", &MetricsConfig::enabled, "answer http://address:port/metrics for Prometheus");
  s.field("address", &MetricsConfig::address,
          "IPv4 address that is listened at: this host's own, 0.0.0.0 for every one it has");
  s.field("port", &MetricsConfig::port, "TCP port").range(1, 65535);
  s.check([](const MetricsConfig& metrics) -> Fault {
    in_addr parsed{};
    if (inet_pton(AF_INET, metrics.address.c_str(), &parsed) != 1) {
      return {"address", "an IPv4 address such as 127.0.0.1"};
    }
    return {};
  });
}

void describe(Schema<MonitorConfig>& s) {
  s.include(&MonitorConfig::common);
  s.include(&MonitorConfig::health);
  s.field("journal", &MonitorConfig::journal, "the record of alarms");
  s.field("metrics", &MonitorConfig::metrics, "metrics for Prometheus");
  s.field("evaluation_hz", &MonitorConfig::evaluation_hz, "how often everything is judged")
      .unit("Hz")
      .range(2, 100);
  s.field("status_hz", &MonitorConfig::status_hz, "how often the monitor's status is published at least")
      .unit("Hz")
      .range(0.2, 20);
  s.field("alarm_repeat_s", &MonitorConfig::alarm_repeat_s, "how often alarms are published again")
      .unit("s")
      .range(0.5, 60);
}

template LoadedConfig<MonitorConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<MonitorConfig>();

ConfigKind monitor_kind() {
  return make_kind<MonitorConfig>("monitor");
}

}  // namespace fathom::config
