#include "logs/convert/ros2_parts.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/median.hpp"
#include "base/unknown.hpp"
#include "geo/so3.hpp"

namespace fathom::logs {
namespace {

constexpr TimeNs kSameClock_ns = 10 * kNsPerSecond;
constexpr TimeNs kYear2001_ns = 978'307'200 * kNsPerSecond;
constexpr int kDeepestTree = 64;
constexpr double kTurned = 1e-9;

TimeNs log_ns(const Log& log, const Series& series, std::size_t row) {
  return log.start_ns + series.t_us[row] * 1000;
}

// From forward-left-up to forward-right-down, and back.
Eigen::Matrix3d flip() {
  return Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
}

std::string plain(std::string frame) {
  while (frame.starts_with('/')) frame.erase(0, 1);
  return frame;
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace

Ros2Clock::Ros2Clock(const Log& log, const ConvertOptions& options, Vehicle& vehicle) : log_(log) {
  std::vector<double> offsets_ns;
  std::size_t with_rows = 0;
  for (const Series& series : log.series) {
    with_rows += series.rows() > 0 ? 1U : 0U;
    Place& place = places_[&series];
    place.seconds = series.find("header.stamp.sec");
    place.nanoseconds = series.find_any({"header.stamp.nanosec", "header.stamp.nsec"});
    std::vector<double> these_ns;
    for (std::size_t row = 0; row < series.rows(); ++row) {
      if (const auto stamp = stamp_ns(series, row))
        these_ns.push_back(static_cast<double>(log_ns(log, series, row) - *stamp));
    }
    const double offset_ns = median(std::move(these_ns));
    if (known(offset_ns)) offsets_ns.push_back(offset_ns);
    if (!(std::abs(offset_ns) < static_cast<double>(kSameClock_ns))) place.use = Use::log_time;
    if (series.rows() > 0 && place.use == Use::log_time && known(offset_ns)) {
      vehicle.notes.push_back(series.topic + ": header.stamp is " +
                              std::to_string(std::llround(offset_ns * 1e-9)) +
                              " s before the log's clock: its times are those of the log");
    }
  }
  // Every topic's stamps are of one clock, and that is not the log's: a simulation's, or a bag recorded anew.
  const bool other = std::none_of(places_.begin(), places_.end(),
                                  [](const auto& one) { return one.second.use == Use::both; });
  const auto [least, most] = std::minmax_element(offsets_ns.begin(), offsets_ns.end());
  TimeNs zero_ns = log.start_ns;
  if (other && with_rows > 0 && offsets_ns.size() == with_rows &&
      *most - *least < static_cast<double>(kSameClock_ns)) {
    bool first = true;
    for (auto& [series, place] : places_) {
      place.use = Use::stamp;
      for (std::size_t row = 0; row < series->rows(); ++row) {
        const auto stamp = stamp_ns(*series, row);
        if (!stamp) continue;
        zero_ns = first ? *stamp : std::min(zero_ns, *stamp);
        first = false;
      }
    }
    vehicle.notes.push_back(
        "every header.stamp is of one other clock than the log's: times are by these stamps, "
        "and arrivals are not known");
  }
  if (zero_ns > kYear2001_ns) vehicle.utc_of_start_ns = zero_ns;
  if (options.utc && !vehicle.utc_of_start_ns)
    throw LogError("its times are not of this century, expected UTC to count t_s in it");
  shift_ns_ = options.utc ? 0 : dataset::kDefaultEpochNs - zero_ns;
}

std::optional<TimeNs> Ros2Clock::stamp_ns(const Series& series, std::size_t row) const {
  const Place& place = places_.at(&series);
  const double seconds = series.at(row, place.seconds);
  const double nanoseconds = series.at(row, place.nanoseconds);
  // 0 is what a driver leaves that does not stamp.
  constexpr double kMost_s = 4e9;
  if (!(seconds >= 0.0 && seconds < kMost_s && nanoseconds >= 0.0 && nanoseconds < 1e9 &&
        seconds + nanoseconds > 0.0))
    return std::nullopt;
  return static_cast<TimeNs>(seconds) * kNsPerSecond + static_cast<TimeNs>(nanoseconds);
}

std::optional<SampleHeader> Ros2Clock::header(const Series& series, std::size_t row) const {
  const Use use = places_.at(&series).use;
  const TimeNs logged = log_ns(log_, series, row);
  const auto stamp = stamp_ns(series, row);
  SampleHeader out;
  out.stamp_ns = out.received_ns = logged;
  if (use == Use::stamp) {
    if (!stamp) return std::nullopt;
    out.stamp_ns = out.received_ns = *stamp;
  } else if (use == Use::both && stamp && std::abs(logged - *stamp) < kSameClock_ns) {
    out.stamp_ns = *stamp;
    out.received_ns = std::max(logged, *stamp);
  }
  out.stamp_ns += shift_ns_;
  out.received_ns += shift_ns_;
  return out;
}

Ros2Frames::Ros2Frames(const Log& log, const ConvertOptions& options) : options_(options.ros2) {
  for (const Placement& one : log.placements) parents_[plain(one.child)] = &one;  // the last one holds
  std::set<std::string> topics, frames;
  for (const Series& series : log.series) {
    topics.insert(series.topic);
    for (const std::string& frame : {series.frame, series.child_frame})
      if (!frame.empty()) frames.insert(plain(frame));
  }
  const auto expect = [](const std::string& option, const std::string& word,
                         const std::set<std::string>& all) {
    if (all.contains(word)) return;
    std::string have;
    for (const std::string& one : all) have += (have.empty() ? "" : ", ") + one;
    throw LogError(option + " " + word + ": the log has no such, expected one of " +
                   (have.empty() ? "none" : have));
  };
  for (const auto& [topic, axes] : options_.axes) expect("--axes", topic, topics);
  for (const auto& [frame, rpy] : options_.mounting_rpy_rad) expect("--mounting", frame, frames);
}

Ros2Frames::Pose Ros2Frames::to_root(std::string frame) const {
  Pose pose;
  for (int level = 0; level < kDeepestTree; ++level) {
    const auto found = parents_.find(frame);
    if (found == parents_.end()) break;
    const auto& [w, x, y, z] = found->second->q_wxyz;
    const Eigen::Matrix3d C = geo::to_matrix(geo::normalized({w, x, y, z}));
    pose.p = C * pose.p + Eigen::Vector3d(found->second->translation_m.data());
    pose.C = C * pose.C;
    frame = plain(found->second->parent);
  }
  pose.root = frame;
  return pose;
}

std::optional<Ros2Frames::Pose> Ros2Frames::in_base(const std::string& frame) const {
  const Pose sensor = to_root(plain(frame));
  const Pose base = to_root(plain(options_.base));
  if (frame.empty() || sensor.root != base.root) return std::nullopt;
  return Pose{base.C.transpose() * sensor.C, base.C.transpose() * (sensor.p - base.p), {}};
}

Mounting Ros2Frames::of(const Series& series, const std::string& frame, Ros2Options::Axes by_default) const {
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity();  // forward-left-up of the sensor to that of the body
  Mounting out;
  std::string from = "as the vehicle";
  const auto given = options_.mounting_rpy_rad.find(plain(frame));
  if (given != options_.mounting_rpy_rad.end()) {
    const Eigen::Vector3d rpy_rad(given->second.data());
    C = flip() * geo::to_matrix(geo::from_rpy(rpy_rad)) * flip();
    from = "by --mounting";
  } else if (const auto pose = in_base(frame); pose && plain(frame) != plain(options_.base)) {
    C = pose->C;
    from = "by tf_static";
  }
  out.turned = !C.isIdentity(kTurned);
  Ros2Options::Axes axes = by_default;
  if (const auto asked = options_.axes.find(series.topic); asked != options_.axes.end()) {
    axes = asked->second;
  } else if (out.turned && given == options_.mounting_rpy_rad.end()) {
    axes = Ros2Options::Axes::flu;  // the transform is from the axes that the message has
  } else if (frame.ends_with("_ned") || frame.ends_with("_frd")) {
    axes = Ros2Options::Axes::frd;
  }
  out.ned = axes == Ros2Options::Axes::frd;
  out.C_BS = out.ned ? Eigen::Matrix3d(flip() * C * flip()) : Eigen::Matrix3d(flip() * C);
  out.how = std::string(out.ned ? "forward-right-down" : "forward-left-up") +
            (out.turned ? ", turned " : ", mounted ") + from;
  return out;
}

std::optional<Eigen::Vector3d> Ros2Frames::lever_B_m(const std::string& frame) const {
  const auto pose = in_base(frame);
  if (!pose || parents_.empty()) return std::nullopt;
  return Eigen::Vector3d(flip() * pose->p);
}

std::optional<std::array<std::size_t, 3>> xyz_of(const Series& series, const std::string& stem) {
  return series.find_three({stem + ".x", stem + ".y", stem + ".z"});
}

Eigen::Vector3d vector_at(const Series& series, std::size_t row, const std::array<std::size_t, 3>& xyz) {
  return {series.at(row, xyz[0]), series.at(row, xyz[1]), series.at(row, xyz[2])};
}

double sigma_of(double variance) {
  return variance > 0.0 ? std::sqrt(variance) : kUnknown;
}

std::vector<const Series*> of_type(const Log& log, std::string_view type) {
  std::vector<const Series*> out;
  for (const Series& series : log.series)
    if (series.type == type && series.rows() > 0) out.push_back(&series);
  std::stable_sort(out.begin(), out.end(), [](const Series* a, const Series* b) {
    return std::pair(a->topic, a->instance) < std::pair(b->topic, b->instance);
  });
  return out;
}

std::string ros2_label(const Log& log, const Series& series) {
  return log.of(series.topic).size() > 1 ? series.label() : series.topic;
}

bool is_called(const Series& series, std::string_view word) {
  for (const std::string& text : {series.topic, series.frame, series.child_frame})
    if (lower(text).find(word) != std::string::npos) return true;
  return false;
}

std::optional<Twist> twist_of(const Series& series) {
  for (const char* stem : {"twist.twist", "twist"}) {
    const auto linear = xyz_of(series, std::string(stem) + ".linear");
    if (!linear) continue;
    Twist out{&series, *linear, std::nullopt};
    // 6 by 6, row by row: linear, then angular.
    out.variance = series.find_three({"twist.covariance[0]", "twist.covariance[7]", "twist.covariance[14]"});
    return out;
  }
  return std::nullopt;
}

}  // namespace fathom::logs
