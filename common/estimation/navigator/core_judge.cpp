#include <algorithm>
#include <cmath>

#include "estimation/aiding/flow_angles.hpp"
#include "estimation/aiding/model_velocity.hpp"
#include "estimation/aiding/usbl_range_bearing.hpp"
#include "estimation/filter/sigma_range.hpp"
#include "estimation/navigator/core.hpp"
#include "samples/departure.hpp"
#include "samples/gps_quality.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

constexpr double kMostRoom = 1e6;
/// Beyond it a velocity along the vehicle must not be taken for a heading.
constexpr double kDoubtfulHeading_rad = 0.1;

VerdictKind verdict_of(Usable usable) {
  switch (usable) {
    case Usable::yes:
      return VerdictKind::used;
    case Usable::out_of_range:
      return VerdictKind::out_of_range;
    case Usable::no_fix:
      return VerdictKind::no_fix;
    case Usable::unknown_frame:
      return VerdictKind::unknown_frame;
    case Usable::not_estimated:
    case Usable::other_model:
      break;
  }
  return VerdictKind::source_disabled;
}

/// What a frozen instrument would keep repeating; NaN where the sample has nothing to say.
std::array<double, 3> reading_of(const EventSample& any) {
  if (const auto* gps = std::get_if<GpsSample>(&any))
    return {gps->latitude_rad, gps->longitude_rad, gps->altitude_m};
  if (const auto* dvl = std::get_if<DvlSample>(&any)) {
    const auto& v = dvl->velocity_D_m_s;
    const auto& beams = dvl->beam_velocity_m_s;
    const bool vector = known(v[0]) || known(v[1]) || known(v[2]);
    return vector ? v : std::array<double, 3>{beams[0], beams[1], known(beams[2]) ? beams[2] : beams[3]};
  }
  if (const auto* depth = std::get_if<DepthSample>(&any)) return {depth->depth_m, 0.0, 0.0};
  if (const auto* heading = std::get_if<HeadingSample>(&any)) return {heading->heading_rad, 0.0, 0.0};
  if (const auto* usbl = std::get_if<UsblSample>(&any)) {
    if (usbl->frame == UsblFrame::geodetic) return {usbl->latitude_rad, usbl->longitude_rad, usbl->depth_m};
    if (UsblRangeBearing::present(*usbl)) return {usbl->range_m, usbl->bearing_rad, usbl->depression_rad};
    return usbl->relative_m;
  }
  if (const auto* air = std::get_if<AirspeedSample>(&any))
    return {air->airspeed_m_s, air->true_airspeed_m_s, 0.0};
  return {kUnknown, kUnknown, kUnknown};
}

bool same(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  bool any = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) != std::isnan(b[i])) return false;
    if (!std::isnan(a[i]) && a[i] != b[i]) return false;
    any = any || !std::isnan(a[i]);
  }
  return any;
}

bool measures_position(SourceKind source) {
  return source == SourceKind::gps || source == SourceKind::usbl;
}

/// An airspeed has no direction; flow angles beside it have.
bool is_speed_alone(SourceKind source, const SensorConfig& config) {
  return source == SourceKind::airspeed && !FlowAngles::wanted(config);
}

}  // namespace

Judgement Core::apply(const Measurement& measurement) {
  return measurement.command ? order(std::get<Command>(measurement.sample)) : judge(measurement);
}

Core::Sensor& Core::instrument_of(const Measurement& measurement) {
  const auto slot = static_cast<std::size_t>(measurement.sensor);
  const int layer = setup_->water_layer[slot];
  return is_of_water(measurement.sample) && layer >= 0 ? water_layers_[static_cast<std::size_t>(layer)]
                                                       : sensors_[slot];
}

