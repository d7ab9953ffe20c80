#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "samples/alignment/help.hpp"
#include "samples/alignment_status.hpp"
#include "samples/command.hpp"
#include "samples/kinds.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/status/intake.hpp"
#include "samples/verdict.hpp"

/// What a vehicle said, in rows that say just what explaining needs. Times are the vehicle's, ns since 1970.
namespace fathom::explain {

/// Who published something, and when it arrived where it was recorded.
struct Arrival {
  TimeNs log_ns = 0;
  std::string writer;   ///< name of its participant; empty: not told
  std::string process;  ///< what tells its process from others; empty: not told
};

/// What one writer gave of a stream in one second of arrival.
struct Second {
  TimeNs at_ns = 0;  ///< begin of the second, by arrival
  std::uint32_t writer = 0;
  std::uint32_t count = 0;
  double age_low_s = 0.0;  ///< of received minus stamp
  double age_high_s = 0.0;
  double age_sum_s = 0.0;
  double bus_low_s = 0.0;         ///< of arrival minus received
  double stamp_step_s = 0.0;      ///< largest, to the sample before, whoever wrote that
  TimeNs stamp_before_ns = 0;     ///< the stamp that it steps from
  double stamp_step_low_s = 0.0;  ///< least; negative: stamps went back
  double arrival_step_s = 0.0;    ///< largest
  double arrival_after_s = 0.0;   ///< step of the arrival where the stamps stepped most
  [[nodiscard]] double age_s() const { return age_sum_s / count; }
};

/// A time in which nothing of an instrument arrived.
struct Pause {
  /// Shorter ones are no rows; the monitor misses nothing sooner.
  static constexpr DurationNs kLeast_ns = kNsPerSecond;

  TimeNs from_ns = 0;        ///< arrival of the sample before
  TimeNs to_ns = 0;          ///< arrival of the sample after
  DurationNs stamps_ns = 0;  ///< by how much the stamps stepped
};

/// One instrument of the vehicle.
struct Stream {
  SourceKind kind = SourceKind::imu;
  Name sensor;
  std::uint64_t samples = 0;
  std::deque<Second> seconds;  ///< by arrival; of several writers one behind the other
  std::deque<Pause> pauses;    ///< by arrival, of all writers together

  // of the sample before
  TimeNs last_stamp_ns = 0;
  TimeNs last_received_ns = 0;
  TimeNs last_log_ns = 0;
};

struct StateRow {
  TimeNs at_ns = 0;   ///< stamp
  TimeNs log_ns = 0;  ///< arrival
  NavMode mode = NavMode::none;
  AlignmentPhase alignment = AlignmentPhase::none;
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double depth_m = kUnknown;
  std::array<double, 3> velocity_N_m_s{kUnknown, kUnknown, kUnknown};
  double yaw_rad = kUnknown;
  double sigma_m = kUnknown;  ///< horizontal: root of the trace
  double yaw_sigma_rad = kUnknown;
  std::uint32_t resets = 0;
  double reset_m = 0.0;  ///< length of the last step
  std::uint32_t instance = 0;
  std::uint32_t writer = 0;
};

struct VerdictRow {
  TimeNs stamp_ns = 0;
  TimeNs log_ns = 0;
  std::uint32_t stream = 0;
  std::uint32_t model = 0;
  VerdictKind kind = VerdictKind::used;
  std::uint8_t dimensions = 0;
  std::array<double, 6> innovation{};  ///< predicted minus measured
  std::array<double, 6> sigma{};
  double test_ratio = kUnknown;
  double limit = kUnknown;
};

struct FixRow {
  TimeNs stamp_ns = 0;
  std::uint32_t stream = 0;
  GpsFix fix = GpsFix::none;
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double sigma_m = kUnknown;  ///< of one horizontal component, as the receiver says
  std::array<double, 2> velocity_N_m_s{kUnknown, kUnknown};
  GpsJamming jamming = GpsJamming::unknown;
  GpsSpoofing spoofing = GpsSpoofing::unknown;
};

/// What a DVL measured, in its own axes.
struct DvlRow {
  TimeNs stamp_ns = 0;
  std::uint32_t stream = 0;
  std::array<double, 2> velocity_D_m_s{kUnknown, kUnknown};  ///< forward, right
};

/// The life sign of a service, where it says something new or comes after a silence.
struct LifeSign {
  /// They come once a second; the monitor misses them after as much.
  static constexpr DurationNs kSilence_ns = 3 * kNsPerSecond;

