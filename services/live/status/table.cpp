#include "live/status/table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <tuple>

#include <sys/ioctl.h>
#include <unistd.h>

#include "base/units.hpp"
#include "health/text.hpp"
#include "live/number.hpp"
#include "samples/alignment/help.hpp"
#include "samples/uncertainty.hpp"
#include "status/judgement.hpp"
#include "status/receiver.hpp"

namespace fathom::cli {
namespace {

using status::Condition;
using status::Judgement;
using status::StatusView;
using status::VerdictCounts;

constexpr double kNavFresh_s = 1.0;
constexpr double kMonitorFresh_s = 3.0;
constexpr double kServiceFresh_s = 3.0;

enum class Style { plain, title, good, warn, bad, dim };

/// One line of the table: cut at the width as the eye sees it, escapes not counted.
class Line {
 public:
  Line(int width, bool colour) : room_(static_cast<std::size_t>(std::max(20, width))), colour_(colour) {}
  Line& add(std::string_view words, Style style = Style::plain) {
    const std::string_view shown = words.substr(0, room_);
    room_ -= shown.size();
    const bool styled = colour_ && style != Style::plain && !shown.empty();
    if (styled) out_ += escape(style);
    out_ += shown;
    if (styled) out_ += "\x1b[0m";
    column_ += shown.size();
    return *this;
  }
  /// Spaces up to a column.
  Line& tab(std::size_t column) { return add(std::string(column > column_ ? column - column_ : 1, ' ')); }
  [[nodiscard]] const std::string& str() const { return out_; }

 private:
  static std::string_view escape(Style style) {
    switch (style) {
      case Style::title:
        return "\x1b[1m";
      case Style::good:
        return "\x1b[32m";
      case Style::warn:
        return "\x1b[33m";
      case Style::bad:
        return "\x1b[1;31m";
      case Style::dim:
        return "\x1b[2m";
      case Style::plain:
        break;
    }
    return "";
  }
  std::size_t room_;
  std::size_t column_ = 0;
  bool colour_;
  std::string out_;
};

/// A condition's name without its unit, and the unit that people read.
struct Shown {
  std::string_view name;
  std::string_view unit_name;
  double unit;
};

Shown shown_of(std::string_view name) {
  struct Unit {
    std::string_view suffix;
    std::string_view name;
    double size;
  };
  static constexpr std::array<Unit, 5> kUnits{{{"_rad_s", " deg/s", kRadPerDeg},
                                               {"_rad", " deg", kRadPerDeg},
                                               {"_m_s2", " m/s2", 1.0},
                                               {"_m_s", " m/s", 1.0},
                                               {"_m", " m", 1.0}}};
  for (const Unit& one : kUnits)
    if (name.ends_with(one.suffix))
      return {name.substr(0, name.size() - one.suffix.size()), one.name, one.size};
  return {name, "", 1.0};
}

Style style_of(Presence presence) {
  if (presence == Presence::present) return Style::good;
  return presence == Presence::missing ? Style::bad : Style::warn;
}

Style style_of(const Alarm& alarm) {
  if (!alarm.active) return Style::dim;
  if (alarm.severity == Severity::critical) return Style::bad;
  return alarm.severity == Severity::warning ? Style::warn : Style::plain;
}

/// Builds the table section by section.
class Table {
 public:
  Table(const StatusView& view, int width, bool colour) : view_(view), width_(width), colour_(colour) {}

  std::vector<std::string> build() {
    headline();
    navigation();
    alignment();
    gps();
    forecast();
    sensors();
    services();
    alarms();
    return std::move(lines_);
  }

 private:
  [[nodiscard]] Line line() const { return {width_, colour_}; }
  [[nodiscard]] Line row(std::string_view label) const {
    Line out = line();
    out.add(label, Style::title).tab(12);
    return out;
  }
  void put(const Line& line) { lines_.push_back(line.str()); }

  void headline() {
    const Judgement judgement = judge(view_);
    const Style style = judgement.condition == Condition::healthy    ? Style::good
                        : judgement.condition == Condition::degraded ? Style::warn
                                                                     : Style::bad;
    put(line()
            .add(view_.vehicle.empty() ? "(no vehicle heard)" : view_.vehicle, Style::title)
            .add(health::sentence("  domain %d  %s  ", view_.domain, to_iso8601(view_.utc_ns, 0).c_str()))
            .add(to_string(judgement.condition), style));
    for (const std::string& reason : judgement.reasons) put(row("").add(reason, style));
    put(line());
  }

