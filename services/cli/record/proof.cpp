#include "cli/record/proof.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <type_traits>
#include <utility>
#include <variant>

#include "cli/command.hpp"

namespace fathom::cli {
namespace {

constexpr DurationNs kKept_ns = 60 * kNsPerSecond;  // that samples wait for the list that names them
constexpr DurationNs kAgain_ns = 5 * kNsPerSecond;  // after a state
constexpr std::size_t kMostUnheard = 4096;          // states that wait for the recorded ones
constexpr std::size_t kMostWaiting = 1U << 20U;

/// Equal to the bit; all NaN are one, since their bits do not travel through arithmetic alike everywhere.
bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

/// Finds the first field of two samples that differs.
class Difference {
 public:
  void field(const char* name, double recorded, double computed) {
    if (!text_.empty() || same(recorded, computed)) return;
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), "%s: recorded %.17g, computed %.17g", name, recorded, computed);
    text_ = text.data();
  }
  template <std::size_t N>
  void field(const char* name, const std::array<double, N>& recorded, const std::array<double, N>& computed) {
    for (std::size_t i = 0; i < N; ++i)
      field((std::string(name) + "[" + std::to_string(i) + "]").c_str(), recorded[i], computed[i]);
  }
  template <class T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void field(const char* name, T recorded, T computed) {
    if (!text_.empty() || recorded == computed) return;
    text_ = std::string(name) + ": recorded " + std::to_string(static_cast<std::int64_t>(recorded)) +
            ", computed " + std::to_string(static_cast<std::int64_t>(computed));
  }
  void field(const char* name, const Name& recorded, const Name& computed) {
    if (!text_.empty() || recorded == computed) return;
    text_ = std::string(name) + ": recorded '" + recorded.str() + "', computed '" + computed.str() + "'";
  }
  void header(const SampleHeader& recorded, const SampleHeader& computed) {
    field("vehicle", recorded.vehicle, computed.vehicle);
    field("sensor", recorded.sensor, computed.sensor);
    field("stamp_ns", recorded.stamp_ns, computed.stamp_ns);
    field("received_ns", recorded.received_ns, computed.received_ns);
    field("sequence_number", recorded.sequence, computed.sequence);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

Proof::Proof(const config::FusionConfig& config, std::span<const std::byte> state)
    : engine_(config::engine_config(config)) {
  if (const std::string why = engine_.restore(state); !why.empty())
    throw Failure(ExitCode::bad_input, "checkpoint: holds no state of this engine: " + why);
  from_ns_ = engine_.nav_state().header.stamp_ns;
}

Proof::Proof(const config::FusionConfig& config) : engine_(config::engine_config(config)) {
  if (config::starts_from_state(config.start.mode)) engine_.start_from(config::initial_state(config));
}

void Proof::add(const AnySample& sample) {
  const SampleHeader& header = header_of(sample);
  newest_ns_ = std::max(newest_ns_, header.received_ns);
  samples_.try_emplace({static_cast<int>(source_of(sample)), header.sensor, header.stamp_ns, header.sequence},
                       sample);
  go_on();
  // Those that nobody took: of other vehicles, refused ones.
  if (samples_.size() % 1024 == 0) {
    std::erase_if(samples_, [&](const auto& entry) {
      return header_of(entry.second).received_ns < newest_ns_ - kKept_ns;
    });
  }
}

void Proof::add(const Command& order) {
  const SampleHeader& header = order.header;
  orders_.try_emplace({-1, header.sensor, header.stamp_ns, header.sequence}, order);
  go_on();
}

void Proof::add(const IntakeRecord& intake) {
  for (std::size_t i = 0; i < intake.entries.size(); ++i)
    entries_.try_emplace(intake.first + i, intake.entries[i]);
  if (entries_.size() > kMostWaiting)
    differ("the list of what fusion took has a gap at entry " + std::to_string(next_));
  go_on();
}

void Proof::add(const NavState& recorded) {
  const auto found = computed_.find(recorded.header.sequence);
  if (found == computed_.end()) {
    if (recorded_.size() < kMostWaiting) recorded_.emplace(recorded.header.sequence, recorded);
    return;
  }
  compare(recorded, found->second);
  computed_.erase(found);
}

Proof::VerdictKey Proof::key_of(const Verdict& verdict) {
  return {static_cast<int>(verdict.source), verdict.header.sensor, verdict.header.stamp_ns,
          verdict.header.sequence, verdict.revision};
}

void Proof::add(const Verdict& recorded) {
  // Of inertial samples that were not given to the engine.
  if (recorded.source == SourceKind::imu && recorded.kind == VerdictKind::source_disabled) return;
  const auto found = verdicts_computed_.find(key_of(recorded));
  if (found == verdicts_computed_.end()) {
    if (verdicts_recorded_.size() < kMostWaiting) verdicts_recorded_[key_of(recorded)].push_back(recorded);
    return;
  }
  compare(recorded, found->second.front());
  found->second.pop_front();
  if (found->second.empty()) verdicts_computed_.erase(found);
}

void Proof::go_on() {
  if (from_ns_) {
    // Whatever came before that inertial sample is in the state. What came after it may be, and then counts
    // as a duplicate.
    const auto at = std::find_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
      return !entry.second.is_order && entry.second.source == SourceKind::imu &&
             entry.second.stamp_ns == *from_ns_;
    });
    if (at == entries_.end()) return;
    begin_ns_ = *from_ns_;
    next_ = at->first + 1;
    first_ = next_;
    entries_.erase(entries_.begin(), std::next(at));
    from_ns_.reset();
  }
  while (difference_.empty() && !entries_.empty() && entries_.begin()->first == next_) {
    if (!give(entries_.begin()->second)) return;
    entries_.erase(entries_.begin());
    ++next_;
    collect();
  }
}

