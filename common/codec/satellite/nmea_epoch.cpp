#include "codec/satellite/nmea_epoch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom::codec {
namespace {

constexpr DurationNs kHalfDay = kNsPerSecond * 3600 * 12;
constexpr DurationNs kDay = 2 * kHalfDay;

constexpr double kEarth_m = 6.371e6;
constexpr double kRounding_m = 185.0;  // a tenth of a minute: what the coarsest sentences resolve
constexpr double kSigmas = 5.0;

/// The fix of the epoch: the sentence that grades it best decides, RMC may only take away.
GpsFix joint_fix(const GpsReport* fixed, const GpsReport* rmc) {
  if (fixed == nullptr) return rmc != nullptr ? rmc->fix : GpsFix::none;
  GpsFix fix = fixed->fix;
  if (fix == GpsFix::fix_3d && !known(fixed->altitude_msl_m)) fix = GpsFix::fix_2d;
  if (rmc != nullptr && rmc->fix <= GpsFix::dead_reckoning) fix = std::min(fix, rmc->fix);
  return fix;
}

void set_velocity(GpsSample& sample, const GpsReport& report) {
  if (known(report.speed_m_s) && known(report.course_rad)) {
    sample.course_rad = report.course_rad;
    sample.velocity_N_m_s[0] = report.speed_m_s * std::cos(report.course_rad);
    sample.velocity_N_m_s[1] = report.speed_m_s * std::sin(report.course_rad);
  } else if (report.speed_m_s == 0.0) {
    // Receivers leave the course out when they stand still.
    sample.velocity_N_m_s[0] = 0.0;
    sample.velocity_N_m_s[1] = 0.0;
  }
}

}  // namespace

const GpsReport* GpsEpochs::Epoch::find(GpsSentence type) const {
  const std::optional<GpsReport>& found = part[static_cast<std::size_t>(type)];
  return found ? &*found : nullptr;
}

std::uint8_t GpsEpochs::Epoch::mask() const {
  std::uint8_t bits = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part[i]) bits = static_cast<std::uint8_t>(bits | (1U << i));
  }
  return bits;
}

bool GpsEpochs::add(const GpsReport& report, std::uint64_t offset, std::uint64_t length,
                    const Deliver& deliver) {
  if (report.midnight && report.time_of_day) {
    midnight_ = report.midnight;
    dated_at_ = *report.time_of_day;
  }
  if (report.type == GpsSentence::zda) {
    date_epoch(report);
    return true;
  }
  if (epoch_ && belongs(report)) {
    if (contradicts(report)) return false;
    join(report, offset, length);
  } else if (report.type == GpsSentence::vtg) {
    waiting_vtg_ = Waiting{report, offset, length};
    return true;
  } else if (report.type == GpsSentence::gst) {
    waiting_gst_ = Waiting{report, offset, length};
    return true;
  } else {
    open_next(report, offset, length, deliver);
  }
  if (!epoch_->delivered && cycle_complete()) deliver_open(deliver);
  return true;
}

void GpsEpochs::finish(const Deliver& deliver) {
  close(deliver);
  *this = GpsEpochs();
}

void GpsEpochs::date_epoch(const GpsReport& report) {
  // A ZDA of another second dates the stream and not this epoch.
  if (!epoch_ || epoch_->delivered || !report.time_of_day) return;
  if (!epoch_->time_of_day) epoch_->time_of_day = report.time_of_day;
  if (epoch_->time_of_day == report.time_of_day && !epoch_->midnight) epoch_->midnight = report.midnight;
}

bool GpsEpochs::belongs(const GpsReport& report) const {
  const bool same_time = report.time_of_day && epoch_->time_of_day == report.time_of_day;
  if (const GpsReport* twin = epoch_->find(report.type)) {
    // Two talkers may report the same epoch; one talker repeating itself begins another.
    return same_time && twin->talker != report.talker;
  }
  if (report.type == GpsSentence::vtg || same_time) return true;
  if (report.type == GpsSentence::gst) return false;
  return !epoch_->delivered && (!report.time_of_day || !epoch_->time_of_day);
}

bool GpsEpochs::contradicts(const GpsReport& report) const {
  if (!known(report.latitude_rad) || !known(report.longitude_rad)) return false;
  const GpsReport* gst = epoch_->find(GpsSentence::gst);
  const double sigma_m = gst == nullptr ? kUnknown : std::hypot(gst->sigma_N_m[0], gst->sigma_N_m[1]);
  const double apart_m = kRounding_m + (known(sigma_m) ? kSigmas * sigma_m : 0.0);
  return std::any_of(epoch_->part.begin(), epoch_->part.end(), [&](const std::optional<GpsReport>& part) {
    if (!part || !known(part->latitude_rad) || !known(part->longitude_rad)) return false;
    const double north_m = kEarth_m * (report.latitude_rad - part->latitude_rad);
    const double east_m = kEarth_m * std::cos(report.latitude_rad) *
                          std::remainder(report.longitude_rad - part->longitude_rad, 2.0 * std::numbers::pi);
    return std::hypot(north_m, east_m) > apart_m;
  });
}

