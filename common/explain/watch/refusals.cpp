#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <boost/math/distributions/binomial.hpp>

#include "base/median.hpp"
#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

// Gates let pass 99 % and more of good measurements: five refusals in a row are no chance (1e-10).
constexpr std::size_t kInARow = 5;
constexpr std::size_t kBackAgain = 3;  // used in a row: it agrees again
// Of a disagreement the innovations point one way; of single outliers they point anywhere: the sum of five
// directions in the plane is longer than 0.8 of their lengths in 3 of 100 cases.
constexpr double kOneWay = 0.8;
// A jump shows at once: the place of the first refusal lies this far beyond the gate (in its squares).
constexpr double kAtOnce = 4.0;
// Instruments give some values far off. More than this share of them, and more than chance makes of it.
constexpr double kUsualOutliers = 0.02;
constexpr double kRefusalChance = 1e-4;
constexpr std::uint64_t kFewest = 4;
constexpr std::size_t kFrozenInARow = 3;  // as the monitor's watch over fixes
constexpr double kManyRefused = 0.01;     // of all; fewer late or doubled ones are everyday
constexpr std::uint64_t kManyCount = 5;
constexpr DurationNs kApart_ns = 5 * kNsPerSecond;
constexpr DurationNs kTravel_ns = kNsPerSecond;  // no sample that is used is on its way for longer

/// The largest of the first components in their sigmas, squared, over the gate's limit: above 1 it lies
/// beyond what the gate believes, whatever weight a robust noise gave it in the end.
double beyond(const VerdictRow& row, std::size_t components = 6) {
  double most = 0.0;
  for (std::size_t i = 0; i < std::min<std::size_t>(components, row.dimensions); ++i) {
    const double z = row.innovation[i] / row.sigma[i];
    if (std::isfinite(z)) most = std::max(most, z * z);
  }
  return row.limit > 0.0 ? most / row.limit : 0.0;
}

/// Horizontal components first, as all that have them order theirs.
double apart(const VerdictRow& row, SourceKind kind) {
  if (kind == SourceKind::heading || kind == SourceKind::depth) return std::abs(row.innovation[0]);
  return row.dimensions >= 2 ? std::hypot(row.innovation[0], row.innovation[1]) : std::abs(row.innovation[0]);
}

class Stretch {
 public:
  void add(const VerdictRow& row) {
    if (is_refusal(row.kind)) {
      rows.push_back(&row);
      used_in_a_row = 0;
    } else {
      ++used;
      ++used_in_a_row;
    }
  }
  [[nodiscard]] bool one_way() const {
    std::array<double, 2> sum{};
    double lengths = 0.0;
    for (const VerdictRow* row : rows) {
      std::array<double, 2> v{row->innovation[0] / row->sigma[0], 0.0};
      if (row->dimensions >= 2) v[1] = row->innovation[1] / row->sigma[1];
      const double length = std::hypot(v[0], v[1]);
      if (!std::isfinite(length) || length == 0.0) continue;
      sum[0] += v[0] / length;
      sum[1] += v[1] / length;
      lengths += 1.0;
    }
    return lengths > 0.0 && std::hypot(sum[0], sum[1]) > kOneWay * lengths;
  }

  std::vector<const VerdictRow*> rows;  // refused
  std::uint64_t used = 0;
  std::uint64_t used_in_a_row = 0;
};