bool Proof::give(const IntakeEntry& entry) {
  if (entry.is_order) {
    const auto found = orders_.find({-1, entry.sensor, entry.stamp_ns, entry.sequence});
    if (found == orders_.end()) return false;
    (void)engine_.apply(found->second);
    return true;
  }
  const auto found =
      samples_.find({static_cast<int>(entry.source), entry.sensor, entry.stamp_ns, entry.sequence});
  if (found == samples_.end()) return false;
  std::visit(
      [&]<class T>(const T& sample) {
        if constexpr (std::is_same_v<T, ImuSample>) {
          imu_writer_ = entry.writer;
          if (!engine_.add(sample)) return;
          const NavState& state = engine_.nav_state();
          const auto recorded = recorded_.find(state.header.sequence);
          if (recorded == recorded_.end()) {
            computed_.emplace(state.header.sequence, state);
            if (computed_.size() > kMostUnheard) {
              computed_.erase(computed_.begin());
              ++unheard_;
            }
          } else {
            compare(recorded->second, state);
            recorded_.erase(recorded);
          }
        } else {
          engine_.add(sample, entry.writer);
        }
      },
      found->second);
  return true;
}

void Proof::collect() {
  for (Verdict verdict; engine_.next_verdict(verdict);) {
    if (verdict.source == SourceKind::imu) verdict.writer = imu_writer_;
    // In the state that was begun with, and given again.
    if (verdict.kind == VerdictKind::duplicate && begin_ns_ > 0 &&
        verdict.header.stamp_ns < begin_ns_ + kAgain_ns)
      continue;
    const auto found = verdicts_recorded_.find(key_of(verdict));
    if (found == verdicts_recorded_.end()) {
      verdicts_computed_[key_of(verdict)].push_back(verdict);
      continue;
    }
    compare(found->second.front(), verdict);
    found->second.pop_front();
    if (found->second.empty()) verdicts_recorded_.erase(found);
  }
  for (estimation::OrderOutcome outcome; engine_.next_outcome(outcome);) continue;
}

void Proof::differ(const std::string& what) {
  if (difference_.empty()) difference_ = what;
}

