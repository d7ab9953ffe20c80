#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/time.hpp"
#include "console/view/ring.hpp"
#include "samples/nav_detail.hpp"
#include "samples/nav_state.hpp"
#include "samples/verdict.hpp"

namespace fathom::console {

/// How many minutes of plots the console keeps, and how finely.
inline constexpr double kHistoryS = 600.0;
inline constexpr DurationNs kNavSpacingNs = 200 * kNsPerMillisecond;
inline constexpr DurationNs kDetailSpacingNs = 2 * kNsPerSecond;
inline constexpr DurationNs kVerdictSpacingNs = 400 * kNsPerMillisecond;
inline constexpr DurationNs kFixSpacingNs = 900 * kNsPerMillisecond;

/// Columns of the navigation's history, in the order of NavRow::values. Units as in the names; a mode is a
/// number of NavMode.
inline constexpr std::array<std::string_view, 23> kNavColumns{
    "lat_deg",    "lon_deg",     "alt_m",     "depth_m",       "v_north_m_s",  "v_east_m_s",
    "v_down_m_s", "roll_deg",    "pitch_deg", "yaw_deg",       "h95_m",        "v95_m",
    "s_north_m",  "s_east_m",    "s_down_m",  "s_v_north_m_s", "s_v_east_m_s", "s_v_down_m_s",
    "s_roll_deg", "s_pitch_deg", "s_yaw_deg", "gps_outage_s",  "mode"};

struct NavRow {
  TimeNs utc_ns = 0;
  std::array<double, kNavColumns.size()> values{};
};
[[nodiscard]] NavRow nav_row(const NavState& state);

/// One measurement as fusion judged it.
struct VerdictRow {
  TimeNs utc_ns = 0;
  VerdictKind kind = VerdictKind::used;
  std::uint8_t dimensions = 0;
  float test_ratio = 0.0F;
  float latency_s = 0.0F;
  std::array<float, 6> innovation{};
  std::array<float, 6> sigma{};
};

/// All verdicts of one aiding model on one sensor.
struct VerdictSeries {
  static constexpr std::size_t kRows = 1500;  ///< ten minutes at the finest spacing
  Name sensor;
  Name model;
  SourceKind source = SourceKind::imu;
  Ring<VerdictRow> rows{kRows};
  TimeNs last_ns = 0;
};

/// What the filter estimates besides the navigation state.
struct DetailRow {
  TimeNs utc_ns = 0;
  std::array<float, NavDetail::kMaxStates> value{};
  std::array<float, NavDetail::kMaxStates> sigma{};
};

/// A position fix for the map.
struct FixRow {
  TimeNs utc_ns = 0;
  double latitude_deg = kUnknown;
  double longitude_deg = kUnknown;
  double sigma_m = kUnknown;
  SourceKind source = SourceKind::gps;
  Name sensor;
  std::optional<VerdictKind> verdict;  ///< none: fusion said nothing about it
};

/// What was added since the increment before.
struct Fresh {
  std::vector<NavRow> nav;
  std::vector<std::pair<std::size_t, VerdictRow>> verdicts;  ///< by index of History::verdicts
  std::vector<FixRow> fixes;
  std::optional<DetailRow> detail;
  bool detail_renamed = false;  ///< the filter estimates other states than before: earlier rows are gone
};

/// Ten minutes of everything that is plotted. Every ring has its final size from the start, the number of
/// rings is limited: twelve hours take no more memory than ten minutes.
class History {
 public:
  static constexpr std::size_t kMaxSeries = 24;

  History();

  void add(const NavState& state);
  void add(const NavDetail& detail);
  /// Rows nearer to the one before than the spacing are left out, unless one was not used. A later verdict on
  /// the same measurement takes the place of the row of the first one, where that was kept.
  void add(const Verdict& verdict);
  /// Rows nearer than the spacing are left out here as well, but for positions that somebody told: who told
  /// one wants to see it.
  void add(const FixRow& fix);
  /// A later verdict on a fix that add() has kept.
  void revise_fix(const Verdict& verdict);

  /// What came since the last call. What add() keeps shows in the rings from then on, so that a snapshot
  /// and the increments after it fit without gap or overlap.
  [[nodiscard]] Fresh commit();

  [[nodiscard]] const Ring<NavRow>& nav() const { return nav_; }
  [[nodiscard]] const std::vector<VerdictSeries>& verdicts() const { return verdicts_; }
  [[nodiscard]] const Ring<DetailRow>& detail() const { return detail_; }
  [[nodiscard]] const Ring<FixRow>& fixes() const { return fixes_; }
  [[nodiscard]] const NavDetail& detail_names() const { return last_detail_; }
  [[nodiscard]] std::uint64_t verdicts_left_out() const { return left_out_; }

 private:
  [[nodiscard]] std::optional<std::size_t> series_of(const Verdict& verdict);

  Ring<NavRow> nav_;
  Ring<DetailRow> detail_;
  Ring<FixRow> fixes_;
  std::vector<VerdictSeries> verdicts_;
  NavDetail last_detail_;
  TimeNs last_nav_ns_ = 0;
  TimeNs last_detail_ns_ = 0;
  std::map<Name, TimeNs> last_fix_ns_;
  std::uint64_t left_out_ = 0;
  Fresh fresh_;
};

}  // namespace fathom::console