void GpsEpochs::join(const GpsReport& report, std::uint64_t offset, std::uint64_t length) {
  std::optional<GpsReport>& part = epoch_->part[static_cast<std::size_t>(report.type)];
  if (part) return;
  part = report;
  if (!epoch_->time_of_day) epoch_->time_of_day = report.time_of_day;
  if (report.midnight) epoch_->midnight = report.midnight;
  epoch_->offset = std::min(epoch_->offset, offset);
  epoch_->end = std::max(epoch_->end, offset + length);
}

void GpsEpochs::open_next(const GpsReport& report, std::uint64_t offset, std::uint64_t length,
                          const Deliver& deliver) {
  close(deliver);
  epoch_ = Epoch{};
  epoch_->offset = offset;
  join(report, offset, length);
  if (waiting_vtg_) join(waiting_vtg_->report, waiting_vtg_->offset, waiting_vtg_->length);
  if (waiting_gst_ && waiting_gst_->report.time_of_day == report.time_of_day) {
    join(waiting_gst_->report, waiting_gst_->offset, waiting_gst_->length);
  }
  waiting_vtg_.reset();
  waiting_gst_.reset();
}

void GpsEpochs::close(const Deliver& deliver) {
  if (!epoch_) return;
  if (!epoch_->delivered) deliver_open(deliver);
  cycles_[closed_ % kHistory] = epoch_->mask();
  ++closed_;
  epoch_.reset();
}

bool GpsEpochs::cycle_complete() const {
  if (closed_ < 2) return false;
  std::uint8_t expected = 0;
  for (const std::uint8_t mask : cycles_) expected = static_cast<std::uint8_t>(expected | mask);
  return (expected & ~epoch_->mask()) == 0;
}

DeviceTime GpsEpochs::time_of(const Epoch& epoch) {
  DeviceTime time;
  if (!epoch.time_of_day) return time;
  if (epoch.midnight) {
    midnight_ = epoch.midnight;
  } else if (midnight_) {
    if (*epoch.time_of_day < dated_at_ - kHalfDay) *midnight_ += kDay;
    if (*epoch.time_of_day > dated_at_ + kHalfDay) *midnight_ -= kDay;
  }
  if (midnight_) {
    dated_at_ = *epoch.time_of_day;
    time.utc_ns = *midnight_ + *epoch.time_of_day;
  } else {
    time.time_of_day_ns = epoch.time_of_day;
  }
  return time;
}

void GpsEpochs::deliver_open(const Deliver& deliver) {
  epoch_->delivered = true;
  const GpsReport* gga = epoch_->find(GpsSentence::gga);
  const GpsReport* gns = epoch_->find(GpsSentence::gns);
  const GpsReport* rmc = epoch_->find(GpsSentence::rmc);
  const GpsReport* vtg = epoch_->find(GpsSentence::vtg);
  const GpsReport* gst = epoch_->find(GpsSentence::gst);
  const GpsReport* fixed = gga != nullptr ? gga : gns;
  // GGA, GNS or RMC opened the epoch.
  const GpsReport* opening = fixed != nullptr ? fixed : rmc;
  if (opening == nullptr) return;
  const GpsReport& position = *opening;

  GpsSample sample;
  sample.satellites = position.satellites;
  sample.hdop = position.hdop;
  sample.fix = joint_fix(fixed, rmc);
  if (!known(position.latitude_rad) || !known(position.longitude_rad)) sample.fix = GpsFix::none;
  if (sample.fix != GpsFix::none) {
    sample.latitude_rad = position.latitude_rad;
    sample.longitude_rad = position.longitude_rad;
    sample.altitude_msl_m = position.altitude_msl_m;
    sample.altitude_m = position.altitude_msl_m + position.geoid_separation_m;
    if (gst != nullptr) sample.position_sigma_N_m = gst->sigma_N_m;
    if (rmc != nullptr) {
      set_velocity(sample, *rmc);
    } else if (vtg != nullptr && vtg->fix != GpsFix::none) {
      set_velocity(sample, *vtg);
    }
  }
  deliver(sample, time_of(*epoch_), epoch_->offset, epoch_->end - epoch_->offset);
}

}  // namespace fathom::codec