  void navigation() {
    if (!view_.nav) {
      put(row("navigation").add("none heard", Style::bad));
      return;
    }
    const NavState& nav = view_.nav->sample;
    const double age_s = view_.nav->age_s;
    put(row("navigation")
            .add(to_string(nav.mode))
            .add("  " + number("%.1f", view_.nav_rate_hz) + " Hz  ")
            .add(number("%.2f", age_s) + " s old", age_s > kNavFresh_s ? Style::bad : Style::plain));
    put(row("position")
            .add(number("%.7f", nav.latitude_rad / kRadPerDeg) + " deg N  " +
                 number("%.7f", nav.longitude_rad / kRadPerDeg) + " deg E  altitude " +
                 number("%.1f", nav.altitude_m) + " m  depth " + number("%.1f", nav.depth_m) + " m" +
                 (known(nav.altitude_above_bottom_m)
                      ? "  above bottom " + number("%.1f", nav.altitude_above_bottom_m) + " m"
                      : std::string())));
    put(row("  95 %").add("+-" + number("%.2f", horizontal_95_m(nav.position_covariance_N_m2)) +
                          " m horizontal  +-" + number("%.2f", vertical_95_m(nav.position_covariance_N_m2)) +
                          " m vertical"));
    const auto& v = nav.velocity_N_m_s;
    put(row("velocity")
            .add("north " + number("%.2f", v[0]) + "  east " + number("%.2f", v[1]) + "  down " +
                 number("%.2f", v[2]) + " m/s"));
    put(row("attitude")
            .add("roll " + number("%.1f", nav.rpy_rad[0] / kRadPerDeg) + "  pitch " +
                 number("%.1f", nav.rpy_rad[1] / kRadPerDeg) + "  yaw " +
                 number("%.1f", nav.rpy_rad[2] / kRadPerDeg) + " deg, +-" +
                 number("%.2f", nav.rpy_sigma_rad[2] / kRadPerDeg) + " deg (1 sigma)"));
  }

  void alignment() {
    if (!view_.alignment) {
      put(row("alignment").add(view_.nav ? to_string(view_.nav->sample.alignment) : "unknown"));
      return;
    }
    const AlignmentStatus& status = view_.alignment->sample;
    const auto& sigma = status.rpy_sigma_rad;
    const bool aligned = status.phase == AlignmentPhase::aligned;
    Line line = row("alignment");
    line.add(to_string(status.phase), aligned ? Style::good : Style::warn);
    line.add(" for " + number("%.0f", status.in_phase_s) + " s");
    if (!aligned && known(status.time_to_aligned_s)) {
      line.add(", aligned in about " + number("%.0f", status.time_to_aligned_s) + " s");
    }
    put(line);
    if (known(sigma[0])) {
      put(row("  1 sigma")
              .add("roll " + number("%.2f", sigma[0] / kRadPerDeg) + "  pitch " +
                   number("%.2f", sigma[1] / kRadPerDeg) + "  yaw " + number("%.2f", sigma[2] / kRadPerDeg) +
                   " deg"));
    }
    if (aligned) return;
    const auto count = std::min<std::size_t>(status.condition_count, AlignmentStatus::kMaxConditions);
    for (std::size_t i = 0; i < count; ++i) {
      const AlignmentCondition& condition = status.conditions[i];
      const Shown shown = shown_of(condition.name.view());
      Line one = row("");
      one.add(condition.met ? "met     " : "waiting ", condition.met ? Style::good : Style::warn);
      one.add(std::string(shown.name) + " " + number("%.3g", condition.value / shown.unit) + " (limit " +
              number("%.3g", condition.limit / shown.unit) + std::string(shown.unit_name) + ")");
      if (condition.needed_s > 0.0) {
        one.add(", held " + number("%.1f", condition.held_s) + " of " + number("%.1f", condition.needed_s) +
                " s");
      }
      put(one);
      if (const std::string_view help = help_of(condition); !condition.met && !help.empty())
        put(row("").add("        ").add(help));
    }
    if (status.advice[0] != '\0') put(row("").add(status.advice.data()));
  }

  void gps() {
    if (!view_.monitor) return;
    const MonitorStatus& monitor = view_.monitor->sample;
    put(outage(row("gps"),
               {{},
                monitor.gps_outage_active,
                monitor.gps_outage_severity,
                monitor.gps_outage_since_ns,
                monitor.gps_outage_s,
                monitor.gps_outage_longest_s,
                monitor.gps_outage_total_s,
                monitor.gps_outage_count},
               monitor.gps_outage_active ? status::why_no_gps(view_).phrase() : std::string()));
    if (monitor.receivers.size() < 2) return;  // one receiver's outages are the vehicle's
    for (const ReceiverOutage& receiver : monitor.receivers) {
      put(outage(row("  " + receiver.name.str()), receiver,
                 receiver.active ? status::why_out(view_, receiver).phrase() : std::string()));
    }
  }

  /// `why` it is out, where more is known than that there is no fix.
  static Line outage(Line line, const ReceiverOutage& what, const std::string& why) {
    if (!known(what.outage_s)) {
      line.add("no fix yet", Style::warn);
    } else if (what.active) {
      line.add((why.empty() ? "no fix for " : why + ", none used for ") + number("%.1f", what.outage_s) +
                   " s since " + to_iso8601(what.since_ns, 0).substr(11) + ", " +
                   std::string(to_string(what.severity)),
               what.severity == Severity::notice ? Style::warn : Style::bad);
    } else {
      line.add("fix", Style::good);
    }
    line.add(health::sentence("  outages %u, longest %.1f s, in all %.1f s", what.count, what.longest_s,
                              what.total_s));
    return line;
  }

