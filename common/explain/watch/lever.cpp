#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/LU>

#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

// Chi-square of two dimensions that chance passes in one of three million logs.
constexpr double kLeverChance = 30.0;
constexpr double kLeastLever_m = 1.0;  // less than a good fix is worth nobody can tell, and nobody need
constexpr std::size_t kLeastFixes = 40;

struct Row {
  Eigen::Matrix2d pattern;     // innovation over lever, along B
  Eigen::Vector2d innovation;  // measured minus predicted
  double variance = 1.0;
};

/// Something else was wrong with the source, or with the heading that turns its lever.
bool spoilt(const VerdictRow& row, const std::string& sensor, const Findings& known_causes) {
  constexpr DurationNs kAfter_ns = 30 * kNsPerSecond;
  return std::any_of(known_causes.begin(), known_causes.end(), [&](const Finding& one) {
    if (one.kind != Kind::wrong_heading && one.subject != sensor) return false;
    if (one.kind == Kind::lost || one.kind == Kind::refused || one.kind == Kind::outliers) return false;
    return row.stamp_ns > one.begin_ns - kNsPerSecond && row.stamp_ns < one.end_ns + kAfter_ns;
  });
}

/// Turn rate about an instant; unknown where states are missing.
double turn_rate_rad_s(const Track& track, TimeNs at_ns) {
  constexpr DurationNs kHalf_ns = kNsPerSecond / 2;
  const StateRow* before = track.at(at_ns - kHalf_ns);
  const StateRow* after = track.at(at_ns + kHalf_ns);
  if (before == nullptr || after == nullptr || after->at_ns <= before->at_ns) return kUnknown;
  return std::remainder(after->yaw_rad - before->yaw_rad, 2.0 * std::numbers::pi) /
         to_seconds(after->at_ns - before->at_ns);
}

struct Rows {
  std::vector<Row> place;
  std::vector<Row> speed;
  double way_m_s = 0.0;  // mean of the speed over ground
};

/// What a lever error makes of the innovations: the antenna's place turns with the vehicle, and navigation
/// follows it by its gain with each fix; its velocity swings while the vehicle turns.
Rows rows_of(const Judged& judged, const Track& track, const std::string& sensor,
             const Findings& known_causes) {
  Rows out;
  Eigen::Matrix2d absorbed = Eigen::Matrix2d::Zero();
  TimeNs last_ns = 0;
  for (const VerdictRow* verdict : judged) {
    if (verdict->kind != VerdictKind::used || verdict->dimensions < 2) continue;
    if (spoilt(*verdict, sensor, known_causes)) continue;
    const StateRow* state = track.at(verdict->stamp_ns);
    if (state == nullptr || !navigating(*state) || !std::isfinite(state->yaw_rad)) continue;
    const auto& z = verdict->innovation;
    const double variance = verdict->sigma[0] * verdict->sigma[1];
    if (!std::isfinite(z[0] + z[1]) || !(variance > 0.0)) continue;
    const double c = std::cos(state->yaw_rad);
    const double s = std::sin(state->yaw_rad);
    Eigen::Matrix2d turn;
    turn << c, -s, s, c;
    // After a pause navigation has gone its own way: it begins anew.
    if (out.place.empty() || verdict->stamp_ns - last_ns > 30 * kNsPerSecond) absorbed = turn;
    last_ns = verdict->stamp_ns;
    out.place.push_back({turn - absorbed, {-z[0], -z[1]}, variance});
    const double own = 0.5 * state->sigma_m * state->sigma_m;
    absorbed += std::clamp(own / variance, 0.0, 1.0) * (turn - absorbed);
    out.way_m_s += std::hypot(state->velocity_N_m_s[0], state->velocity_N_m_s[1]);
    const double rate = turn_rate_rad_s(track, verdict->stamp_ns);
    const double speed_variance = verdict->sigma[3] * verdict->sigma[4];
    if (verdict->dimensions < 5 || !std::isfinite(rate + z[3] + z[4]) || !(speed_variance > 0.0)) continue;
    Eigen::Matrix2d cross;
    cross << 0.0, -rate, rate, 0.0;
    out.speed.push_back({turn * cross, {-z[3], -z[4]}, speed_variance});
  }
  if (!out.place.empty()) out.way_m_s /= static_cast<double>(out.place.size());
  return out;
}