void Proof::compare(const NavState& recorded, const NavState& computed) {
  // A field that is added to the sample does not compile here until it is compared.
  const auto& [header, mode, alignment, latitude_rad, longitude_rad, altitude_m, depth_m,
               altitude_above_bottom_m, velocity_N_m_s, q_NB, rpy_rad, angular_rate_B_rad_s,
               specific_force_B_m_s2, position_covariance_N_m2, velocity_covariance_N_m2_s2, rpy_sigma_rad,
               gps_outage_s, dvl_outage_s, reset_counter, last_reset_delta_N_m] = recorded;
  Difference d;
  last_state_ = std::max(last_state_, header.sequence);
  d.header(header, computed.header);
  d.field("mode", mode, computed.mode);
  d.field("alignment", alignment, computed.alignment);
  d.field("latitude_rad", latitude_rad, computed.latitude_rad);
  d.field("longitude_rad", longitude_rad, computed.longitude_rad);
  d.field("altitude_m", altitude_m, computed.altitude_m);
  d.field("depth_m", depth_m, computed.depth_m);
  d.field("altitude_above_bottom_m", altitude_above_bottom_m, computed.altitude_above_bottom_m);
  d.field("velocity_N_m_s", velocity_N_m_s, computed.velocity_N_m_s);
  d.field("q_NB", q_NB, computed.q_NB);
  d.field("rpy_rad", rpy_rad, computed.rpy_rad);
  d.field("angular_rate_B_rad_s", angular_rate_B_rad_s, computed.angular_rate_B_rad_s);
  d.field("specific_force_B_m_s2", specific_force_B_m_s2, computed.specific_force_B_m_s2);
  d.field("position_covariance_N_m2", position_covariance_N_m2, computed.position_covariance_N_m2);
  d.field("velocity_covariance_N_m2_s2", velocity_covariance_N_m2_s2, computed.velocity_covariance_N_m2_s2);
  d.field("rpy_sigma_rad", rpy_sigma_rad, computed.rpy_sigma_rad);
  d.field("gps_outage_s", gps_outage_s, computed.gps_outage_s);
  d.field("dvl_outage_s", dvl_outage_s, computed.dvl_outage_s);
  d.field("reset_counter", reset_counter, computed.reset_counter);
  d.field("last_reset_delta_N_m", last_reset_delta_N_m, computed.last_reset_delta_N_m);
  if (d.text().empty()) {
    ++states_;
  } else {
    differ("navigation state " + std::to_string(recorded.header.sequence) + " at " +
           to_iso8601(recorded.header.stamp_ns, 6) + ": " + d.text());
  }
}

void Proof::compare(const Verdict& recorded, const Verdict& computed) {
  // A field that is added to the sample does not compile here until it is compared.
  const auto& [header, source, model, writer, kind, dimensions, innovation, innovation_sigma, test_ratio,
               limit, revision, previous, is_final] = recorded;
  Difference d;
  d.header(header, computed.header);
  d.field("source", source, computed.source);
  d.field("model", model, computed.model);
  d.field("writer", writer, computed.writer);
  d.field("kind", kind, computed.kind);
  d.field("dimensions", dimensions, computed.dimensions);
  d.field("innovation", innovation, computed.innovation);
  d.field("innovation_sigma", innovation_sigma, computed.innovation_sigma);
  d.field("test_ratio", test_ratio, computed.test_ratio);
  d.field("limit", limit, computed.limit);
  d.field("revision", revision, computed.revision);
  d.field("previous", previous, computed.previous);
  d.field("is_final", is_final, computed.is_final);
  if (d.text().empty()) {
    ++verdicts_;
  } else {
    differ("verdict on " + recorded.header.sensor.str() + " " + std::to_string(recorded.header.sequence) +
           " at " + to_iso8601(recorded.header.stamp_ns, 6) + ": " + d.text());
  }
}

void Proof::finish() {
  go_on();
  if (!difference_.empty()) return;
  if (from_ns_) return differ("the checkpoint is of a moment that is not in the recording");
  if (!entries_.empty()) {
    const auto& [number, entry] = *entries_.begin();
    if (number != next_)
      return differ("the list of what fusion took has a gap at entry " + std::to_string(next_));
    const std::string what =
        entry.is_order ? "an order of " : std::string(to_string(entry.source)) + " sample ";
    return differ(what + entry.sensor.str() + " " + std::to_string(entry.sequence) + " at " +
                  to_iso8601(entry.stamp_ns, 6) + ", which fusion took, is not in the recording");
  }
  // What the engine said last may have been said after the recording's end, and the other way round what was
  // recorded last may follow from what the list names no more.
  unheard_ +=
      static_cast<std::uint64_t>(std::distance(computed_.begin(), computed_.lower_bound(last_state_)));
  const TimeNs end_ns = engine_.nav_state().header.stamp_ns;
  for (const auto& [sequence, state] : recorded_) {
    if (state.header.stamp_ns <= end_ns && state.header.stamp_ns > begin_ns_)
      return differ("navigation state " + std::to_string(sequence) + " at " +
                    to_iso8601(state.header.stamp_ns, 6) + " follows from nothing that fusion took");
  }
}

}  // namespace fathom::cli
