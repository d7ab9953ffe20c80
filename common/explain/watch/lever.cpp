#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/LU>

#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

// Chi-square of two dimensions that chance passes in one of three million logs.
constexpr double kChance = 30.0;
constexpr double kLeast_m = 1.0;  // less than a good fix is worth nobody can tell, and nobody need
constexpr std::size_t kFixes = 40;
constexpr std::size_t kLags = 30;  // of the correlation of a receiver's errors

struct Row {
  Eigen::Matrix2d pattern;  // innovation over lever, along B
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

/// What a lever error would have made of the innovations: the antenna's place turns with the vehicle, and
/// navigation follows it by its gain with each fix.
std::vector<Row> rows_of(const Judged& judged, const Track& track, const std::string& sensor,
                         const Findings& known_causes) {
  std::vector<Row> out;
  Eigen::Matrix2d absorbed = Eigen::Matrix2d::Zero();
  TimeNs last_ns = 0;
  for (const VerdictRow* verdict : judged) {
    if (verdict->kind != VerdictKind::used || verdict->dimensions < 2) continue;
    if (spoilt(*verdict, sensor, known_causes)) continue;
    const StateRow* state = track.at(verdict->stamp_ns);
    if (state == nullptr || !navigating(*state) || !std::isfinite(state->yaw_rad)) continue;
    const double variance = verdict->sigma[0] * verdict->sigma[1];
    if (!std::isfinite(verdict->innovation[0] + verdict->innovation[1]) || !(variance > 0.0)) continue;
    const double c = std::cos(state->yaw_rad);
    const double s = std::sin(state->yaw_rad);
    Eigen::Matrix2d turn;
    turn << c, -s, s, c;
    // After a pause navigation has gone its own way: it begins anew.
    if (out.empty() || verdict->stamp_ns - last_ns > 30 * kNsPerSecond) absorbed = turn;
    last_ns = verdict->stamp_ns;
    out.push_back({turn - absorbed, {-verdict->innovation[0], -verdict->innovation[1]}, variance});
    const double own = 0.5 * state->sigma_m * state->sigma_m;
    absorbed += std::clamp(own / variance, 0.0, 1.0) * (turn - absorbed);
  }
  return out;
}

/// By how much errors that last make a sum scatter more than errors that do not.
double correlation_factor(const std::vector<Row>& rows, const Eigen::Vector2d& lever) {
  std::vector<Eigen::Vector2d> rest;
  double power = 0.0;
  for (const Row& row : rows) {
    rest.push_back((row.innovation - row.pattern * lever) / std::sqrt(row.variance));
    power += rest.back().squaredNorm();
  }
  double factor = 1.0;
  for (std::size_t lag = 1; lag <= std::min(kLags, rows.size() / 4); ++lag) {
    double sum = 0.0;
    for (std::size_t i = lag; i < rest.size(); ++i) sum += rest[i].dot(rest[i - lag]);
    if (sum <= 0.0) break;
    factor += 2.0 * sum / power;
  }
  return factor * std::max(1.0, power / (2.0 * static_cast<double>(rows.size())));
}

}  // namespace

void watch_lever(const History& history, const Track& track, Findings& out) {
  for (std::size_t i = 0; i < history.streams().size(); ++i) {
    const Stream& stream = history.streams()[i];
    if (stream.kind != SourceKind::gps) continue;
    const Judged verdicts = judged(history, i);
    const std::vector<Row> rows = rows_of(verdicts, track, stream.sensor.str(), out);
    if (rows.size() < kFixes) continue;
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    Eigen::Vector2d seen = Eigen::Vector2d::Zero();
    for (const Row& row : rows) {
      information += row.pattern.transpose() * row.pattern / row.variance;
      seen += row.pattern.transpose() * row.innovation / row.variance;
    }
    // Without turns there is nothing to tell.
    if (!(std::abs(information.determinant()) > 1e-9)) continue;
    const Eigen::Matrix2d covariance = information.inverse();
    const Eigen::Vector2d lever = covariance * seen;
    const double factor = correlation_factor(rows, lever);
    const double evidence = seen.dot(lever) / factor;
    if (evidence < kChance || lever.norm() < kLeast_m) continue;
    out.push_back({.kind = Kind::wrong_lever,
                   .subject = stream.sensor.str(),
                   .begin_ns = verdicts.front()->stamp_ns,
                   .end_ns = verdicts.back()->stamp_ns,
                   .figures = {{"forward_m", lever.x()},
                               {"right_m", lever.y()},
                               {"sigma_m", std::sqrt(factor * covariance.trace() / 2.0)},
                               {"fixes", static_cast<double>(rows.size())},
                               {"chi_square", evidence}},
                   .evidence = {{"fathom/v1/verdict", rows.size(), "innovations, turned into the body"}}});
  }
}

}  // namespace fathom::explain