  TimeNs log_ns = 0;
  std::uint32_t service = 0;
  std::string host;
  std::uint32_t pid = 0;
  TimeNs started_ns = 0;
  DurationNs utc_offset_ns = 0;
  ServiceState state = ServiceState::starting;
  std::string text;
  TimeNs before_ns = 0;  ///< when the one before it came
};

struct AlarmRow {
  TimeNs log_ns = 0;
  Alarm alarm;
};

struct AlignmentRow {
  TimeNs log_ns = 0;
  AlignmentPhase phase = AlignmentPhase::none;
  std::vector<AlignmentCondition> unmet;
  double start_error_rad = 0.0;  ///< of the heading of the start, found and corrected; 0: none
  std::string advice;
};

/// While a sensor scattered more than is said of it.
struct NoiseRow {
  std::string sensor;  ///< as far as its name had room
  TimeNs begin_ns = 0;
  TimeNs log_ns = 0;  ///< the last time that it was said
  double most = 1.0;  ///< the largest factor of its sigma
};

/// A bias of the inertial unit that is larger than is said of it.
struct BiasRow {
  FoundBias last;
  TimeNs begin_ns = 0;
  TimeNs log_ns = 0;  ///< the last time that it was said
};

struct OrderRow {
  TimeNs log_ns = 0;
  Command order;
};

/// The begin of a run of a fusion service, by what it says that it took; again where it goes on from a state
/// that it had not made itself.
struct RunRow {
  TimeNs log_ns = 0;
  std::uint32_t instance = 0;
  std::uint32_t writer = 0;
  bool resumed = false;
  std::uint64_t first = 0;
};

/// Grows by what comes, in the order of arrival. What is older than the span goes, and the oldest goes first
/// where a list is full, so that memory is bounded; from_ns() says since when everything is there.
class History {
 public:
  struct Limits {
    DurationNs span_ns = std::numeric_limits<DurationNs>::max();
    std::size_t rows = 2'000'000;  ///< of one list
  };

  History() : History(Limits{}) {}
  explicit History(const Limits& limits, Name vehicle = {}) : limits_(limits), vehicle_(vehicle) {}

  template <OfAKind Sample>
  void add(const Sample& sample, const Arrival& arrival) {
    if (!begin(sample.header, arrival)) return;
    heard(kSourceOf<Sample>, sample.header, arrival);
    if constexpr (std::is_same_v<Sample, GpsSample>) fix(sample);
    if constexpr (std::is_same_v<Sample, DvlSample>) dvl(sample);
  }
  void add(const NavState& state, const Arrival& arrival);
  void add(const Verdict& verdict, const Arrival& arrival);
  void add(const AlignmentStatus& status, const Arrival& arrival);
  void add(const ServiceStatus& status, const Arrival& arrival);
  void add(const Alarm& alarm, const Arrival& arrival);
  void add(const Command& order, const Arrival& arrival);
  void add(const IntakeRecord& intake, const Arrival& arrival);

