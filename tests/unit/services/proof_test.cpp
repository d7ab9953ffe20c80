// Whether what fusion published follows from what it took.

#include "live/record/proof.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "archive/digest.hpp"
#include "config/fusion/fusion_config.hpp"
#include "live/record/spans.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom {
namespace {

using cli::Proof;
using cli::StatePool;
using Item = std::variant<AnySample, Command, IntakeRecord, NavState, Verdict>;
using Archive = std::vector<std::byte>;

config::FusionConfig configuration() {
  config::FusionConfig config;
  config.engine = test::SurveyRun::config();
  return config;
}

AnySample any(const test::Sample& sample) {
  return std::visit([](const auto& one) { return AnySample(one); }, sample);
}

const std::vector<test::Sample>& survey() {
  static const std::vector<test::Sample> kSamples = [] {
    test::SurveyRun::Options options;
    options.duration_s = 70.0;
    return test::SurveyRun(options).samples;
  }();
  return kSamples;
}

/// What is said by a fusion service that is given samples and orders.
class Fusion {
 public:
  void sample(const test::Sample& sample, bool again = false) {
    const SampleHeader& header = test::header(sample);
    note({IntakeKind::sample, source_of(any(sample)), header.sensor, "bridge", header.stamp_ns,
          header.sequence, again});
    std::visit(
        [&]<class T>(const T& known) {
          if constexpr (std::is_same_v<T, ImuSample>) {
            if (engine_.add(known) && !again) said_.emplace_back(engine_.nav_state());
          } else {
            engine_.add(known, "bridge");
          }
        },
        sample);
    for (Verdict verdict; engine_.next_verdict(verdict);) {
      if (verdict.source == SourceKind::imu) verdict.writer = "bridge";
      if (!again) said_.emplace_back(verdict);
    }
  }
  void order(const Command& order) {
    (void)engine_.apply(order);
    note({IntakeKind::order,
          SourceKind::imu,
          order.header.sensor,
          {},
          order.header.stamp_ns,
          order.header.sequence,
          false});
  }
  void go_on_from(const Archive& state, TimeNs stamp_ns) {
    ASSERT_EQ(engine_.restore(state), "");
    note({IntakeKind::state, SourceKind::imu, "other", {}, stamp_ns, archive::digest(state), false});
  }
  [[nodiscard]] Archive state() const {
    Archive out;
    EXPECT_TRUE(engine_.save(out));
    return out;
  }
  [[nodiscard]] TimeNs stamp_ns() const { return engine_.nav_state().header.stamp_ns; }
  /// What it said since the last time; `all`: with the end of its list.
  std::vector<Item> said(bool all = false) {
    if (all && !batch_.entries.empty()) flush();
    return std::exchange(said_, {});
  }

 private:
  void note(const IntakeEntry& entry) {
    batch_.entries.push_back(entry);
    if (batch_.entries.size() == 37) flush();
  }
  void flush() {
    batch_.first = first_;
    first_ += batch_.entries.size();
    said_.emplace_back(std::exchange(batch_, {}));
  }

