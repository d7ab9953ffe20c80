#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "console/view/beacon_book.hpp"
#include "console/view/history.hpp"
#include "console/view/route_book.hpp"
#include "health/instant.hpp"
#include "health/navigation/order_watch.hpp"
#include "samples/gps.hpp"
#include "samples/position/fix.hpp"
#include "samples/usbl.hpp"
#include "status/book.hpp"
#include "status/trust.hpp"

namespace fathom::console {

/// What fusion makes of one sensor.
struct SourceLine {
  Name sensor;
  SourceKind kind = SourceKind::imu;
  std::array<std::uint64_t, kVerdictKinds> counts{};
  VerdictKind last = VerdictKind::used;
  double last_ratio = kUnknown;
  double latency_s = kUnknown;     ///< from the instant of validity to the arrival at the bridge
  double since_used_s = kUnknown;  ///< NaN: never used
  double since_heard_s = kUnknown;
};

/// A service's own figures, and what only a listener can know.
struct ServiceLine {
  ServiceStatus status;
  std::uint32_t restarts = 0;  ///< seen by this console
};

/// Everything at one moment, and what was added to the history since the moment before.
struct Tick {
  std::uint64_t number = 0;
  TimeNs utc_ns = 0;
  status::StatusView view;
  status::Trust trust;
  double nav_latency_s = kUnknown;
  std::vector<SourceLine> sources;
  std::vector<ServiceLine> services;             ///< in every tenth tick, else empty
  std::optional<std::vector<RouteLine>> routes;  ///< when one changed, and in every tenth tick
  std::vector<BeaconLine> beacons;
  std::vector<StateEstimate> current;  ///< water current, as far as it is estimated
  Fresh fresh;
  std::vector<VerdictSeries> fresh_series;  ///< names of the series that fresh rows belong to; no rows
  std::vector<Name> detail_names;           ///< only when they changed
  std::size_t detail_count = 0;             ///< of states in fresh.detail
};

/// The history behind a tick.
struct Snapshot {
  std::uint64_t tick = 0;
  History history;
};

/// The vehicle as the console knows it. Pure: times are arguments. Memory is bounded. Not thread-safe.
class VehicleView {
 public:
  struct Options {
    std::string vehicle;
    int domain = 0;
    double fresh_s = 0.7;  ///< an older navigation state is none
  };
  explicit VehicleView(Options options);

  void add(const NavState& state, const health::Instant& at);
  /// How far an order would move the vehicle; none where that is not known.
  [[nodiscard]] std::optional<health::Departure> departure_of(const Command& order) const;
  void add(const NavDetail& detail, const health::Instant& at);
  void add(const Verdict& verdict, const health::Instant& at);
  void add(const AlignmentStatus& status, const health::Instant& at);
  void add(const MonitorStatus& status, const health::Instant& at);
  void add(const Forecast& forecast, const health::Instant& at);
  void add(const ServiceStatus& status, const health::Instant& at);
  void add(const Alarm& alarm, const health::Instant& at);
  void add(const GpsSample& sample, const health::Instant& at);
  void add(const UsblSample& sample, const health::Instant& at);
  void add(const FixSample& sample, const health::Instant& at);
  void add(const RangeSample& sample, const health::Instant& at);
  /// A sentence when it was refused.
  std::optional<std::string> add(const Route& route, const health::Instant& at);

  [[nodiscard]] Tick tick(const health::Instant& at);
  [[nodiscard]] Snapshot snapshot() const { return {ticks_, history_}; }
  [[nodiscard]] const History& history() const { return history_; }
  [[nodiscard]] const RouteBook& routes() const { return routes_; }

 private:
  struct Source {
    SourceLine line;
    VerdictTally tally;
    TimeNs stamp_ns = 0;  ///< of the newest measurement judged
    TimeNs used_ns = 0;
    TimeNs heard_ns = 0;
  };
  struct WaitingFix {
    FixRow row;
    TimeNs arrived_ns = 0;
  };
  struct Judged {
    Name sensor;
    TimeNs stamp_ns = 0;
    VerdictKind kind = VerdictKind::used;
  };

  void add_fix(FixRow fix, const health::Instant& at);
  void judge_fix(const Verdict& verdict);
  void release_fixes(TimeNs monotonic_ns);

  Options options_;
  status::StatusBook book_;
  History history_;
  std::map<Name, Source> sources_;
  std::map<Name, ServiceLine> services_;
  std::vector<WaitingFix> waiting_;
  Ring<Judged> judged_{64};  ///< verdicts that came before their fix
  RouteBook routes_;
  BeaconBook beacons_;
  NavDetail detail_;
  double nav_latency_s_ = kUnknown;
  TimeNs began_ns_ = 0;
  std::uint64_t ticks_ = 0;
};

}  // namespace fathom::console
