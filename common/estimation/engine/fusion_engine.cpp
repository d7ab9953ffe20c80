#include "estimation/engine/fusion_engine.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include "archive/layout.hpp"
#include "archive/reader.hpp"
#include "archive/writer.hpp"
#include "estimation/engine/bottom.hpp"
#include "estimation/engine/forecaster.hpp"
#include "estimation/engine/history.hpp"
#include "estimation/engine/imu_preprocessor.hpp"
#include "estimation/engine/newest_kept.hpp"
#include "estimation/engine/order.hpp"
#include "estimation/engine/output.hpp"
#include "estimation/fields/imu_preprocessor.hpp"
#include "estimation/fields/navigator.hpp"
#include "estimation/fields/state_head.hpp"

namespace fathom::estimation {
namespace {

/// Besides two of each measurement held: all of them may be judged otherwise at once, and be final.
constexpr std::size_t kVerdictsKept = 1024;
constexpr std::size_t kOutcomesKept = 64;

EngineConfig checked(const EngineConfig& config) {
  const std::string complaint = config.validate();
  if (!complaint.empty()) throw std::invalid_argument(complaint);
  return config;
}

VerdictKind refusal_of(History::Placing placing) {
  switch (placing) {
    case History::Placing::duplicate:
      return VerdictKind::duplicate;
    case History::Placing::from_the_future:
      return VerdictKind::from_the_future;
    case History::Placing::not_started:
      return VerdictKind::not_aligned;
    case History::Placing::taken:
    case History::Placing::late:
      break;
  }
  return VerdictKind::late;
}

}  // namespace

class FusionEngine::Impl final : public VerdictSink {
 public:
  explicit Impl(const EngineConfig& config)
      : setup_(checked(config)),
        preprocessor_(setup_),
        history_(setup_),
        forecaster_(setup_),
        bottom_(setup_.config.altimeter),
        verdicts_(kVerdictsKept + 2 * setup_.config.measurement_capacity) {
    nav_.header.vehicle = std::string_view(setup_.config.vehicle);
    nav_.header.sensor = std::string_view(setup_.config.sensor);
    for (const SensorConfig& one : setup_.config.sensors) names_.emplace_back(one.sensor);
  }

  bool add(const ImuSample& sample) {
    const ImuPreprocessor::Result result = preprocessor_.take(sample);
    switch (result.outcome) {
      case ImuPreprocessor::Outcome::refused:
        return refuse(sample, result.refusal);
      case ImuPreprocessor::Outcome::first:
        history_.begin(sample.header.stamp_ns, *this);
        break;
      case ImuPreprocessor::Outcome::rebased:
        history_.rebase(sample.header.stamp_ns, result.unobserved_s, *this);
        break;
      case ImuPreprocessor::Outcome::step:
        history_.advance(result.step, *this);
        break;
    }
    if (pending_start_ && sample.header.stamp_ns >= pending_start_->stamp_ns) {
      history_.begin_given(*pending_start_, sample.header.stamp_ns, *this);
      pending_start_.reset();
    }
    forecaster_.watch(history_.navigator());
    bottom_.latch(sample.header.stamp_ns);
    nav_.header.stamp_ns = sample.header.stamp_ns;
    nav_.header.received_ns = sample.header.received_ns;
    ++nav_.header.sequence;
    filled_ = false;
    return true;
  }

  void add(const EventSample& sample, SourceKind source, const Name& writer) {
    Judgement judgement;
    const SampleHeader& header = header_of(sample);
    const int sensor = find(header.sensor, source);
    const bool unused = sensor < 0 || setup_.unused[static_cast<std::size_t>(sensor)];
    if (unused || !sound_stamp(header.stamp_ns)) {
      judgement.kind = unused ? VerdictKind::source_disabled : VerdictKind::out_of_range;
      refuse(header, source, writer, judgement);
      return;
    }
    Measurement& one = incoming_;
    one.stamp_ns = acting_of(setup_, header, sensor);
    one.command = false;
    one.judged = one.settled = false;
    one.revision = 0;
    one.writer = writer;
    one.source = source;
    one.sensor = sensor;
    one.sequence = header.sequence;
    one.sample = sample;
    const History::Placing placing = history_.insert(one, *this);
    if (placing == History::Placing::taken) return;
    judgement.kind = refusal_of(placing);
    refuse(header, source, writer, judgement);
  }

  void inform(const AnySample& sample, const Name& writer) {
    const auto* altimeter = std::get_if<AltimeterSample>(&sample);
    if (altimeter == nullptr) return;
    const std::optional<VerdictKind> refusal = bottom_.take(*altimeter);
    if (!refusal) return;
    Judgement judgement;
    judgement.kind = *refusal;
    refuse(altimeter->header, source_of(sample), writer, judgement);
  }

