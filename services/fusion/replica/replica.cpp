#include "fusion/replica/replica.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fathom::fusion {
namespace {

constexpr double kMeanRadius_m = 6.371e6;
constexpr double kPosition_m = 1e-3;
constexpr double kVelocity_m_s = 1e-3;
constexpr double kAttitude = 5e-6;  // of a quaternion's component: half an angle

// Each service publishes its status five times a second.
constexpr DurationNs kToldFor_ns = kNsPerSecond;
constexpr DurationNs kTellsWithin_ns = 500 * kNsPerMillisecond;
constexpr DurationNs kNewcomer_ns = 10 * kNsPerSecond;
constexpr int kAlikeForLong = 100;
constexpr std::size_t kMostPeers = 16;

template <std::size_t N>
bool within(const std::array<double, N>& a, const std::array<double, N>& b,
            const std::array<double, N>& most) {
  for (std::size_t i = 0; i < N; ++i) {
    const bool unknown = std::isnan(a[i]) && std::isnan(b[i]);
    if (!unknown && !(std::abs(a[i] - b[i]) <= most[i])) return false;
  }
  return true;
}

}  // namespace

StateMark mark_of(const NavState& state) {
  return {state.header.stamp_ns,
          state.header.sequence,
          {state.latitude_rad, state.longitude_rad, state.altitude_m},
          state.velocity_N_m_s,
          state.q_NB};
}

bool alike(const StateMark& a, const StateMark& b) {
  constexpr double kAngle = kPosition_m / kMeanRadius_m;
  return a.sequence == b.sequence &&
         within(a.position_rad_m, b.position_rad_m, {kAngle, kAngle, kPosition_m}) &&
         within(a.velocity_N_m_s, b.velocity_N_m_s, {kVelocity_m_s, kVelocity_m_s, kVelocity_m_s}) &&
         within(a.q_NB, b.q_NB, {kAttitude, kAttitude, kAttitude, kAttitude});
}

bool has_position(const StateMark& mark) {
  return !std::isnan(mark.position_rad_m[0]) && !std::isnan(mark.position_rad_m[1]);
}

Replica::Replica(const Options& options, TimeNs now_ns) : options_(options), since_ns_(now_ns) {}

bool Replica::own(const NavState& state, TimeNs now_ns) {
  const bool gap = own_ns_ != 0 && now_ns - own_ns_ > options_.gap_ns;
  const bool company = others_ > 0 || alone_ns_ != 0;
  if (phase_ == ReplicaPhase::in_step && gap && company && missed_lately_) {
    phase_ = ReplicaPhase::listening;
    since_ns_ = now_ns;
    other_ns_ = 0;
  }
  if (yielded_ns_ && own_ns_ != 0 && now_ns - own_ns_ > options_.pause_ns) yielded_ns_ = now_ns;
  if (!leaves_the_lead(now_ns)) yielded_ns_.reset();
  if (gap) late_.reset();  // what waited meanwhile is only now coming in
  own_ns_ = now_ns;
  missed_lately_ = false;
  if (others_ > 0) alone_ns_ = 0;

  const StateMark mark = mark_of(state);
  const bool withheld = withholds_late(lateness_.of(mark.stamp_ns, now_ns), now_ns);
  own_marks_[own_count_++ % own_marks_.size()] = mark;
  while (waiting_count_ > 0 && waiting_[waiting_first_].stamp_ns <= mark.stamp_ns) {
    const StateMark other = waiting_[waiting_first_];
    waiting_first_ = (waiting_first_ + 1) % waiting_.size();
    --waiting_count_;
    if (other.stamp_ns == mark.stamp_ns) {
      compare(mark, other, now_ns);
    } else {
      differs(now_ns, "has a state that this one has not");
    }
  }

  if (phase_ == ReplicaPhase::listening && now_ns - since_ns_ >= options_.listen_ns) {
    come_in_step(now_ns);
    follows_ = false;
    began_alone_ = true;
  }
  if (phase_ == ReplicaPhase::behind && now_ns - other_ns_ > options_.silence_ns) {
    come_in_step(now_ns);
    follows_ = false;
    began_alone_ = true;
    ++unprepared_;
  }
  // A service that takes the lead back does not publish again what the other one has published.
  const bool said = follows_ && mark.stamp_ns <= other_stamp_ns_;
  return phase_ == ReplicaPhase::in_step && !said && !(withheld && company) && !yielded_ns_;
}