class Refusals {
 public:
  Refusals(const History& history, const Track& track, std::size_t number, Findings& out)
      : history_(history),
        track_(track),
        stream_(history.streams()[number]),
        rows_(judged(history, number)),
        out_(out) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < rows_.size(); ++i)
      steps.push_back(to_seconds(rows_[i]->stamp_ns - rows_[i - 1]->stamp_ns));
    step_s_ = median(steps);
  }

  void all() {
    frozen();
    disagreement();
    outliers();
    for (const VerdictKind kind : {VerdictKind::late, VerdictKind::duplicate, VerdictKind::from_the_future,
                                   VerdictKind::unknown_frame})
      refused(kind);
  }

 private:
  [[nodiscard]] std::string topic() const { return "fathom/v1/" + std::string(to_string(stream_.kind)); }

  void frozen() {
    std::size_t begin = 0;
    while (begin < rows_.size()) {
      if (rows_[begin]->kind != VerdictKind::frozen) {
        ++begin;
        continue;
      }
      std::size_t end = begin;
      std::uint64_t count = 0;
      for (std::size_t i = begin; i < rows_.size(); ++i) {
        if (rows_[i]->kind == VerdictKind::frozen) {
          ++count;
          end = i;
        } else if (rows_[i]->stamp_ns - rows_[end]->stamp_ns > kApart_ns) {
          break;
        }
      }
      if (count >= kFrozenInARow) {
        const TimeNs from_ns = rows_[begin]->stamp_ns;
        const TimeNs to_ns = rows_[end]->stamp_ns;
        out_.push_back({.kind = Kind::frozen,
                        .weight = Weight::bad,
                        .subject = stream_.sensor.str(),
                        .begin_ns = from_ns,
                        .end_ns = to_ns,
                        .word = std::string(to_string(stream_.kind)),
                        .figures = {{"count", static_cast<double>(count)},
                                    {"for_s", to_seconds(to_ns - from_ns)},
                                    {"path_m", track_.path_m(from_ns, to_ns)}},
                        .evidence = {{"fathom/v1/verdict", count, "frozen"}}});
      }
      begin = end + 1;
    }
  }

  void disagreement() {
    for (std::size_t i = 0; i < rows_.size();) {
      if (!is_refusal(rows_[i]->kind)) {
        ++i;
        continue;
      }
      Stretch stretch;
      std::size_t k = i;
      for (; k < rows_.size() && stretch.used_in_a_row < kBackAgain; ++k) {
        if (is_refusal(rows_[k]->kind) || rows_[k]->kind == VerdictKind::used) stretch.add(*rows_[k]);
      }
      const std::uint64_t used = stretch.used - stretch.used_in_a_row;
      if (stretch.rows.size() >= kInARow && 2 * used <= stretch.rows.size() && stretch.one_way()) {
        say(stretch, i);
      } else {
        for (const VerdictRow* row : stretch.rows) lone_.push_back(row);
      }
      i = k;
    }
  }

  void say(const Stretch& stretch, std::size_t first) {
    const VerdictRow& begin = *stretch.rows.front();
    const VerdictRow& end = *stretch.rows.back();
    double most = 0.0;
    for (const VerdictRow* row : stretch.rows) most = std::max(most, apart(*row, stream_.kind));
    const bool heading = stream_.kind == SourceKind::heading;
    const bool at_once = beyond(begin, 2) > kAtOnce && agreed_before(first);
    const bool disputed = std::any_of(stretch.rows.begin(), stretch.rows.end(), [](const VerdictRow* row) {
      return row->kind == VerdictKind::disputed;
    });
    // Of a fix with a velocity that stands behind its place.
    double velocity_m_s = kUnknown;
    for (const VerdictRow* row : stretch.rows) {
      if (stream_.kind != SourceKind::gps || row->dimensions < 5) continue;
      const double apart_m_s = std::hypot(row->innovation[3], row->innovation[4]);
      if (beyond(*row) > 1.0 && !(apart_m_s < velocity_m_s)) velocity_m_s = apart_m_s;
    }
    // Measured minus predicted, of a heading.
    const double sign = heading && begin.innovation[0] > 0.0 ? -1.0 : 1.0;
    out_.push_back({.kind = heading   ? Kind::wrong_heading
                            : at_once ? Kind::jump
                                      : Kind::drag,
                    .weight = Weight::bad,
                    .subject = stream_.sensor.str(),
                    .begin_ns = begin.stamp_ns,
                    .end_ns = end.stamp_ns,
                    .word = std::string(to_string(stream_.kind)),
                    .figures = {{"count", static_cast<double>(stretch.rows.size())},
                                {"for_s", to_seconds(end.stamp_ns - begin.stamp_ns)},
                                {"first", sign * apart(begin, stream_.kind)},
                                {"most", sign * most},
                                {"first_sigma", sigma_of(begin)},
                                {"velocity_m_s", velocity_m_s},
                                {"disputed", disputed ? 1.0 : 0.0}},
                    .evidence = {{"fathom/v1/verdict", stretch.rows.size(), "rejected"}}});
    agreeing(out_.back());
  }

  [[nodiscard]] double sigma_of(const VerdictRow& row) const {
    if (stream_.kind == SourceKind::heading || row.dimensions < 2) return row.sigma[0];
    return std::hypot(row.sigma[0], row.sigma[1]);
  }

  /// The last ones before lay within their gate.
  [[nodiscard]] bool agreed_before(std::size_t first) const {
    std::size_t used = 0;
    for (std::size_t i = first; i-- > 0 && used < kBackAgain;) {
      if (rows_[i]->kind == VerdictKind::used && rows_[i]->test_ratio < 1.0) ++used;
      if (is_refusal(rows_[i]->kind)) return false;
    }
    return used == kBackAgain;
  }

  /// Who agreed with navigation meanwhile.
  void agreeing(Finding& found) const {
    std::vector<std::uint64_t> used(history_.streams().size());
    std::vector<std::uint64_t> refused(history_.streams().size());
    for (const VerdictRow& row : history_.verdicts()) {
      if (row.stamp_ns < found.begin_ns || row.stamp_ns > found.end_ns) continue;
      if (row.kind == VerdictKind::used) ++used[row.stream];
      if (is_refusal(row.kind)) ++refused[row.stream];
    }
    for (std::size_t i = 0; i < used.size(); ++i) {
      const Stream& other = history_.streams()[i];
      if (&other == &stream_ || other.kind == SourceKind::imu) continue;
      if (used[i] < kInARow || used[i] < 10 * refused[i]) continue;
      found.agreeing.push_back({other.sensor.str(), used[i]});
    }
    found.figures.push_back({"supported", found.agreeing.empty() ? 0.0 : 1.0});
  }

  void outliers() {
    std::uint64_t judged_count = 0;
    for (const VerdictRow* row : rows_) {
      judged_count += row->kind == VerdictKind::used || is_refusal(row->kind) ? 1U : 0U;
      if (row->kind == VerdictKind::used && beyond(*row) > 1.0) lone_.push_back(row);
    }
    const auto alone = static_cast<double>(lone_.size());
    if (lone_.size() < kFewest) return;
    const boost::math::binomial_distribution<double> chance(static_cast<double>(judged_count),
                                                            kUsualOutliers);
    if (boost::math::cdf(boost::math::complement(chance, alone - 1.0)) > kRefusalChance) return;
    double most = 0.0;
    double refused = 0.0;
    TimeNs begin_ns = lone_.front()->stamp_ns;
    TimeNs end_ns = begin_ns;
    for (const VerdictRow* row : lone_) {
      most = std::max(most, apart(*row, stream_.kind));
      refused += is_refusal(row->kind) ? 1.0 : 0.0;
      begin_ns = std::min(begin_ns, row->stamp_ns);
      end_ns = std::max(end_ns, row->stamp_ns);
    }
    out_.push_back(
        {.kind = Kind::outliers,
         .subject = stream_.sensor.str(),
         .begin_ns = begin_ns,
         .end_ns = end_ns,
         .word = std::string(to_string(stream_.kind)),
         .figures = {{"count", alone},
                     {"of", static_cast<double>(judged_count)},
                     {"refused", refused},
                     {"most", most}},
         .evidence = {{"fathom/v1/verdict", lone_.size(), "beyond the gate, alone or few at a time"}}});
  }

  /// Which silence of the inertial samples a row fell into; -1: none.
  [[nodiscard]] std::ptrdiff_t silence_of(const VerdictRow& row) const {
    for (std::size_t i = 0; i < out_.size(); ++i) {
      const Finding& one = out_[i];
      if (one.kind != Kind::imu_gap || one.word != "silent") continue;
      // Stamps are as much older than the arrival as samples take to come.
      if (row.stamp_ns >= one.begin_ns - kTravel_ns && row.stamp_ns <= one.end_ns + kTravel_ns)
        return static_cast<std::ptrdiff_t>(i);
    }
    return -1;
  }

  void refused(VerdictKind kind) {
    // While the inertial samples are silent all that comes is ahead of them: no clock is wrong.
    std::map<std::ptrdiff_t, Finding> found;
    std::map<std::ptrdiff_t, std::uint64_t> counts;
    for (const VerdictRow* row : rows_) {
      if (row->kind != kind) continue;
      const std::ptrdiff_t silence = kind == VerdictKind::from_the_future ? silence_of(*row) : -1;
      Finding& one = found[silence];
      if (counts[silence]++ == 0) one.begin_ns = row->stamp_ns;
      one.end_ns = row->stamp_ns;
    }
    for (auto& [silence, one] : found) {
      const std::uint64_t count = counts[silence];
      if (count < kManyCount || static_cast<double>(count) < kManyRefused * static_cast<double>(rows_.size()))
        continue;
      one.kind = Kind::refused;
      one.subject = stream_.sensor.str();
      one.word = std::string(to_string(kind));
      one.weight = 5 * count > rows_.size() ? Weight::bad : Weight::caution;
      one.figures = {{"count", static_cast<double>(count)},
                     {"of", static_cast<double>(rows_.size())},
                     {"imu_silent", silence < 0 ? 0.0 : 1.0}};
      one.evidence = {{"fathom/v1/verdict", count, one.word}};
      out_.push_back(std::move(one));
    }
  }

  const History& history_;
  const Track& track_;
  const Stream& stream_;
  Judged rows_;
  Findings& out_;
  double step_s_ = kUnknown;
  std::vector<const VerdictRow*> lone_;
};

}  // namespace

void watch_refusals(const History& history, const Track& track, Findings& out) {
  for (std::size_t i = 0; i < history.streams().size(); ++i)
    if (history.streams()[i].kind != SourceKind::imu) Refusals(history, track, i, out).all();
}

}  // namespace fathom::explain
