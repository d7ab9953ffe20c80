#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>

#include "status/view.hpp"

namespace fathom::status {

/// Keeps the newest of everything that one vehicle says about itself. Pure: the time of arrival is an
/// argument, and what is kept is bounded whatever names come from the network. Not thread-safe.
class StatusBook {
 public:
  /// `vehicle` empty: the first one heard.
  explicit StatusBook(std::string vehicle) : vehicle_(std::move(vehicle)) {}

  // Each returns false for a sample of another vehicle, which is left out.
  bool add(const NavState& state, TimeNs monotonic_ns);
  bool add(const AlignmentStatus& status, TimeNs monotonic_ns);
  bool add(const MonitorStatus& status, TimeNs monotonic_ns);
  bool add(const Forecast& forecast, TimeNs monotonic_ns);
  bool add(const ServiceStatus& status, TimeNs monotonic_ns);
  bool add(const Alarm& alarm, TimeNs monotonic_ns);
  bool add(const Verdict& verdict, TimeNs monotonic_ns);

  /// The newest navigation state, however old; null: none was heard.
  [[nodiscard]] const NavState* navigation() const { return nav_ ? &nav_->sample : nullptr; }
  /// How long navigation state and monitor have both been heard: 0 until they are.
  [[nodiscard]] DurationNs heard_for_ns(TimeNs monotonic_ns) const;
  /// Everything but utc_ns, domain and window_s.
  [[nodiscard]] StatusView view(TimeNs monotonic_ns) const;

 private:
  template <class T>
  struct Stamped {
    T sample;
    TimeNs at_ns = 0;
  };
  template <class T>
  [[nodiscard]] static std::optional<Heard<T>> aged(const std::optional<Stamped<T>>& stamped, TimeNs now_ns) {
    if (!stamped) return std::nullopt;
    return Heard<T>{stamped->sample, to_seconds(now_ns - stamped->at_ns)};
  }
  [[nodiscard]] bool ours(const SampleHeader& header);
  [[nodiscard]] double nav_rate(TimeNs now_ns) const;

  std::string vehicle_;
  std::optional<Stamped<NavState>> nav_;
  std::deque<TimeNs> nav_times_;
  std::optional<Stamped<AlignmentStatus>> alignment_;
  std::optional<Stamped<MonitorStatus>> monitor_;
  std::optional<Stamped<Forecast>> forecast_;
  std::map<Name, Stamped<ServiceStatus>> services_;
  std::map<Name, Alarm> alarms_;
  std::map<Name, VerdictCounts> verdicts_;
};

}  // namespace fathom::status
