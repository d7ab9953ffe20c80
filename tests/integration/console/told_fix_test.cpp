// A position of ten minutes ago, told by hand into a dead-reckoned survey: fusion, console and the command
// line as processes of their own, the survey ten times as fast as on a vehicle.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "base/units.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "console_fixture.hpp"
#include "samples/nav_state.hpp"
#include "samples/verdict.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/temporary_folder.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::test {
namespace {

constexpr std::uint32_t kDomain = 32;
constexpr double kRate = 10.0;

/// A survey whose Doppler log was lost for minutes, on the network.
class FastSurvey {
 public:
  FastSurvey()
      : survey_({.duration_s = 1600.0, .dive_s = 50.0, .seed = 11, .usbl = false}),
        participant_(presence(kDomain, "survey")),
        states_(participant_,
                [this](const NavState& state, const bus::SampleInfo&) {
                  const std::lock_guard lock(mutex_);
                  state_ = state;
                }),
        verdicts_(participant_, [this](const Verdict& verdict, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex_);
          if (verdict.source == SourceKind::fix) told_.push_back(verdict);
        }) {}
  ~FastSurvey() {
    stop_ = true;
    if (feeder_.joinable()) feeder_.join();
  }

  /// At `epoch_ns`, or as soon as may be after it.
  void begin(TimeNs epoch_ns) {
    epoch_ns_ = epoch_ns;
    feeder_ = std::thread([this] { feed(); });
  }
  /// By fusion with each of its readers, and by the console, which reads positions as well.
  [[nodiscard]] bool heard() const {
    return imu_.matched_readers() > 0 && gps_.matched_readers() > 1 && dvl_.matched_readers() > 0 &&
           depth_.matched_readers() > 0 && heading_.matched_readers() > 0 && verdicts_.matched_writers() > 0;
  }
  [[nodiscard]] NavState state() const {
    const std::lock_guard lock(mutex_);
    return state_;
  }
  [[nodiscard]] std::vector<Verdict> told() const {
    const std::lock_guard lock(mutex_);
    return told_;
  }
  [[nodiscard]] geo::Geodetic place(double t_s, const Eigen::Vector3d& off_N_m) const {
    const Truth& truth = survey_.truth.at(static_cast<std::size_t>(std::lround(100.0 * t_s)));
    return geo::moved_by({truth.latitude_rad, truth.longitude_rad, truth.altitude_m}, off_N_m);
  }

 private:
  void feed() {
    using Seconds = std::chrono::duration<double>;
    double late_s = to_seconds(SystemClock().utc_ns() - epoch_ns_);
    const auto epoch = std::chrono::steady_clock::now() - Seconds(late_s);
    double before_s = 0.0;
    for (Sample sample : survey_.samples) {
      if (stop_) return;
      SampleHeader& header = std::visit([](auto& one) -> SampleHeader& { return one.header; }, sample);
      const double t_s = to_seconds(header.stamp_ns - SurveyRun::kEpochNs);
      if (std::holds_alternative<DvlSample>(sample) && t_s > 100.0 && t_s < 380.0) continue;
      const double due_s = to_seconds(header.received_ns - SurveyRun::kEpochNs) / kRate;
      late_s = std::max(0.0, late_s - 0.2 * (due_s - before_s));  // caught up with little by little
      before_s = due_s;
      std::this_thread::sleep_until(epoch + Seconds(due_s + late_s));
      header.stamp_ns += epoch_ns_ - SurveyRun::kEpochNs;
      header.received_ns += epoch_ns_ - SurveyRun::kEpochNs;
      write(sample);
    }
  }
  void write(const Sample& sample) {
    if (const auto* imu = std::get_if<ImuSample>(&sample)) (void)imu_.write(*imu);
    if (const auto* gps = std::get_if<GpsSample>(&sample)) (void)gps_.write(*gps);
    if (const auto* dvl = std::get_if<DvlSample>(&sample)) (void)dvl_.write(*dvl);
    if (const auto* depth = std::get_if<DepthSample>(&sample)) (void)depth_.write(*depth);
    if (const auto* heading = std::get_if<HeadingSample>(&sample)) (void)heading_.write(*heading);
  }

  TimeNs epoch_ns_ = 0;
  SurveyRun survey_;
  mutable std::mutex mutex_;
  NavState state_;
  std::vector<Verdict> told_;
  std::atomic<bool> stop_{false};
  bus::Participant participant_;
  bus::Writer<ImuSample> imu_{participant_};
  bus::Writer<GpsSample> gps_{participant_};
  bus::Writer<DvlSample> dvl_{participant_};
  bus::Writer<DepthSample> depth_{participant_};
  bus::Writer<HeadingSample> heading_{participant_};
  bus::Reader<NavState> states_;
  bus::Reader<Verdict> verdicts_;
  std::thread feeder_;
};

double sigma_m(const NavState& state) {
  return std::sqrt(state.position_covariance_N_m2[0] + state.position_covariance_N_m2[4]);
}

class ToldFix : public ConsoleTest {};