struct Fit {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d seen = Eigen::Vector2d::Zero();
};

Fit fit(const std::vector<Row>& rows) {
  Fit out;
  for (const Row& row : rows) {
    out.information += row.pattern.transpose() * row.pattern / row.variance;
    out.seen += row.pattern.transpose() * row.innovation / row.variance;
  }
  return out;
}

/// The correlation of each row's rest with that of the row before.
double correlation(const std::vector<Row>& rows, const Eigen::Vector2d& lever) {
  double sum = 0.0;
  double power = 0.0;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  for (const Row& row : rows) {
    const Eigen::Vector2d rest = (row.innovation - row.pattern * lever) / std::sqrt(row.variance);
    sum += rest.dot(last);
    power += rest.squaredNorm();
    last = rest;
  }
  return power > 0.0 ? std::clamp(sum / power, 0.0, 0.99) : 0.0;
}

/// The lever's information in rows whose errors last: each row less what the one before tells of it, and then
/// as much weaker as the rests scatter more than they should.
Fit whitened(const std::vector<Row>& rows) {
  Fit out;
  if (rows.size() < kLeastFixes) return out;
  Eigen::Vector2d lever = Eigen::Vector2d::Zero();
  std::vector<Row> white;
  for (int round = 0; round < 3; ++round) {
    const double r = correlation(rows, lever);
    white.clear();
    for (std::size_t i = 1; i < rows.size(); ++i)
      white.push_back({rows[i].pattern - r * rows[i - 1].pattern,
                       rows[i].innovation - r * rows[i - 1].innovation, rows[i].variance * (1.0 - r * r)});
    out = fit(white);
    // Without turns there is nothing to tell.
    if (!(out.information.determinant() > 1e-9)) return {};
    lever = out.information.inverse() * out.seen;
  }
  double power = 0.0;
  for (const Row& row : white) power += (row.innovation - row.pattern * lever).squaredNorm() / row.variance;
  const double factor = std::max(1.0, power / (2.0 * static_cast<double>(white.size())));
  out.information /= factor;
  out.seen /= factor;
  return out;
}

}  // namespace

void watch_lever(const History& history, const Track& track, Findings& out) {
  for (std::size_t i = 0; i < history.streams().size(); ++i) {
    const Stream& stream = history.streams()[i];
    if (stream.kind != SourceKind::gps) continue;
    const Judged verdicts = judged(history, i);
    const Rows rows = rows_of(verdicts, track, stream.sensor.str(), out);
    const Fit place = whitened(rows.place);
    const Fit speed = whitened(rows.speed);
    const Eigen::Matrix2d information = place.information + speed.information;
    const Eigen::Vector2d seen = place.seen + speed.seen;
    if (!(information.determinant() > 1e-9)) continue;
    const Eigen::Matrix2d covariance = information.inverse();
    const Eigen::Vector2d lever = covariance * seen;
    const double evidence = seen.dot(lever);
    if (evidence < kLeverChance || lever.norm() < kLeastLever_m) continue;
    out.push_back(
        {.kind = Kind::wrong_lever,
         .subject = stream.sensor.str(),
         .begin_ns = verdicts.front()->stamp_ns,
         .end_ns = verdicts.back()->stamp_ns,
         .figures = {{"forward_m", lever.x()},
                     {"right_m", lever.y()},
                     {"sigma_m", std::sqrt(covariance.trace() / 2.0)},
                     {"fixes", static_cast<double>(rows.place.size())},
                     {"speed_m_s", rows.way_m_s},
                     {"chi_square", evidence}},
         .evidence = {{"fathom/v1/verdict", rows.place.size(), "innovations, turned into the body"}}});
  }
}

}  // namespace fathom::explain