bool Replica::withholds_late(DurationNs lateness_ns, TimeNs now_ns) {
  if (lateness_ns <= options_.late_ns) {
    late_.reset();
    return false;
  }
  if (!late_) late_ = {now_ns, lateness_ns};
  if (const DurationNs span_ns = now_ns - late_->since_ns; span_ns >= options_.silence_ns) {
    // What was kept from it comes faster than it was measured, and the newest will be in time.
    const bool catches_up = late_->lateness_ns - lateness_ns > span_ns / 2;
    late_ = {now_ns, lateness_ns, !catches_up};
  }
  return !late_->lasts || now_ns - other_ns_ <= options_.silence_ns;
}

bool Replica::leaves_the_lead(TimeNs now_ns) const {
  return yielded_ns_ && now_ns - *yielded_ns_ < options_.hold_ns &&
         now_ns - other_ns_ < options_.hold_silence_ns;
}

bool Replica::is_weaker(const Name& instance, TimeNs now_ns) const {
  const auto found = peers_.find(instance);
  return found != peers_.end() && now_ns - found->second.told_ns <= kToldFor_ns &&
         found->second.status.ownership_strength < options_.strength;
}

DurationNs Lateness::of(TimeNs stamp_ns, TimeNs now_ns) {
  const DurationNs offset_ns = now_ns - stamp_ns;
  const bool stepped = begun_ && offset_ns - least_ns_ > kStep_ns;
  if (stepped) begun_ = false;
  const bool over = !begun_ || now_ns - begun_ns_ > kWindow_ns;
  if (over) {
    before_ns_ = begun_ ? least_ns_ : offset_ns;
    least_ns_ = offset_ns;
    begun_ns_ = now_ns;
    begun_ = true;
  }
  least_ns_ = std::min(least_ns_, offset_ns);
  return offset_ns - std::min(least_ns_, before_ns_);
}

void Replica::heard(const NavState& state, bool self, TimeNs now_ns) {
  const bool led = !std::exchange(follows_, !self);
  if (self) return;
  // DDS would deliver the stronger service again with its next state, and the weaker one at its next pause.
  if (led && phase_ == ReplicaPhase::in_step && !yielded_ns_ && is_weaker(state.header.sensor, now_ns))
    yielded_ns_ = now_ns;
  other_ns_ = now_ns;
  other_stamp_ns_ = state.header.stamp_ns;
  leader_ = state.header.sensor;
  if (phase_ == ReplicaPhase::listening) fall_behind("it was away");

  const StateMark other = mark_of(state);
  const std::size_t kept = std::min(own_count_, own_marks_.size());
  if (kept == 0 || own_marks_[(own_count_ - 1) % own_marks_.size()].stamp_ns < other.stamp_ns) {
    if (waiting_count_ == waiting_.size()) {
      differs(now_ns, "is ahead");
      waiting_first_ = (waiting_first_ + 1) % waiting_.size();
      --waiting_count_;
    }
    waiting_[(waiting_first_ + waiting_count_++) % waiting_.size()] = other;
    return;
  }
  for (std::size_t back = 1; back <= kept; ++back) {
    const StateMark& mine = own_marks_[(own_count_ - back) % own_marks_.size()];
    if (mine.stamp_ns == other.stamp_ns) return compare(mine, other, now_ns);
    if (mine.stamp_ns < other.stamp_ns) break;
  }
  differs(now_ns, "has a state that this one has not");
}