  [[nodiscard]] std::string objection(const Command& command) const {
    return objection_to(command, setup_.config);
  }

  std::string apply(const Command& command) {
    if (std::string why = objection(command); !why.empty()) return why;
    Measurement& one = incoming_;
    one.command = true;
    one.judged = one.settled = false;
    one.revision = 0;
    one.writer = {};
    one.source = SourceKind::imu;
    one.sensor = -1;
    one.sequence = order_number(command);
    one.stamp_ns = command.header.stamp_ns;
    one.sample = command;
    switch (history_.insert(one, *this)) {
      case History::Placing::taken:
        return {};
      case History::Placing::late:
      case History::Placing::from_the_future:
        return too_far(command, history_.navigator().now_ns(), setup_.config.horizon_s);
      case History::Placing::duplicate:
        return "it was given before";
      case History::Placing::not_started:
        break;
    }
    return "navigation has not begun";
  }

  void start_from(const InitialState& state) {
    (void)nav_state();  // the last one stands until the next inertial sample
    history_.clear(*this);
    preprocessor_ = ImuPreprocessor(setup_);
    pending_start_ = state;
  }

  void finish() {
    history_.settle(*this);
    if (nav_.header.sequence > 0) filled_ = false;
  }

  bool save(std::vector<std::byte>& out) const {
    if (!history_.started() || pending_start_) return false;
    archive::Writer image(out, kStateVersion);
    const SampleHeader& newest = nav_.header;
    const StateHead head{StateHead::kMagic, kStateVersion,   layout(kStateVersion),
                         newest.sequence,   newest.stamp_ns, newest.received_ns};
    image("head", head);
    image("intake", preprocessor_);
    history_.write(image);
    return true;
  }

  std::string restore(std::span<const std::byte> bytes) {
    archive::Reader image(bytes);
    StateHead head;
    image("head", head);
    if (!image.good()) return image.complaint();
    if (head.layout != layout(head.version))
      return "its fields are not those that this build expects of version " + std::to_string(head.version);
    ImuPreprocessor intake(setup_);
    image.set_version(head.version);
    image("intake", intake);
    image.expect(intake.newest_ns() == head.stamp_ns, "intake.last_ns", "the stamp of the state");
    if (std::string why = history_.read(image, head.stamp_ns, *this); !why.empty()) return why;
    preprocessor_ = intake;
    nav_.header.stamp_ns = head.stamp_ns;
    nav_.header.received_ns = head.received_ns;
    nav_.header.sequence = head.sequence;
    filled_ = false;
    pending_start_.reset();
    history_.for_each_event([this](const Measurement& one) {
      if (!one.command) forecaster_.remember(one.sensor, one.sample);
    });
    return {};
  }

  void judged(const Measurement& measurement, const Judgement& judgement, VerdictKind previous) override {
    if (measurement.command) {
      outcomes_.push() =
          outcome_of(std::get<Command>(measurement.sample), judgement, measurement.revision > 0);
      return;
    }
    if (judgement.kind == VerdictKind::used) forecaster_.remember(measurement.sensor, measurement.sample);
    Verdict& verdict = push(measurement.header(), measurement.source, measurement.writer, judgement);
    verdict.revision = measurement.revision;
    verdict.previous = previous;
    verdict.is_final = measurement.settled;
  }

  bool next_outcome(OrderOutcome& outcome) { return outcomes_.pop(outcome); }
  bool next_verdict(Verdict& verdict) { return verdicts_.pop(verdict); }

  template <class Out>
  void fill(Out& out) const {
    stamp(out.header);
    estimation::fill(setup_, history_.navigator(), out);
  }

  void take_forecast() {
    stamp(forecast_header_);
    forecaster_.take(history_.navigator());
  }

  void fill_taken(Forecast& out) {
    out.header = forecast_header_;
    forecaster_.fill(out);
  }

  [[nodiscard]] double forecast_horizontal_95_m(double after_s) {
    forecaster_.take(history_.navigator());
    return forecaster_.horizontal_95_m(after_s);
  }

  [[nodiscard]] Matrix9 navigation_covariance() const {
    const ErrorFilter& filter = history_.navigator().filter();
    Matrix9 p;
    for (int i = 0; i < kNavStates; ++i)
      for (int j = 0; j < kNavStates; ++j) p(i, j) = filter(i, j);
    return p;
  }

  [[nodiscard]] const NavState& nav_state() const {
    if (!filled_) {
      estimation::fill(setup_, history_.navigator(), nav_);
      nav_.altitude_above_bottom_m = bottom_.altitude_m(setup_, history_.navigator());
    }
    filled_ = true;
    return nav_;
  }
  [[nodiscard]] std::uint64_t repeated_steps() const { return history_.repeated_steps(); }
  [[nodiscard]] bool catching_up() const { return history_.catching_up(); }
  [[nodiscard]] std::uint64_t dropped() const { return verdicts_.dropped(); }