Judgement Core::judge(const Measurement& measurement) {
  Judgement out;
  const auto slot = static_cast<std::size_t>(measurement.sensor);
  const SensorConfig& config = setup_->config.sensors[slot];
  Sensor& sensor = instrument_of(measurement);
  if (!sensors_[slot].enabled) {
    out.kind = VerdictKind::source_disabled;
    return out;
  }
  if (sensor.stamp_ns == measurement.stamp_ns && sensor.stamp_ns != 0) {
    out.kind = VerdictKind::duplicate;
    return out;
  }
  sensor.stamp_ns = measurement.stamp_ns;
  if (config.use_sample_sigma && !sound_sigmas(measurement.sample)) {
    out.kind = VerdictKind::out_of_range;
    return out;
  }
  notice(measurement);
  const bool drives = drive_model(measurement);
  if (!navigating_) return out;
  if (dropping_) return feed_drop(measurement).value_or(out);

  const AidingState state = aiding_state();
  const bool foretold = drives && measurement.source == SourceKind::propulsion;
  const ModelTrial model =
      foretold ? consider_model(state, std::get<PropulsionSample>(measurement.sample)) : ModelTrial{};
  // A model that proves wrong leaves the shaft speed to the speed log, where one is configured.
  const bool wrong = model.usable && !(model.believed && model.fits);
  const bool modelled = foretold && !(wrong && config.scale_m_s_per_rpm != 0.0);
  const AidingInput input{.state = state,
                          .sensor = config,
                          .surface_altitude_m = setup_->config.states.surface_altitude_m,
                          .vehicle_model = &setup_->config.vehicle_model,
                          .water = modelled ? &water_ : nullptr,
                          .unused_s = since(sensor.used_ns)};
  Observation observation;
  bool with_position = false;
  Usable first_refusal = Usable::yes;
  for (const AidingEntry& entry : aiding_registry()) {
    if (entry.source != measurement.source) continue;
    const Usable usable = entry.observe(input, measurement.sample, observation);
    if (usable == Usable::yes) {
      with_position = with_position || measures_position(entry.source);
      if (out.model.empty()) out.model = entry.name;
    } else if (first_refusal == Usable::yes && usable != Usable::other_model) {
      first_refusal = usable;
    }
  }
  if (modelled) water_.measured();
  if (drives && measurement.source == SourceKind::fins) {
    // They serve the model alone: its doubt is theirs.
    out.model = ModelVelocity::kName;
    const bool believed = water_.doubt() <= setup_->config.vehicle_model.doubt_limit;
    out.kind = believed ? VerdictKind::used : VerdictKind::rejected;
    return out;
  }
  if (observation.rows == 0) {
    out.kind = first_refusal == Usable::yes ? VerdictKind::source_disabled : verdict_of(first_refusal);
    return out;
  }
  with_position = with_position && measures(observation, 0, 0);
  observation.list_columns(setup_->index.size());

  const Observation whole = observation;
  bool stepped = false;
  InnovationStatistics statistics;
  const SensorConfig& rules = modelled ? setup_->model_gate : config;
  const GateLimits& limits = modelled ? setup_->model_limits : setup_->limits[slot];
  GateResult result = gate(filter_, rules, limits, observation, statistics);
  const bool fix = measurement.source == SourceKind::gps && with_position;
  const bool probation = fix && on_probation(config, whole);
  if (frozen(measurement, rules, sensor, whole)) {
    out.kind = VerdictKind::frozen;
  } else {
    const unsigned refused = probation ? (1U << whole.rows) - 1U : result.refused;
    const unsigned believed = believed_rows(sensor, rules, whole, refused, fix);
    if (probation && believed == 0) {
      result.pass = false;
      result.limit = config.reacquire_step_m;
      result.test_ratio = std::hypot(whole.innovation[0], whole.innovation[1]) / result.limit;
    }
    for (double room = 1.0; (believed & result.refused) != 0 && room < kMostRoom; room *= 4.0) {
      // (GATE-3): the estimate, not the instrument, is wrong; give the estimate the room to follow.
      std::array<double, kNavStates> variance{};
      make_room(measurement.source, sensor, whole, believed, room, variance);
      filter_.widen_drifted(variance);
      observation = whole;
      result = gate(filter_, rules, limits, observation, statistics);
    }
    out.kind = result.pass                       ? VerdictKind::used
               : fix && disputed(sensor, config) ? VerdictKind::disputed
                                                 : VerdictKind::rejected;
    stepped = result.pass && believed != 0 && with_position;
    if (result.pass && fix) stepped = bound_step(config, observation, statistics) || stepped;
  }
  out.dimensions = static_cast<std::uint32_t>(whole.rows);
  if (modelled && !model.believed) out.kind = VerdictKind::rejected;
  for (std::size_t i = 0; i < static_cast<std::size_t>(whole.rows); ++i) {
    out.innovation[i] = whole.innovation[i];
    out.innovation_sigma[i] = result.innovation_sigma[i];
  }
  out.test_ratio = result.test_ratio;
  out.limit = result.limit;
  if (out.kind != VerdictKind::used) return out;

  std::array<double, kMaxStates> x{};
  if (!filter_.update(observation, statistics, x)) {
    out.kind = VerdictKind::rejected;
    return out;
  }
  const Vector3d before = velocity_of_log(measurement);
  remove_error(x, setup_->index.size(), state_);
  // (KF-5)
  const bool along_body =
      !measures_position(measurement.source) && !is_speed_alone(measurement.source, config);
  if (along_body && filter_(8, 8) > kDoubtfulHeading_rad * kDoubtfulHeading_rad)
    filter_.turn_with_attitude(velocity_of_log(measurement) - before);
  if (stepped) {
    note_step(-Vector3d(x[0], x[1], x[2]), &whole);
  }
  sensor.used_ns = now_ns_;
  sensor.candidate = {};
  mark_used(measurement, with_position);
  return out;
}

bool Core::frozen(const Measurement& measurement, const SensorConfig& config, Sensor& sensor,
                  const Observation& observation) const {
  if (config.frozen_change <= 0.0) return false;
  const auto reading = reading_of(measurement.sample);
  Vector3d prediction = Vector3d::Zero();
  if (measures_position(measurement.source)) {
    // The path counts: the estimate itself may already have been pulled to the frozen fix.
    prediction = travelled_N_m_;
  } else {
    for (int i = 0; i < std::min(3, observation.rows); ++i)
      prediction(i) = observation.innovation[static_cast<std::size_t>(i)];
  }
  if (!same(reading, sensor.reading)) {
    sensor.reading = reading;
    sensor.first_prediction = prediction;
    return false;
  }
  return (prediction - sensor.first_prediction).norm() > config.frozen_change;
}

