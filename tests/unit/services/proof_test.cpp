// Whether what fusion published follows from what it took.

#include "cli/record/proof.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "config/fusion/fusion_config.hpp"
#include "support/survey_run.hpp"

namespace fathom {
namespace {

using cli::Proof;
using Item = std::variant<AnySample, Command, IntakeRecord, NavState, Verdict>;

config::FusionConfig configuration() {
  return config::load_service_config<config::FusionConfig>(
             {std::string(FATHOM_SOURCE_DIR) + "/deploy/config/fusion.json", {}})
      .value;
}

AnySample any(const test::Sample& sample) {
  return std::visit([](const auto& one) { return AnySample(one); }, sample);
}

/// What a recorder hears of a fusion service on a short survey, an order among it.
std::vector<Item> recorded() {
  const config::FusionConfig config = configuration();
  estimation::FusionEngine engine(config::engine_config(config));
  test::SurveyRun::Options options;
  options.duration_s = 70.0;
  std::vector<Item> out;
  IntakeRecord batch;
  std::uint64_t first = 0;
  const auto note = [&](const IntakeEntry& entry) {
    batch.entries.push_back(entry);
    if (batch.entries.size() < 37) return;
    batch.first = first;
    first += batch.entries.size();
    out.emplace_back(std::exchange(batch, {}));
  };
  const test::SurveyRun survey(options);
  std::size_t count = 0;
  for (const test::Sample& sample : survey.samples) {
    const AnySample one = any(sample);
    const SampleHeader& header = header_of(one);
    out.emplace_back(one);
    note({false, source_of(one), header.sensor, "bridge", header.stamp_ns, header.sequence});
    std::visit(
        [&]<class T>(const T& known) {
          if constexpr (std::is_same_v<T, ImuSample>) {
            if (engine.add(known)) out.emplace_back(engine.nav_state());
          } else {
            engine.add(known, "bridge");
          }
        },
        sample);
    if (++count == 4000) {
      Command order;
      order.header = {"auv", "console", header.stamp_ns, header.stamp_ns, 1};
      order.kind = CommandKind::disable_source;
      order.target = "depth";
      (void)engine.apply(order);
      out.emplace_back(order);
      note({true, SourceKind::imu, "console", {}, header.stamp_ns, 1});
    }
    for (Verdict verdict; engine.next_verdict(verdict);) {
      if (verdict.source == SourceKind::imu) verdict.writer = "bridge";
      out.emplace_back(verdict);
    }
  }
  return out;
}

const std::vector<Item>& recording() {
  static const std::vector<Item> kItems = recorded();
  return kItems;
}

std::string difference_of(const std::vector<Item>& items, std::uint64_t* states = nullptr) {
  Proof proof(configuration());
  for (const Item& item : items) {
    std::visit([&](const auto& one) { proof.add(one); }, item);
    if (!proof.difference().empty()) break;
  }
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

}  // namespace
}  // namespace fathom
