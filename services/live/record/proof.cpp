#include "live/record/proof.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

#include "cli/command.hpp"

namespace fathom::cli {
namespace {

constexpr DurationNs kAgain_ns = 5 * kNsPerSecond;  // after a state
constexpr std::size_t kMostSamples = 1U << 16U;     // that wait for the list that names them
constexpr std::size_t kMostOrders = 4096;
constexpr std::size_t kMostWaiting = 1U << 20U;  // entries
constexpr std::size_t kMostKept = 1U << 15U;     // states and verdicts that wait for their like
constexpr std::size_t kMostNamed = 3;            // samples that are lacking
constexpr std::size_t kPatience = 20'000;        // samples, while a state is waited for
/// Lists that come after a verdict: one of them names what it follows from, or nothing does.
constexpr std::size_t kSettled = 5;

constexpr TimeNs kBeginning = std::numeric_limits<TimeNs>::min();

std::string in_words(const IntakeEntry& entry) {
  return (entry.kind == IntakeKind::order ? "an order of "
                                          : std::string(to_string(entry.source)) + " sample ") +
         entry.sensor.str() + " " + std::to_string(entry.sequence) + " at " + to_iso8601(entry.stamp_ns, 6);
}

}  // namespace

Proof::Proof(const config::FusionConfig& config, StatePool& pool, Begin begin)
    : engine_(config::engine_config(config)),
      pool_(pool),
      checkpoints_(std::move(begin.checkpoints)),
      outside_(std::move(begin.outside)),
      under_way_(begin.afresh),
      next_(begin.entry),
      begin_ns_(kBeginning),
      nav_states_(kMostKept),
      judgements_(kMostKept) {
  if (begin.afresh && config::starts_from_state(config.start.mode))
    engine_.start_from(config::initial_state(config));
}

void Proof::add(const AnySample& sample, const Name& writer) {
  const SampleHeader& header = header_of(sample);
  const Key key{static_cast<int>(source_of(sample)), header.sensor, header.stamp_ns, header.sequence};
  samples_.emplace(key, std::pair(writer, sample));
  ages_.push_back(key);
  if (ages_.size() > kMostSamples) {  // nobody took it: of another vehicle, or refused
    samples_.erase(samples_.find(ages_.front()));
    ages_.pop_front();
  }
  if (waited_ > 0 && ++waited_ > kPatience) give_up_waiting();
  go_on();
}

void Proof::add(const Command& order) {
  const SampleHeader& header = order.header;
  orders_.try_emplace({-1, header.sensor, header.stamp_ns, header.sequence}, order);
  if (orders_.size() > kMostOrders) orders_.erase(orders_.begin());
  go_on();
}

void Proof::add(const IntakeRecord& intake) {
  ++records_;
  for (std::size_t i = 0; i < intake.entries.size(); ++i) {
    if (intake.first + i >= next_) entries_.try_emplace(intake.first + i, intake.entries[i]);
  }
  if (entries_.size() > kMostWaiting)
    differ("the list of what fusion took has a gap at entry " + std::to_string(next_));
  go_on();
}

void Proof::add(const NavState& recorded) {
  const StateKey key{recorded.header.stamp_ns, recorded.header.sequence};
  last_state_ = std::max(last_state_, key);
  const auto match = nav_states_.recorded(key, recorded, records_);
  states_ += match.equal ? 1 : 0;
  differ(match.difference);
}

Proof::VerdictKey Proof::key_of(const Verdict& verdict) {
  return {verdict.header.stamp_ns, static_cast<int>(verdict.source), verdict.header.sensor,
          verdict.header.sequence, verdict.revision};
}

void Proof::add(const Verdict& recorded) {
  // Of inertial samples that were not given to the engine.
  if (recorded.source == SourceKind::imu && recorded.kind == VerdictKind::source_disabled) return;
  const auto match = judgements_.recorded(key_of(recorded), recorded, records_);
  verdicts_ += match.equal ? 1 : 0;
  differ(match.difference);
}

bool Proof::go_on() {
  const std::uint64_t before = next_;
  while (difference_.empty() && !entries_.empty() && entries_.begin()->first == next_) {
    const IntakeEntry& entry = entries_.begin()->second;
    if (is_lacking(entry))
      pass(entry);
    else if (!(under_way_ || entry.kind == IntakeKind::state ? give(entry) : look_for_begin(entry)))
      break;
    entries_.erase(entries_.begin());
    ++next_;
  }
  return next_ != before;
}

bool Proof::is_lacking(const IntakeEntry& entry) const {
  return entry.kind == IntakeKind::sample && outside_ && outside_(entry) && find(entry) == nullptr;
}

void Proof::pass(const IntakeEntry& entry) {
  interrupt();
  whole_from_ns_.reset();
  if (++lacking_count_ <= kMostNamed) lacking_.push_back(in_words(entry));
}

bool Proof::give(const IntakeEntry& entry) {
  switch (entry.kind) {
    case IntakeKind::state:
      return take_up(entry);
    case IntakeKind::end:
      engine_.finish();
      ended_ = true;
      break;
    case IntakeKind::order:
      if (!give_order(entry)) return false;
      break;
    case IntakeKind::sample:
      if (!give_sample(entry)) return false;
      break;
  }
  collect(entry.again);
  offer();
  return true;
}

bool Proof::give_order(const IntakeEntry& entry) {
  const auto found = orders_.find({-1, entry.sensor, entry.stamp_ns, entry.sequence});
  if (found == orders_.end()) return false;
  (void)engine_.apply(found->second);
  ++given_;
  return true;
}

const AnySample* Proof::find(const IntakeEntry& entry) const {
  const auto [from, to] =
      samples_.equal_range({static_cast<int>(entry.source), entry.sensor, entry.stamp_ns, entry.sequence});
  if (from == to) return nullptr;
  // Two writers may have said so; the list says whose it took.
  const auto own = std::find_if(from, to, [&](const auto& one) { return one.second.first == entry.writer; });
  return &(own == to ? from : own)->second.second;
}

bool Proof::give_sample(const IntakeEntry& entry) {
  const AnySample* found = find(entry);
  if (found == nullptr) return false;
  std::visit(
      [&]<class T>(const T& sample) {
        if constexpr (std::is_same_v<T, ImuSample>) {
          give(sample, entry);
        } else {
          engine_.add(sample, entry.writer);
        }
      },
      *found);
  ++given_;
  return true;
}

void Proof::give(const ImuSample& sample, const IntakeEntry& entry) {
  imu_writer_ = entry.writer;
  if (!engine_.add(sample) || entry.again) return;
  const NavState& state = engine_.nav_state();
  const auto match = nav_states_.computed({state.header.stamp_ns, state.header.sequence}, state);
  states_ += match.equal ? 1 : 0;
  differ(match.difference);
}

bool Proof::take_up(const IntakeEntry& entry) {
  const std::vector<std::byte>* state = pool_.find(entry.sequence);
  if (state == nullptr) {
    if (waited_ == 0) waited_ = 1;
    return false;
  }
  waited_ = 0;
  begin_from(entry.stamp_ns, *state);
  ++taken_up_;
  return true;
}

bool Proof::give_up_waiting() {
  if (waited_ == 0) return false;
  waited_ = 0;
  const IntakeEntry& entry = entries_.begin()->second;
  lose("at " + to_iso8601(entry.stamp_ns, 3) + " it went on from a state of " + entry.sensor.str() +
       " that is not in the recording and follows from nothing in it");
  entries_.erase(entries_.begin());
  ++next_;
  return true;
}

/// What was under way ends here.
void Proof::interrupt() {
  if (under_way_) done_.emplace_back(begin_ns_, engine_.nav_state().header.stamp_ns);
  under_way_ = false;
}

void Proof::lose(const std::string& why) {
  interrupt();
  if (missing_.empty()) missing_ = why;
}

void Proof::begin_from(TimeNs stamp_ns, std::span<const std::byte> state) {
  interrupt();
  if (const std::string why = engine_.restore(state); !why.empty()) {
    return differ("the state of " + to_iso8601(stamp_ns, 3) +
                  " is none of an engine of this configuration: " + why);
  }
  under_way_ = true;
  begin_ns_ = stamp_ns;
  if (lacking_count_ > 0 && !whole_from_ns_) {
    whole_from_ns_ = stamp_ns;
    states_before_ = states_;
  }
  nav_states_.renew();
  judgements_.renew();
  duplicates_until_ns_.reset();
  if (!from_ns_ && given_ == 0 && next_ > 0) from_ns_ = stamp_ns;
}

bool Proof::look_for_begin(const IntakeEntry& entry) {
  if (entry.kind != IntakeKind::sample || entry.source != SourceKind::imu) return true;
  const auto found = checkpoints_.find(entry.stamp_ns);
  if (found == checkpoints_.end()) return true;
  // Whatever came before that inertial sample is in the state. What came after it may be, and then counts as
  // a duplicate.
  begin_from(entry.stamp_ns, found->second);
  duplicates_until_ns_ = entry.stamp_ns + kAgain_ns;
  return true;
}

void Proof::collect(bool again) {
  for (Verdict verdict; engine_.next_verdict(verdict);) {
    if (again) continue;
    if (verdict.source == SourceKind::imu) verdict.writer = imu_writer_;
    // In the state that was begun with, and given again.
    if (verdict.kind == VerdictKind::duplicate && duplicates_until_ns_ &&
        verdict.header.stamp_ns < *duplicates_until_ns_)
      continue;
    const auto match = judgements_.computed(key_of(verdict), verdict);
    verdicts_ += match.equal ? 1 : 0;
    differ(match.difference);
  }
  for (estimation::OrderOutcome outcome; engine_.next_outcome(outcome);) continue;
}

void Proof::offer() {
  const TimeNs stamp_ns = engine_.nav_state().header.stamp_ns;
  if (!difference_.empty() || !pool_.wants(stamp_ns)) return;
  std::vector<std::byte> archive;
  if (engine_.save(archive)) pool_.offer(stamp_ns, archive);
}

void Proof::differ(const std::string& what) {
  if (difference_.empty()) difference_ = what;
}

std::uint64_t Proof::unheard() const {
  return states_ == 0 ? 0 : nav_states_.unheard_before(last_state_);
}

void Proof::finish() {
  if (!difference_.empty()) return;
  if (!entries_.empty()) {
    const auto& [number, entry] = *entries_.begin();
    if (number != next_)
      return differ("the list of what fusion took has a gap at entry " + std::to_string(next_));
    return differ(in_words(entry) + ", which fusion took, is not in the recording");
  }
  // What the engine said last may have been said after the recording's end, and the other way round what was
  // recorded last may follow from what the list names no more.
  interrupt();
  const auto state = nav_states_.unfounded([&](const NavState& one, std::size_t /*when*/) {
    return std::any_of(done_.begin(), done_.end(), [&](const auto& part) {
      return one.header.stamp_ns > part.first && one.header.stamp_ns <= part.second;
    });
  });
  if (state) return differ(cli::in_words(*state) + " follows from nothing that fusion took");
  if (from_ns_ || lacking_count_ > 0 || !missing_.empty())
    return;  // a verdict's time is not that of its stamp
  const auto verdict = judgements_.unfounded(
      [&](const Verdict&, std::size_t when) { return ended_ || records_ >= when + kSettled; });
  if (verdict) differ(cli::in_words(*verdict) + " follows from nothing that fusion took");
}

}  // namespace fathom::cli