Vector3d Core::velocity_of_log(const Measurement& measurement) const {
  const bool ground = measurement.source == SourceKind::dvl
                          ? !is_of_water(measurement.sample)
                          : since(bottom_used_ns_) <= setup_->config.velocity_timeout_s;
  if (ground) return state_.nav.v_N_m_s;
  const AidingState state = aiding_state();
  return state_.nav.v_N_m_s - Vector3d(state.value(Group::current, 0), state.value(Group::current, 1), 0.0);
}

void Core::mark_used(const Measurement& measurement, bool with_position) {
  switch (measurement.source) {
    case SourceKind::gps:
      // A fix of kilometres has its weight in the filter, but nobody navigates by it.
      if (with_position && is_accurate(std::get<GpsSample>(measurement.sample))) gps_used_ns_ = now_ns_;
      velocity_used_ns_ = now_ns_;
      break;
    case SourceKind::usbl:
      usbl_used_ns_ = now_ns_;
      break;
    case SourceKind::dvl:
      dvl_used_ns_ = now_ns_;
      if (!is_of_water(measurement.sample)) bottom_used_ns_ = now_ns_;
      velocity_used_ns_ = now_ns_;
      break;
    case SourceKind::airspeed:
    case SourceKind::propulsion:
      velocity_used_ns_ = now_ns_;
      break;
    default:
      break;
  }
}

Judgement Core::order(const Command& command) {
  const auto& sensors = setup_->config.sensors;
  Judgement done;
  done.kind = VerdictKind::used;
  switch (command.kind) {
    case CommandKind::enable_source:
    case CommandKind::disable_source:
      for (std::size_t i = 0; i < sensors.size(); ++i)
        if (command.target == Name(sensors[i].sensor))
          sensors_[i].enabled = command.kind == CommandKind::enable_source;
      break;
    case CommandKind::mark_at_rest:
      rest_until_ns_ = now_ns_ + from_seconds(command.value_s);
      next_zero_velocity_ns_ = now_ns_;
      break;
    case CommandKind::realign:
      if (released_ && navigating_) {
        // Under way there is nothing to stand still for: tilt is found again, the rest carried on.
        restart_drop(setup_->config.air_drop.tilt_sigma_rad, 0.0);
        break;
      }
      lose_attitude();
      enter(AlignmentPhase::waiting);
      break;
    case CommandKind::set_position:
      return place(command);
    case CommandKind::acknowledge_alarm:
      break;
  }
  return done;
}

Judgement Core::place(const Command& command) {
  Judgement out;
  out.kind = VerdictKind::used;
  geo::Geodetic wanted = state_.nav.position;
  wanted.latitude_rad = command.latitude_rad;
  wanted.longitude_rad = command.longitude_rad;
  const AidingState state = aiding_state();
  const double surface = state.value(Group::surface_altitude, 0, setup_->config.states.surface_altitude_m);
  if (known(command.depth_m)) wanted.altitude_m = surface - command.depth_m;
  if (!navigating_) {
    position_set_ = true;
    set_position_ = wanted;
    set_sigma_m_ = command.sigma_m;
    return out;
  }
  wanted = geo::moved_by(wanted, -(state.C_NB * geo::vec(setup_->config.output_lever_B_m)));
  if (!known(command.depth_m)) wanted.altitude_m = state_.nav.position.altitude_m;
  const Eigen::Vector3d step_N_m = geo::difference_N(state_.nav.position, wanted);
  out.dimensions = 2;
  out.limit = allowed_departure_m(filter_(0, 0), filter_(1, 1), command.sigma_m);
  for (int i = 0; i < 2; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    out.innovation[axis] = step_N_m[i];
    out.innovation_sigma[axis] = std::sqrt(filter_(i, i) + command.sigma_m * command.sigma_m);
  }
  out.test_ratio = step_N_m.head<2>().norm() / out.limit;
  const geo::Geodetic ordered{command.latitude_rad, command.longitude_rad, 0.0};
  if (out.test_ratio > 1.0 && !is_confirmed(command, ordered)) {
    held_ns_ = now_ns_;
    held_position_ = ordered;
    out.kind = VerdictKind::rejected;
    return out;
  }
  held_ns_ = 0;
  note_step(step_N_m, nullptr);
  state_.nav.position = wanted;
  const int axes = known(command.depth_m) ? 3 : 2;
  for (int i = 0; i < axes; ++i) filter_.forget(i, command.sigma_m);
  if (dropping_) place_drop(axes, command.sigma_m);
  return out;
}

bool Core::is_confirmed(const Command& command, const geo::Geodetic& ordered) const {
  constexpr double kTimeToConfirm_s = 60.0;
  constexpr double kSamePlace_m = 1.0;  // written with fewer digits
  return command.confirmed && held_ns_ != 0 && since(held_ns_) <= kTimeToConfirm_s &&
         geo::difference_N(held_position_, ordered).head<2>().norm() <= kSamePlace_m;
}

}  // namespace fathom::estimation