  estimation::FusionEngine engine_{config::engine_config(configuration())};
  IntakeRecord batch_;
  std::uint64_t first_ = 0;
  std::vector<Item> said_;
};

void append(std::vector<Item>& to, const std::vector<Item>& what) {
  to.insert(to.end(), what.begin(), what.end());
}

/// What a recorder hears of a fusion service on a short survey, an order among it.
std::vector<Item> recorded() {
  Fusion fusion;
  std::vector<Item> out;
  std::size_t count = 0;
  for (const test::Sample& sample : survey()) {
    out.emplace_back(any(sample));
    fusion.sample(sample);
    if (++count == 4000) {
      Command order;
      order.header = {"auv", "console", test::header(sample).stamp_ns, test::header(sample).stamp_ns, 1};
      order.kind = CommandKind::disable_source;
      order.target = "depth0";
      out.emplace_back(order);
      fusion.order(order);
    }
    append(out, fusion.said());
  }
  return out;
}

const std::vector<Item>& recording() {
  static const std::vector<Item> kItems = recorded();
  return kItems;
}

void put(Proof& proof, const std::vector<Item>& items) {
  for (const Item& item : items) {
    std::visit(
        [&]<class T>(const T& one) {
          if constexpr (std::is_same_v<T, AnySample>)
            proof.add(one, "bridge");
          else
            proof.add(one);
        },
        item);
    if (!proof.difference().empty()) break;
  }
}

std::string difference_of(const std::vector<Item>& items, std::uint64_t* states = nullptr) {
  StatePool pool;
  Proof proof(configuration(), pool, {0, true});
  put(proof, items);
  proof.finish();
  if (states != nullptr) *states = proof.states();
  if (proof.difference().empty()) {
    EXPECT_GT(proof.verdicts(), 100U);
  }
  return proof.difference();
}

template <class T>
std::size_t nth(std::size_t n) {
  for (std::size_t i = 0; i < recording().size(); ++i) {
    bool here = false;
    if constexpr (std::is_same_v<T, ImuSample>) {
      const auto* sample = std::get_if<AnySample>(&recording()[i]);
      here = sample != nullptr && std::holds_alternative<ImuSample>(*sample);
    } else {
      here = std::holds_alternative<T>(recording()[i]);
    }
    if (here && n-- == 0) return i;
  }
  return 0;
}

TEST(Proof, IsExactForWhatFusionDid) {
  std::uint64_t states = 0;
  EXPECT_EQ(difference_of(recording(), &states), "");
  EXPECT_GT(states, 5000U);
  // Of an engine that navigates: one that does not align says little.
  const auto aligned = std::count_if(recording().begin(), recording().end(), [](const Item& item) {
    const auto* state = std::get_if<NavState>(&item);
    return state != nullptr && state->alignment == AlignmentPhase::aligned;
  });
  EXPECT_GT(aligned, 3000);
}

TEST(Proof, DoesNotDependOnTheOrderInWhichItWasHeard) {
  std::mt19937 random(3);
  for (int run = 0; run < 3; ++run) {
    std::vector<Item> items = recording();
    for (std::size_t at = 0; at + 200 < items.size(); at += 100) {
      const auto begin = items.begin() + static_cast<std::ptrdiff_t>(at);
      std::shuffle(begin, begin + 200, random);
    }
    EXPECT_EQ(difference_of(items), "");
  }
}

TEST(Proof, FindsASingleBit) {
  std::vector<Item> items = recording();
  auto& sample = std::get<ImuSample>(std::get<AnySample>(items[nth<ImuSample>(3000)]));
  const double before = sample.delta_angle_B_rad[2];
  for (auto* value : {&sample.angular_rate_B_rad_s[2], &sample.delta_angle_B_rad[2]})
    *value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(*value) ^ 1U);
  ASSERT_NE(before, sample.delta_angle_B_rad[2]);
  const std::string found = difference_of(items);
  EXPECT_TRUE(found.starts_with("navigation state 300")) << found;
  items = recording();
  auto& state = std::get<NavState>(items[nth<NavState>(100)]);
  state.velocity_covariance_N_m2_s2[4] = std::nextafter(1.0, 2.0);
  EXPECT_NE(difference_of(items).find("velocity_covariance_N_m2_s2[4]: recorded 1.0000000000000002"),
            std::string::npos);
}

TEST(Proof, NamesASampleThatIsMissing) {
  std::vector<Item> items = recording();
  const std::size_t at = nth<ImuSample>(2500);
  const auto number = header_of(std::get<AnySample>(items[at])).sequence;
  items.erase(items.begin() + static_cast<std::ptrdiff_t>(at));
  const std::string found = difference_of(items);
  EXPECT_TRUE(found.starts_with("imu sample imu " + std::to_string(number) + " at 20")) << found;
  EXPECT_NE(found.find("is not in the recording"), std::string::npos);
}

