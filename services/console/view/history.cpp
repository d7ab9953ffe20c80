#include "console/view/history.hpp"

#include <algorithm>
#include <cmath>

#include "base/units.hpp"
#include "samples/uncertainty.hpp"

namespace fathom::console {
namespace {

// Between two ticks no more is kept than a slow tick could need: names and rates come from the network.
constexpr std::size_t kMostFresh = 256;

constexpr std::size_t rows_for(DurationNs spacing_ns) {
  return static_cast<std::size_t>(kHistoryS * 1e9 / static_cast<double>(spacing_ns));
}

double sigma_of(double variance) {
  return variance >= 0.0 ? std::sqrt(variance) : kUnknown;
}

/// A clock that went back begins a new series as one that went on does.
bool due(TimeNs now_ns, TimeNs last_ns, DurationNs spacing_ns) {
  return last_ns == 0 || now_ns - last_ns >= spacing_ns || now_ns < last_ns - kNsPerSecond;
}

bool same_names(const NavDetail& a, const NavDetail& b) {
  if (a.count != b.count || a.configuration != b.configuration) return false;
  for (std::size_t i = 0; i < a.count; ++i) {
    if (a.states[i].name != b.states[i].name) return false;
  }
  return true;
}

VerdictRow verdict_row(const Verdict& verdict) {
  VerdictRow row;
  row.utc_ns = verdict.header.stamp_ns;
  row.kind = verdict.kind;
  row.dimensions = static_cast<std::uint8_t>(std::min(verdict.dimensions, 6U));
  row.test_ratio = static_cast<float>(verdict.test_ratio);
  row.latency_s = static_cast<float>(to_seconds(verdict.header.received_ns - verdict.header.stamp_ns));
  for (std::size_t i = 0; i < row.dimensions; ++i) {
    row.innovation[i] = static_cast<float>(verdict.innovation[i]);
    row.sigma[i] = static_cast<float>(verdict.innovation_sigma[i]);
  }
  return row;
}

/// The newest row of that instant for which `same` holds; none is older than `kRevisable` rows.
template <class Row, class Same>
Row* row_at(Ring<Row>& rows, TimeNs utc_ns, const Same& same) {
  constexpr std::size_t kRevisable = 256;
  for (std::size_t back = 1; back <= std::min(rows.size(), kRevisable); ++back) {
    Row& row = rows[rows.size() - back];
    if (row.utc_ns == utc_ns && same(row)) return &row;
  }
  return nullptr;
}

const auto kAny = [](const auto&) { return true; };

}  // namespace

NavRow nav_row(const NavState& state) {
  const auto& p = state.position_covariance_N_m2;
  const auto& v = state.velocity_covariance_N_m2_s2;
  NavRow row;
  row.utc_ns = state.header.stamp_ns;
  row.values = {state.latitude_rad * kDegPerRad,
                state.longitude_rad * kDegPerRad,
                state.altitude_m,
                state.depth_m,
                state.velocity_N_m_s[0],
                state.velocity_N_m_s[1],
                state.velocity_N_m_s[2],
                state.rpy_rad[0] * kDegPerRad,
                state.rpy_rad[1] * kDegPerRad,
                state.rpy_rad[2] * kDegPerRad,
                horizontal_95_m(p),
                vertical_95_m(p),
                sigma_of(p[0]),
                sigma_of(p[4]),
                sigma_of(p[8]),
                sigma_of(v[0]),
                sigma_of(v[4]),
                sigma_of(v[8]),
                state.rpy_sigma_rad[0] * kDegPerRad,
                state.rpy_sigma_rad[1] * kDegPerRad,
                state.rpy_sigma_rad[2] * kDegPerRad,
                state.gps_outage_s,
                static_cast<double>(state.mode)};
  return row;
}

History::History()
    : nav_(rows_for(kNavSpacingNs)), detail_(rows_for(kDetailSpacingNs)), fixes_(rows_for(kNsPerSecond)) {
  verdicts_.reserve(kMaxSeries);
}

void History::add(const NavState& state) {
  if (!due(state.header.stamp_ns, last_nav_ns_, kNavSpacingNs)) return;
  last_nav_ns_ = state.header.stamp_ns;
  if (fresh_.nav.size() < kMostFresh) fresh_.nav.push_back(nav_row(state));
}

void History::add(const NavDetail& detail) {
  if (!due(detail.header.stamp_ns, last_detail_ns_, kDetailSpacingNs)) return;
  last_detail_ns_ = detail.header.stamp_ns;
  const bool renamed = !same_names(detail, last_detail_);
  last_detail_ = detail;
  if (renamed) {
    detail_.clear();
    fresh_.detail_renamed = true;
  }
  DetailRow row;
  row.utc_ns = detail.header.stamp_ns;
  const auto count = std::min<std::size_t>(detail.count, NavDetail::kMaxStates);
  for (std::size_t i = 0; i < count; ++i) {
    row.value[i] = static_cast<float>(detail.states[i].value);
    row.sigma[i] = static_cast<float>(detail.states[i].sigma);
  }
  fresh_.detail = row;
}

std::optional<std::size_t> History::series_of(const Verdict& verdict) {
  const auto at = std::find_if(verdicts_.begin(), verdicts_.end(), [&](const VerdictSeries& series) {
    return series.sensor == verdict.header.sensor && series.model == verdict.model;
  });
  if (at != verdicts_.end()) return static_cast<std::size_t>(at - verdicts_.begin());
  if (verdicts_.size() >= kMaxSeries) return std::nullopt;
  verdicts_.emplace_back();
  verdicts_.back().sensor = verdict.header.sensor;
  verdicts_.back().model = verdict.model;
  verdicts_.back().source = verdict.source;
  return verdicts_.size() - 1;
}

void History::add(const Verdict& verdict) {
  const auto index = series_of(verdict);
  if (!index || fresh_.verdicts.size() >= kMostFresh) {
    ++left_out_;
    return;
  }
  VerdictSeries& series = verdicts_[*index];
  if (verdict.revision > 0) {
    const TimeNs utc_ns = verdict.header.stamp_ns;
    const bool fresh = std::any_of(fresh_.verdicts.begin(), fresh_.verdicts.end(), [&](const auto& one) {
      return one.first == *index && one.second.utc_ns == utc_ns;
    });
    if (fresh || row_at(series.rows, utc_ns, kAny) != nullptr)
      fresh_.verdicts.emplace_back(*index, verdict_row(verdict));
    return;
  }
  // What was not used is what people look for: it gets a denser spacing than what was.
  const DurationNs spacing = verdict.kind == VerdictKind::used ? kVerdictSpacingNs : kVerdictSpacingNs / 4;
  if (!due(verdict.header.stamp_ns, series.last_ns, spacing)) return;
  series.last_ns = verdict.header.stamp_ns;
  fresh_.verdicts.emplace_back(*index, verdict_row(verdict));
}

void History::add(const FixRow& fix) {
  if (last_fix_ns_.size() >= kMaxSeries && !last_fix_ns_.contains(fix.sensor)) return;
  TimeNs& last_ns = last_fix_ns_[fix.sensor];
  const bool used = !fix.verdict || *fix.verdict == VerdictKind::used;
  const bool told = fix.source == SourceKind::fix;
  if (!told && !due(fix.utc_ns, last_ns, used ? kFixSpacingNs : kFixSpacingNs / 4)) return;
  last_ns = fix.utc_ns;
  if (fresh_.fixes.size() < kMostFresh) fresh_.fixes.push_back(fix);
}

void History::revise_fix(const Verdict& verdict) {
  const auto same = [&](const FixRow& row) { return row.sensor == verdict.header.sensor; };
  const auto fresh = std::find_if(fresh_.fixes.begin(), fresh_.fixes.end(), [&](const FixRow& row) {
    return row.utc_ns == verdict.header.stamp_ns && same(row);
  });
  if (fresh != fresh_.fixes.end()) {
    fresh->verdict = verdict.kind;
    return;
  }
  const FixRow* row = row_at(fixes_, verdict.header.stamp_ns, same);
  if (row == nullptr || fresh_.fixes.size() >= kMostFresh) return;
  fresh_.fixes.push_back(*row);
  fresh_.fixes.back().verdict = verdict.kind;
}

Fresh History::commit() {
  for (const NavRow& row : fresh_.nav) nav_.push(row);
  for (const auto& [index, row] : fresh_.verdicts) {
    VerdictRow* before = row_at(verdicts_[index].rows, row.utc_ns, kAny);
    if (before != nullptr) {
      *before = row;
    } else {
      verdicts_[index].rows.push(row);
    }
  }
  for (const FixRow& row : fresh_.fixes) {
    FixRow* before = row_at(fixes_, row.utc_ns, [&](const FixRow& one) { return one.sensor == row.sensor; });
    if (before != nullptr) {
      *before = row;
    } else {
      fixes_.push(row);
    }
  }
  if (fresh_.detail) detail_.push(*fresh_.detail);
  return std::exchange(fresh_, {});
}

}  // namespace fathom::console