  void forecast() {
    if (!view_.forecast) return;
    const Forecast& forecast = view_.forecast->sample;
    const auto count = std::min<std::size_t>(forecast.limit_count, Forecast::kMaxLimits);
    for (std::size_t i = 0; i < count; ++i) {
      const ForecastLimit& limit = forecast.limits[i];
      if (!limit.without.empty()) continue;
      const std::string when = std::isinf(limit.time_to_limit_s)
                                   ? "never at this rate"
                                   : "in " + number("%.0f", limit.time_to_limit_s) + " s";
      put(row(i == 0 ? "forecast" : "").add(limit.name.str() + " passed " + when));
    }
  }

  void watched(const WatchedItem& item, Line& line) const {
    line.add(item.name.view()).tab(20).add(to_string(item.presence), style_of(item.presence));
    line.tab(32).add(number("%.1f", item.rate_hz) + " Hz").tab(44).add(number("%.2f", item.age_s) + " s");
  }

  void sensors() {
    std::map<Name, VerdictCounts> left = view_.verdicts;
    const bool any = (view_.monitor && !view_.monitor->sample.sensors.empty()) || !left.empty();
    if (!any) return;
    put(line());
    put(line()
            .add("SENSOR", Style::title)
            .tab(20)
            .add("PRESENCE")
            .tab(32)
            .add("RATE")
            .tab(44)
            .add("AGE")
            .tab(54)
            .add(health::sentence("USED / NOT USED in %.0f s", view_.window_s)));
    if (view_.monitor) {
      for (const WatchedItem& item : view_.monitor->sample.sensors) {
        Line line = this->line();
        watched(item, line);
        const auto counts = left.find(item.name);
        if (counts != left.end()) {
          verdicts(counts->second, line);
          left.erase(counts);
        }
        put(line);
      }
    }
    for (const auto& [name, counts] : left) {
      Line line = this->line();
      line.add(name.view());
      verdicts(counts, line);
      put(line);
    }
  }

  static void verdicts(const VerdictCounts& counts, Line& line) {
    line.tab(54).add(health::sentence("%llu / %llu", static_cast<unsigned long long>(counts.used),
                                      static_cast<unsigned long long>(counts.not_used)));
    if (counts.last_refusal != VerdictKind::used) {
      line.add(" " + std::string(to_string(counts.last_refusal)), Style::warn);
    }
  }

  void services() {
    if (view_.services.empty() && !view_.monitor) return;
    put(line());
    put(line().add("SERVICE", Style::title).tab(20).add("STATE").tab(32).add("AGE").tab(44).add("PROCESS"));
    for (const auto& [name, heard] : view_.services) {
      const ServiceStatus& status = heard.sample;
      const bool late = heard.age_s > kServiceFresh_s;
      const Style style = late || status.state == ServiceState::degraded ? Style::bad
                          : status.state == ServiceState::healthy        ? Style::good
                                                                         : Style::warn;
      put(line()
              .add(name.view())
              .tab(20)
              .add(late ? "silent" : to_string(status.state), style)
              .tab(32)
              .add(number("%.1f", heard.age_s) + " s")
              .tab(44)
              .add(health::sentence("%u on %s  %s  %s", status.pid, status.host.c_str(),
                                    status.version.c_str(), status.text.c_str())));
    }
    if (!view_.monitor) return;
    for (const WatchedItem& item : view_.monitor->sample.services) {
      if (view_.services.contains(item.name)) continue;
      put(line().add(item.name.view()).tab(20).add(to_string(item.presence), style_of(item.presence)));
    }
  }

  void alarms() {
    if (view_.alarms.empty()) return;
    put(line());
    put(line().add("ALARM", Style::title).tab(20).add("SEVERITY").tab(32).add("SINCE").tab(44).add("WHAT"));
    for (const Alarm& alarm : sorted_alarms(view_)) {
      Line line = this->line();
      const std::size_t room = width_ == kUncut ? Name::kCapacity : 19;
      line.add(alarm.alarm.view().substr(0, room), style_of(alarm)).tab(20);
      line.add(to_string(alarm.severity), style_of(alarm)).tab(32);
      line.add(to_iso8601(alarm.since_ns, 0).substr(11)).tab(44);
      line.add(alarm.active ? "" : "(over) ")
          .add(alarm.text)
          .add(alarm.acknowledged ? " (acknowledged)" : "");
      put(line);
    }
  }

  const StatusView& view_;
  int width_;
  bool colour_;
  std::vector<std::string> lines_;
};

}  // namespace

int width_of(int descriptor) {
  if (isatty(descriptor) == 0) return kUncut;
  winsize size{};
  if (ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const char* columns = std::getenv("COLUMNS");
  const int width = columns != nullptr ? std::atoi(columns) : 0;
  return width > 0 ? width : 120;
}

std::vector<std::string> table(const StatusView& view, int width, bool colour) {
  return Table(view, width, colour).build();
}

}  // namespace fathom::cli
