// Real vehicles with the class that is shipped for them, and with mistakes: what fusion says of itself,
// without anybody's help.

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "solve_fixture.hpp"
#include "support/data.hpp"
#include "support/paths.hpp"
#include "unit/commission/sabotage.hpp"

namespace fathom::test {
namespace {

struct Recorded {
  const char* folder;
  const char* of_class;
  /// What is said of each mistake: sensor and kind, any of which says it.
  std::map<std::string, std::set<std::string>> said;
  /// What nothing speaks against before it is aligned.
  std::set<std::string> aligns;
};

/// A car and a small aircraft. The car hardly rolls or pitches: that two level axes of its gyro are exchanged
/// takes most of a minute to be seen.
const std::vector<Recorded>& recorded() {
  static const std::map<std::string, std::set<std::string>> kCar{{"accelerometer negated", {"imu sign"}},
                                                                 {"gyro negated", {"imu sign"}},
                                                                 {"gyro in deg/s", {"imu unit"}},
                                                                 {"accelerometer in g", {"imu unit"}},
                                                                 {"gps velocity east north up", {"gps axes"}},
                                                                 {"imu 10 % fast", {"imu rate"}}};
  static const std::vector<Recorded> kAll = [] {
    auto car = kCar;
    car["gyro x and y swapped"] = {"imu axes"};
    auto aircraft = car;
    aircraft["gyro negated"].insert("imu axes");
    return std::vector<Recorded>{{"rtkx_drive", "mems_car", car, {"gyro x and y swapped"}},
                                 {"thor75", "mems_fixed_wing", aircraft, {}}};
  }();
  return kAll;
}

class SolveRecorded : public SolveTest {
 protected:
  /// The metrics of a solution of `data` as that class.
  nlohmann::json solved(const dataset::Dataset& data, const char* of_class) {
    dataset::write(path("data"), data);
    fs::copy_file(fs::path(source_dir() + "/deploy/config/solve") / (std::string(of_class) + ".json"),
                  path("class.json"), fs::copy_options::overwrite_existing);
    (void)solve({"--rate", "1", "--metrics", path("m.json")}, "class.json");
    return nlohmann::json::parse(content("m.json"));
  }
};

TEST_F(SolveRecorded, GrossMistakesAreNamedAndDoNotAlign) {
  const fs::path datasets = datasets_dir();
  if (!fs::exists(datasets)) FATHOM_DATA_IS_MISSING(datasets << " is not there");
  for (const Recorded& one : recorded()) {
    const dataset::Dataset data = dataset::read(datasets / one.folder);
    EXPECT_EQ(solved(data, one.of_class)["refused_to_align"], nlohmann::json::array()) << one.folder;
    for (const Sabotage& sabotage : sabotages()) {
      const auto expected = one.said.find(sabotage.name);
      if (expected == one.said.end()) continue;
      dataset::Dataset wrong = data;
      sabotage.commit(wrong);
      const auto metrics = solved(wrong, one.of_class);
      const std::string where = std::string(one.folder) + ", " + sabotage.name;
      EXPECT_NE(metrics["alignment"], "aligned") << where;
      EXPECT_EQ(metrics["ever_aligned"], one.aligns.contains(sabotage.name)) << where;
      ASSERT_GE(metrics["refused_to_align"].size(), 1U) << where;
      for (const auto& found : metrics["refused_to_align"])
        EXPECT_TRUE(expected->second.contains(found["sensor"].get<std::string>() + " " +
                                              found["kind"].get<std::string>()))
            << where << ": " << found["text"];
    }
  }
}

// An aircraft in the middle of aerobatics whose inertial unit is silent: where down is cannot be told behind
// it. With roll and pitch in doubt by 38 degrees the attitude is found again within ten seconds or within
// forty; a single inertial sample decides which.
TEST_F(SolveRecorded, ATimeWithoutInertialSamplesIsLivedThrough) {
  const fs::path datasets = datasets_dir();
  if (!fs::exists(datasets)) FATHOM_DATA_IS_MISSING(datasets << " is not there");
  const dataset::Dataset whole = dataset::read(datasets / "thor75");
  const TimeNs begin_ns = whole.of<ImuSample>().front().header.stamp_ns;
  int longer = 0;
  for (const double at_s : {240.0, 240.3, 480.0, 480.3}) {
    for (const double gap_s : {6.0, 8.0, 9.5}) {
      dataset::Dataset data = whole;
      std::erase_if(data.of<ImuSample>(), [&](const ImuSample& sample) {
        const double t_s = to_seconds(sample.header.stamp_ns - begin_ns);
        return t_s > at_s && t_s < at_s + gap_s;
      });
      const auto metrics = solved(data, "mems_fixed_wing");
      // At most a twentieth of the flight is off by more, in two of the twelve runs more of it.
      const double p95_m = metrics["horizontal_error_m"]["p95"];
      if (p95_m > 10.0) ++longer;
      EXPECT_LT(p95_m, 50.0) << gap_s << " s at " << at_s;
      EXPECT_LT(metrics["horizontal_error_m"]["end"], 3.0) << gap_s << " s at " << at_s;
    }
  }
  EXPECT_LE(longer, 2);
}

}  // namespace
}  // namespace fathom::test