 private:
  /// Tells the fields of that version, as this build and configuration have them.
  [[nodiscard]] std::uint64_t layout(std::uint32_t version) const {
    archive::Layout out(version);
    out("intake", preprocessor_);
    history_.layout(out);
    return out.fingerprint();
  }

  [[nodiscard]] int find(const Name& sensor, SourceKind source) const {
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (names_[i] == sensor && setup_.config.sensors[i].kind == source) return static_cast<int>(i);
    return -1;
  }

  void stamp(SampleHeader& header) const {
    header.vehicle = nav_.header.vehicle;
    header.sensor = nav_.header.sensor;
    header.stamp_ns = nav_.header.stamp_ns;
    header.received_ns = nav_.header.received_ns;
  }

  bool refuse(const ImuSample& sample, VerdictKind kind) {
    Judgement judgement;
    judgement.kind = kind;
    refuse(sample.header, SourceKind::imu, {}, judgement);
    return false;
  }

  void refuse(const SampleHeader& header, SourceKind source, const Name& writer, const Judgement& judgement) {
    push(header, source, writer, judgement).is_final = true;
  }

  Verdict& push(const SampleHeader& header, SourceKind source, const Name& writer,
                const Judgement& judgement) {
    Verdict& verdict = verdicts_.push();
    verdict = verdict_of(header, source, judgement);
    verdict.writer = writer;
    return verdict;
  }

  Setup setup_;
  ImuPreprocessor preprocessor_;
  History history_;
  Forecaster forecaster_;
  Bottom bottom_;
  SampleHeader forecast_header_;  ///< of take_forecast()
  mutable NavState nav_;          ///< filled when asked for
  mutable bool filled_ = true;
  Measurement incoming_;
  std::vector<Name> names_;
  NewestKept<Verdict> verdicts_;
  NewestKept<OrderOutcome> outcomes_{kOutcomesKept};
  std::optional<InitialState> pending_start_;
};

FusionEngine::FusionEngine(const EngineConfig& config) : impl_(std::make_unique<Impl>(config)) {}
FusionEngine::~FusionEngine() = default;
FusionEngine::FusionEngine(FusionEngine&&) noexcept = default;
FusionEngine& FusionEngine::operator=(FusionEngine&&) noexcept = default;

bool FusionEngine::add(const ImuSample& sample) {
  return impl_->add(sample);
}
void FusionEngine::take(const EventSample& sample, SourceKind source, const Name& writer) {
  impl_->add(sample, source, writer);
}
void FusionEngine::inform(const AnySample& sample, const Name& writer) {
  impl_->inform(sample, writer);
}
std::string FusionEngine::objection(const Command& command) const {
  return impl_->objection(command);
}
std::string FusionEngine::apply(const Command& command) {
  return impl_->apply(command);
}
bool FusionEngine::next_outcome(OrderOutcome& outcome) {
  return impl_->next_outcome(outcome);
}
void FusionEngine::start_from(const InitialState& state) {
  impl_->start_from(state);
}
void FusionEngine::finish() {
  impl_->finish();
}
std::uint64_t FusionEngine::repeated_steps() const {
  return impl_->repeated_steps();
}
bool FusionEngine::catching_up() const {
  return impl_->catching_up();
}
const NavState& FusionEngine::nav_state() const {
  return impl_->nav_state();
}
bool FusionEngine::next_verdict(Verdict& verdict) {
  return impl_->next_verdict(verdict);
}
std::uint64_t FusionEngine::verdicts_dropped() const {
  return impl_->dropped();
}
void FusionEngine::fill(NavDetail& detail) const {
  impl_->fill(detail);
}
void FusionEngine::fill(AlignmentStatus& status) const {
  impl_->fill(status);
}
void FusionEngine::fill(Forecast& forecast) {
  impl_->take_forecast();
  impl_->fill_taken(forecast);
}
void FusionEngine::take_forecast() {
  impl_->take_forecast();
}
void FusionEngine::fill_taken(Forecast& forecast) {
  impl_->fill_taken(forecast);
}
bool FusionEngine::save(std::vector<std::byte>& out) const {
  return impl_->save(out);
}
std::string FusionEngine::restore(std::span<const std::byte> image) {
  return impl_->restore(image);
}
double FusionEngine::forecast_horizontal_95_m(double after_s) {
  return impl_->forecast_horizontal_95_m(after_s);
}
Eigen::Matrix<double, 9, 9> FusionEngine::navigation_covariance() const {
  return impl_->navigation_covariance();
}

}  // namespace fathom::estimation