  [[nodiscard]] const std::deque<Stream>& streams() const { return streams_; }
  [[nodiscard]] const std::deque<StateRow>& states() const { return states_; }
  [[nodiscard]] const std::deque<VerdictRow>& verdicts() const { return verdicts_; }
  [[nodiscard]] const std::deque<FixRow>& fixes() const { return fixes_; }
  [[nodiscard]] const std::deque<DvlRow>& dvl() const { return dvl_; }
  [[nodiscard]] const std::deque<LifeSign>& life_signs() const { return life_; }
  /// When each service last gave a life sign, by the number of its name.
  [[nodiscard]] const std::map<std::uint32_t, TimeNs>& last_life_ns() const { return life_last_ns_; }
  [[nodiscard]] const std::deque<AlarmRow>& alarms() const { return alarms_; }
  [[nodiscard]] const std::deque<AlignmentRow>& alignment() const { return alignment_; }
  [[nodiscard]] const std::deque<NoiseRow>& noise() const { return noise_; }
  [[nodiscard]] const std::deque<BiasRow>& biases() const { return biases_; }
  [[nodiscard]] const std::deque<OrderRow>& orders() const { return orders_; }
  [[nodiscard]] const std::deque<RunRow>& runs() const { return runs_; }

  /// A name by its number: of models, services, instances.
  [[nodiscard]] const std::string& name(std::uint32_t number) const { return names_.at(number); }
  /// A writer, "name (process)"; its process.
  [[nodiscard]] const std::string& writer(std::uint32_t number) const { return writers_.at(number).first; }

  [[nodiscard]] const Name& vehicle() const { return vehicle_; }
  [[nodiscard]] bool empty() const { return to_ns_ == 0; }
  [[nodiscard]] TimeNs from_ns() const { return from_ns_; }  ///< by arrival
  [[nodiscard]] TimeNs to_ns() const { return to_ns_; }
  [[nodiscard]] std::uint64_t forgotten() const { return forgotten_; }  ///< rows, for want of room

 private:
  using Measurement = std::tuple<std::uint32_t, TimeNs, std::uint64_t>;
  static constexpr std::size_t kMostNames = 4096;  // names come from the network: bounded
  static constexpr std::size_t kMostStreams = 128;

  /// False: of another vehicle, or of no sound time.
  bool begin(const SampleHeader& header, const Arrival& arrival);
  void heard(SourceKind kind, const SampleHeader& header, const Arrival& arrival);
  void fix(const GpsSample& sample);
  void dvl(const DvlSample& sample);
  void noisy(const NoiseFactor& found, TimeNs log_ns);
  void biased(const FoundBias& found, TimeNs log_ns);
  std::optional<std::uint32_t> stream_of(SourceKind kind, const Name& sensor);
  std::uint32_t number_of(const std::string& name);
  std::uint32_t writer_of(const Arrival& arrival);
  void forget();
  template <class Row, class At>
  void cut(std::deque<Row>& rows, At at);

  Limits limits_;
  Name vehicle_;
  TimeNs from_ns_ = 0;
  TimeNs to_ns_ = 0;
  TimeNs cut_ns_ = 0;
  std::uint64_t forgotten_ = 0;
  std::deque<Stream> streams_;
  std::deque<StateRow> states_;
  std::deque<VerdictRow> verdicts_;
  std::uint64_t verdicts_gone_ = 0;
  std::map<Measurement, std::uint64_t>
      open_;  // rows whose verdict may change, by their number since the begin
  std::deque<FixRow> fixes_;
  std::deque<DvlRow> dvl_;
  std::deque<LifeSign> life_;
  std::map<std::uint32_t, TimeNs> life_last_ns_;
  std::deque<AlarmRow> alarms_;
  std::deque<AlignmentRow> alignment_;
  std::deque<NoiseRow> noise_;
  std::deque<BiasRow> biases_;
  std::deque<OrderRow> orders_;
  std::deque<RunRow> runs_;
  std::deque<std::string> names_;
  std::map<std::string, std::uint32_t> numbers_;
  std::deque<std::pair<std::string, std::string>> writers_;
  std::map<std::pair<std::string, std::string>, std::uint32_t> writer_numbers_;
};

}  // namespace fathom::explain