void Replica::compare(const StateMark& own, const StateMark& other, TimeNs now_ns) {
  const bool tells = has_position(own) || has_position(other) || took_state_;
  if (phase_ == ReplicaPhase::behind && !tells) return;
  if (!alike(own, other)) return differs(now_ns, "has another state");
  unlike_ns_ = 0;
  ++alike_;
  if (phase_ == ReplicaPhase::behind && alike_ >= kAlikeNeeded) come_in_step(now_ns);
  if (alike_ >= kAlikeNeeded) began_alone_ = false;
  // Equal states lack the same, whoever began to count when.
  if (alike_ % kAlikeForLong == 0 || alike_ == kAlikeNeeded)
    missed_ = missed_by(leader_, now_ns).value_or(missed_);
}

void Replica::differs(TimeNs now_ns, const char* how) {
  alike_ = 0;
  if (unlike_ns_ == 0) unlike_ns_ = now_ns;
  // One that has just begun by itself, because it heard nobody, has no ground to insist on what it knows.
  const bool newcomer = began_alone_ && in_step_ns(now_ns) < kNewcomer_ns;
  if (phase_ != ReplicaPhase::in_step || (!newcomer && now_ns - unlike_ns_ < options_.quarrel_ns)) return;
  // Whoever lacks fewer samples is right. It will be asked.
  if (!newcomer && missed_by(leader_, now_ns).value_or(0) > missed_) return;
  fall_behind(leader_.str() + " " + how);
}

void Replica::told(const ReplicaStatus& peer, TimeNs now_ns) {
  if (!peers_.contains(peer.header.sensor) && peers_.size() == kMostPeers) {
    std::erase_if(peers_, [&](const auto& one) { return now_ns - one.second.told_ns > kToldFor_ns; });
    if (peers_.size() == kMostPeers) return;
  }
  peers_[peer.header.sensor] = {peer, now_ns};
  if (phase_ != ReplicaPhase::in_step || peer.phase != ReplicaPhase::in_step) return;
  const auto give_way = [&](const std::string& why) {
    other_ns_ = now_ns;  // the other service has `silence_ns` to be delivered
    leader_ = peer.header.sensor;
    fall_behind(why);
  };
  // The status may be older than the moment at which that service noticed the same gap.
  const bool settled = now_ns - missed_ns_ > kTellsWithin_ns;
  const std::string name = peer.header.sensor.str();
  if (settled && peer.missed < missed_) {
    give_way("it lacks " + std::to_string(missed_ - peer.missed) + " samples that " + name + " has");
  } else if (began_alone_ && in_step_ns(now_ns) < kNewcomer_ns &&
             peer.in_step_s > to_seconds(in_step_ns(now_ns) + kTellsWithin_ns)) {
    give_way("it began alone while " + name + " was under way");
  }
}

void Replica::missed(std::uint64_t count, TimeNs now_ns) {
  if (count == 0) return;
  missed_ += count;
  missed_ns_ = now_ns;
  missed_lately_ = true;
}

void Replica::others(int count, TimeNs now_ns) {
  if (others_ > 0 && count == 0) alone_ns_ = now_ns;
  others_ = count;
}

void Replica::caught_up(std::uint64_t missed) {
  ++caught_up_;
  missed_ = missed;
  took_state_ = true;
  alike_ = 0;
  unlike_ns_ = 0;
  own_count_ = 0;
  waiting_count_ = 0;
}

void Replica::fall_behind(std::string reason) {
  phase_ = ReplicaPhase::behind;
  reason_ = std::move(reason);
  took_state_ = false;
  alike_ = 0;
  unlike_ns_ = 0;
}

void Replica::come_in_step(TimeNs now_ns) {
  phase_ = ReplicaPhase::in_step;
  in_step_since_ns_ = now_ns;
  began_alone_ = false;
  reason_.clear();
}

DurationNs Replica::in_step_ns(TimeNs now_ns) const {
  return phase_ == ReplicaPhase::in_step ? now_ns - in_step_since_ns_ : 0;
}

std::optional<std::uint64_t> Replica::missed_by(const Name& instance, TimeNs now_ns) const {
  const auto found = peers_.find(instance);
  if (found == peers_.end() || now_ns - found->second.told_ns > kToldFor_ns) return std::nullopt;
  return found->second.status.missed;
}

}  // namespace fathom::fusion
