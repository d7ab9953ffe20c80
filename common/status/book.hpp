#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>

#include "status/view.hpp"

namespace fathom::status {

/// A book of the newest sample of each kind that one vehicle publishes. Pure: the time of arrival is an
/// argument. The book is bounded, whatever names come from the network. Not thread-safe.
class StatusBook {
 public:
  /// `vehicle`: its name; empty: the vehicle of the first sample.
  explicit StatusBook(std::string vehicle) : vehicle_(std::move(vehicle)) {}

  // Each returns false for a sample of another vehicle, which it ignores.
  bool add(const NavState& state, TimeNs monotonic_ns);
  bool add(const AlignmentStatus& status, TimeNs monotonic_ns);
  bool add(const MonitorStatus& status, TimeNs monotonic_ns);
  bool add(const Forecast& forecast, TimeNs monotonic_ns);
  bool add(const ServiceStatus& status, TimeNs monotonic_ns);
  bool add(const Alarm& alarm, TimeNs monotonic_ns);
  bool add(const Verdict& verdict, TimeNs monotonic_ns);

  /// The newest navigation state, however old. Null when there was none.
  [[nodiscard]] const NavState* navigation() const { return nav_ ? &nav_->sample : nullptr; }
  /// Time since both a navigation state and a monitor status have arrived; 0 until then.
  [[nodiscard]] DurationNs heard_for_ns(TimeNs monotonic_ns) const;
  /// The view at one moment, without utc_ns, domain and window_s.
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
  struct Judged {
    VerdictCounts counts;
    TimeNs last_ns = 0;
    TimeNs refused_since_ns = 0;  ///< 0: the last one was not refused
  };
  std::map<Name, Judged> verdicts_;
};

}  // namespace fathom::status