TEST_F(ToldFix, OfTenMinutesAgoIsUsedAndAWrongOneIsRefusedByConsoleAndCommandLine) {
  const TemporaryFolder folder;
  FastSurvey survey;
  const TimeNs epoch_ns = SystemClock().utc_ns() + 15 * kNsPerSecond;
  const std::vector<std::string> clock_sets{"clock.rate=" + std::to_string(kRate),
                                            "clock.epoch_ns=" + std::to_string(epoch_ns),
                                            "clock.anchor_file="};
  std::vector<std::string> arguments{"--config", source_dir() + "/deploy/config/fusion.json"};
  std::vector<std::string> sets = clock_sets;
  sets.insert(
      sets.end(),
      {"bus.domain=" + std::to_string(kDomain), "checkpoint.path=" + (folder / "checkpoint"),
       "engine.future_tolerance_s=60", "engine.horizon_s=40",  // a busy machine falls behind the clock
       R"(engine.sensors=[{"sensor":"gps0","kind":"gps","lever_B_m":[-0.3,0,-0.5],"sigma_m":[1,1,1]},)"
       R"({"sensor":"dvl0","kind":"dvl","lever_B_m":[0.4,0.05,0.3],"mounting_rpy_deg":[0,0,0]},)"
       R"({"sensor":"depth0","kind":"depth","lever_B_m":[0,0,0],"sigma_m":[0.03,0.03,0.03]},)"
       R"({"sensor":"compass0","kind":"heading","sigma_deg":[0.6,0.6,0.6]},)"
       R"({"sensor":"operator","kind":"fix"}])"});
  for (const std::string& set : sets) arguments.insert(arguments.end(), {"--set", set});
  Process fusion("fathom-fusion", arguments);
  std::vector<std::string> console_sets = clock_sets;
  console_sets.emplace_back("access.orders=true");
  start(kDomain, console_sets);
  ASSERT_TRUE(wait_until([&] { return !fusion.running() || (survey.heard() && get("/").status == 200); },
                         kPatienceS));
  ASSERT_TRUE(fusion.running()) << fusion.err() << console->err();
  std::this_thread::sleep_for(
      std::chrono::nanoseconds(std::max<TimeNs>(0, epoch_ns - SystemClock().utc_ns())));
  survey.begin(epoch_ns);
  const auto until = [&](double t_s) {
    return wait_until([&] { return to_seconds(survey.state().header.stamp_ns - epoch_ns) >= t_s; },
                      t_s / kRate + kPatienceS);
  };

  // By the command line: 1 km off, then right.
  ASSERT_TRUE(until(990.0));
  const double then_s = 390.0;
  const auto tell = [&](const Eigen::Vector3d& off_N_m) {
    const geo::Geodetic place = survey.place(then_s, off_N_m);
    return std::make_unique<Process>(
        "fathom", std::vector<std::string>{
                      "fix", "--domain", std::to_string(kDomain), "--profiles", source_dir() + "/deploy/dds",
                      "--lat", std::to_string(kDegPerRad * place.latitude_rad), "--lon",
                      std::to_string(kDegPerRad * place.longitude_rad), "--sigma", "10", "--time",
                      to_iso8601(epoch_ns + from_seconds(then_s)), "--timeout", "60", "--json"});
  };
  const auto wrong = tell({0.0, 1000.0, 0.0});
  EXPECT_EQ(wrong->wait(), 1) << wrong->err();
  const auto refused = nlohmann::json::parse(wrong->out());
  ASSERT_EQ(refused.at("verdict"), "rejected") << wrong->out() << fusion.err();
  EXPECT_NEAR(refused.at("east_m").get<double>(), -1000.0, 100.0);
  EXPECT_FALSE(refused.at("reason").get<std::string>().empty());
  const NavState before = survey.state();
  const auto right = tell({3.0, -2.0, 0.0});
  EXPECT_EQ(right->wait(), 0) << right->err() << right->out();
  EXPECT_EQ(nlohmann::json::parse(right->out()).at("verdict"), "used");
  ASSERT_TRUE(wait_until([&] { return sigma_m(survey.state()) < 0.8 * sigma_m(before); }, kPatienceS))
      << sigma_m(before) << " " << sigma_m(survey.state());

  // By the console, of another instant. The console counts back from the clock; a busy fusion is behind it.
  const double now_s = kRate * to_seconds(SystemClock().utc_ns() - epoch_ns);
  const geo::Geodetic place = survey.place(now_s - 120.0, Eigen::Vector3d::Zero());
  nlohmann::json order{{"kind", "fix"},
                       {"lat_deg", kDegPerRad * place.latitude_rad},
                       {"lon_deg", kDegPerRad * place.longitude_rad},
                       {"sigma_m", 10.0},
                       {"age_s", 120.0}};
  EXPECT_EQ(this->order(order, kViewerToken).status, 403);
  const HttpAnswer answer = this->order(order, kOperatorToken);
  EXPECT_LT(answer.status, 300) << answer.body;
  ASSERT_TRUE(wait_until([&] { return survey.told().size() >= 3; }, kPatienceS));
  const Verdict by_console = survey.told()[2];
  EXPECT_EQ(by_console.kind, VerdictKind::used)
      << now_s - to_seconds(by_console.header.stamp_ns - epoch_ns) << " s ago, off by "
      << by_console.innovation[0] << " m and " << by_console.innovation[1] << " m";
  order["lat_deg"] = kDegPerRad * place.latitude_rad + 0.01;
  EXPECT_LT(this->order(order, kOperatorToken).status, 300);
  EXPECT_TRUE(wait_until(
      [&] {
        const auto told = survey.told();
        return std::any_of(told.begin(), told.end(), [](const Verdict& one) {
          return one.kind == VerdictKind::rejected && std::abs(one.innovation[0]) > 1000.0;
        });
      },
      kPatienceS));
  order["from"] = "nobody";
  EXPECT_TRUE(wait_until([&] { return this->order(order, kOperatorToken).status == 409; }, kPatienceS))
      << "navigation knows no such source";
  fusion.kill(SIGTERM);
  EXPECT_EQ(fusion.wait(), 0) << fusion.err();
}

}  // namespace
}  // namespace fathom::test