TEST(Proof, NamesAGapInTheList) {
  std::vector<Item> items = recording();
  items.erase(items.begin() + static_cast<std::ptrdiff_t>(nth<IntakeRecord>(5)));
  EXPECT_EQ(difference_of(items), "the list of what fusion took has a gap at entry 185");
}

TEST(Proof, FindsAnOrderThatWasTakenOut) {
  std::vector<Item> items = recording();
  items.erase(items.begin() + static_cast<std::ptrdiff_t>(nth<Command>(0)));
  EXPECT_NE(difference_of(items).find("an order of console 1 at"), std::string::npos);
}

/// What a recorder hears from some seconds before a state was saved to some seconds after, and that state. It
/// is saved between any two samples.
struct Part {
  std::vector<Item> items;
  std::uint64_t first_entry = 0;
  TimeNs stamp_ns = 0;
  Archive state;
};

std::vector<Part> parts(const std::vector<std::size_t>& saved_behind) {
  std::vector<Part> out(saved_behind.size());
  Fusion fusion;
  constexpr std::size_t kBefore = 600;
  constexpr std::size_t kAfter = 1200;
  for (std::size_t at = 0; at < survey().size(); ++at) {
    fusion.sample(survey()[at]);
    const std::vector<Item> said = fusion.said();
    for (std::size_t i = 0; i < out.size(); ++i) {
      Part& part = out[i];
      const std::size_t when = saved_behind[i];
      if (at == when) {
        part.state = fusion.state();
        part.stamp_ns = fusion.stamp_ns();
      }
      if (at + kBefore < when || at > when + kAfter) continue;
      part.items.emplace_back(any(survey()[at]));
      append(part.items, said);
    }
  }
  for (Part& part : out) {
    for (const Item& item : part.items) {
      if (const auto* intake = std::get_if<IntakeRecord>(&item)) {
        part.first_entry = intake->first;
        break;
      }
    }
  }
  return out;
}

TEST(Proof, BeginsFromAStateThatWasSavedBetweenAnyTwoSamples) {
  std::mt19937 random(5);
  std::vector<std::size_t> saved_behind;
  for (int i = 0; i < 40; ++i) saved_behind.push_back(3000 + random() % (survey().size() - 4500));
  for (const Part& part : parts(saved_behind)) {
    SCOPED_TRACE(to_iso8601(part.stamp_ns, 3));
    StatePool pool;
    Proof proof(configuration(), pool, {part.first_entry, false, {{part.stamp_ns, part.state}}});
    put(proof, part.items);
    proof.finish();
    EXPECT_EQ(proof.difference(), "");
    EXPECT_EQ(proof.missing(), "");
    EXPECT_EQ(proof.from_ns(), part.stamp_ns);
    EXPECT_GT(proof.states(), 500U);
  }
}

/// The beginning of a run, without the samples of the inertial unit up to the one of this number and without
/// the first one of the receiver.
struct Late {
  Part part;
  cli::Spans spans;

  explicit Late(std::uint64_t from_number, std::uint64_t and_without = 0) : part(parts({600}).front()) {
    std::erase_if(part.items, [&](const Item& item) {
      const auto* sample = std::get_if<AnySample>(&item);
      if (sample == nullptr) return false;
      const std::uint64_t number = header_of(*sample).sequence;
      if (source_of(*sample) == SourceKind::imu) return number < from_number || number == and_without;
      return source_of(*sample) == SourceKind::gps && number < 2;
    });
    for (const Item& item : part.items) {
      if (const auto* sample = std::get_if<AnySample>(&item))
        spans.note(source_of(*sample), header_of(*sample), {"process", 0, "bridge"});
    }
  }
  [[nodiscard]] Proof::Begin begin(bool with_checkpoint) const {
    Proof::Begin out{0, true};
    if (with_checkpoint) out.checkpoints[part.stamp_ns] = part.state;
    out.outside = [this](const IntakeEntry& entry) { return !spans.hold(entry); };
    return out;
  }
};

