#include "codec/satellite/fix_epochs.hpp"

#include <utility>

namespace fathom::codec {
namespace {

constexpr int kWaitsInVain = 2;

void join_velocity(GpsSample& sample, const EpochVelocity& velocity) {
  if (sample.fix == GpsFix::none) return;
  sample.velocity_N_m_s = velocity.velocity_N_m_s;
  sample.velocity_sigma_N_m_s = velocity.sigma_N_m_s;
  sample.course_rad = velocity.course_rad;
}

}  // namespace

void FixEpochs::add_position(std::uint32_t time_of_week_ms, const Fix& fix, const Deliver& deliver) {
  release(deliver);
  const std::optional<EpochVelocity> before = std::exchange(velocity_, std::nullopt);
  if (before && before->time_of_week_ms == time_of_week_ms) {
    Fix joined = fix;
    join_velocity(joined.sample, *before);
    deliver(joined);
  } else if (patience_ > 0) {
    waiting_ = Waiting{time_of_week_ms, fix};
  } else {
    delivered_alone_ms_ = time_of_week_ms;
    deliver(fix);
  }
}

bool FixEpochs::add_velocity(const EpochVelocity& velocity, const Deliver& deliver) {
  if (waiting_ && waiting_->time_of_week_ms == velocity.time_of_week_ms) {
    patience_ = kWaitsInVain;
    join_velocity(waiting_->fix.sample, velocity);
    deliver(waiting_->fix);
    waiting_.reset();
    return true;
  }
  if (delivered_alone_ms_ == velocity.time_of_week_ms) {
    patience_ = kWaitsInVain;
    delivered_alone_ms_.reset();
    return false;
  }
  velocity_ = velocity;
  return false;
}

void FixEpochs::finish(const Deliver& deliver) {
  release(deliver);
  *this = FixEpochs();
}

void FixEpochs::release(const Deliver& deliver) {
  if (!waiting_) return;
  --patience_;
  delivered_alone_ms_ = waiting_->time_of_week_ms;
  deliver(waiting_->fix);
  waiting_.reset();
}

}  // namespace fathom::codec