TEST(Proof, GoesOnFromACheckpointBehindSamplesThatTheRecorderWasTooLateFor) {
  const Late late(3);
  StatePool pool;
  Proof proof(configuration(), pool, late.begin(true));
  put(proof, late.part.items);
  proof.finish();
  EXPECT_EQ(proof.difference(), "");
  EXPECT_EQ(proof.missing(), "");
  EXPECT_EQ(proof.lacking_count(), 3U);
  ASSERT_EQ(proof.lacking().size(), 3U);
  EXPECT_TRUE(proof.lacking().front().starts_with("imu sample imu 1 at ")) << proof.lacking().front();
  EXPECT_EQ(proof.whole_from_ns(), late.part.stamp_ns);
  EXPECT_TRUE(proof.is_whole());
  EXPECT_GT(proof.states(), 500U);
}

TEST(Proof, FindsWhatDiffersBehindSamplesThatTheRecorderWasTooLateFor) {
  Late late(2);
  for (Item& item : late.part.items) {
    auto* state = std::get_if<NavState>(&item);
    if (state != nullptr && state->header.stamp_ns > late.part.stamp_ns + kNsPerSecond) {
      state->velocity_N_m_s[0] = 1e-12;
      break;
    }
  }
  StatePool pool;
  Proof proof(configuration(), pool, late.begin(true));
  put(proof, late.part.items);
  proof.finish();
  EXPECT_NE(proof.difference().find("velocity_N_m_s[0]"), std::string::npos) << proof.difference();
}

TEST(Proof, ChecksNothingWhereTheRecorderWasTooLateAndThereIsNoCheckpoint) {
  const Late late(2);
  StatePool pool;
  Proof proof(configuration(), pool, late.begin(false));
  put(proof, late.part.items);
  proof.finish();
  EXPECT_EQ(proof.difference(), "");
  EXPECT_EQ(proof.lacking_count(), 2U);
  EXPECT_FALSE(proof.is_whole());
  EXPECT_EQ(proof.states(), 0U);
}

TEST(Proof, ASampleThatIsMissingBehindOthersOfItsBridgeIsADifference) {
  const Late late(2, 900);
  StatePool pool;
  Proof proof(configuration(), pool, late.begin(true));
  put(proof, late.part.items);
  proof.finish();
  EXPECT_TRUE(proof.difference().starts_with("imu sample imu 900 at ")) << proof.difference();
}

TEST(Spans, AreThoseOfEachProcessInEachFile) {
  cli::Spans spans;
  const auto taken = [](TimeNs stamp_ns, std::uint64_t number, Name writer = "bridge") {
    return IntakeEntry{IntakeKind::sample, SourceKind::gps, "gps", writer, stamp_ns, number, false};
  };
  const auto note = [&](TimeNs stamp_ns, std::uint64_t number, const char* process, std::size_t file) {
    spans.note(SourceKind::gps, {"auv", "gps", stamp_ns, stamp_ns + 1, number}, {process, file, "bridge"});
  };
  EXPECT_FALSE(spans.hold(taken(100, 1))) << "there is none of that instrument";
  note(300, 3, "first", 0);
  note(900, 9, "first", 0);
  EXPECT_FALSE(spans.hold(taken(200, 2))) << "found too late";
  EXPECT_TRUE(spans.hold(taken(500, 5)));
  EXPECT_FALSE(spans.hold(taken(500, 5, "other")));
  EXPECT_FALSE(spans.hold(taken(1000, 10))) << "the last one before it was killed";
  note(1500, 15, "first", 1);
  EXPECT_FALSE(spans.hold(taken(1000, 10))) << "between two files";
  note(2200, 2, "second", 1);
  note(2900, 9, "second", 1);
  EXPECT_FALSE(spans.hold(taken(2100, 1))) << "of the bridge that was started anew";
  EXPECT_TRUE(spans.hold(taken(2500, 5)));
}

}  // namespace
}  // namespace fathom
