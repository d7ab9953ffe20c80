#include "config/fusion/hydro_config.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/hydro/vehicles.hpp"
#include "support/paths.hpp"

namespace fathom::config {
namespace {

using estimation::hydro::coefficient_table;
using estimation::hydro::HydroCoefficients;

const std::string kHydro = test::source_dir() + "/deploy/config/hydro/";

std::string error_of_coefficients(const std::string& coefficients) {
  const auto path =
      std::filesystem::temp_directory_path() /
      ("fathom-hydro-config-" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + ".json");
  std::ofstream(path) << R"({"vehicle": "v", "source": "s", "coefficients": {)" << coefficients << "}}";
  std::string error = "no error";
  try {
    static_cast<void>(load_hydro_coefficients(path.string()));
  } catch (const ConfigError& thrown) {
    error = thrown.what();
  }
  std::filesystem::remove(path);
  return error;
}

// The studies' vehicles stand in the code, so that they run without files.
TEST(HydroConfig, ShippedVehiclesAreThoseOfTheStudies) {
  const std::pair<const char*, HydroCoefficients> all[] = {{"remus100.json", study::hydro::remus100()},
                                                           {"air_drop.json", study::hydro::air_dropped()}};
  for (const auto& [file, expected] : all) {
    const HydroCoefficients loaded = load_hydro_coefficients(kHydro + file);
    for (const auto& one : coefficient_table())
      EXPECT_EQ(loaded.*one.member, expected.*one.member) << file << " " << one.name;
  }
}

TEST(HydroConfig, SaysWhatIsWrongWithAVehicle) {
  using testing::HasSubstr;
  EXPECT_THAT(error_of_coefficients(R"("X_uuu": {"value": 1, "unit": "kg/m"})"), HasSubstr("X_uuu"));
  EXPECT_THAT(error_of_coefficients(R"("X_uuu": {"value": 1, "unit": "kg/m"})"),
              HasSubstr("expected one of weight"));
  EXPECT_THAT(error_of_coefficients(R"("X_uu": {"value": -1.6, "unit": "N"})"),
              HasSubstr("expected \"kg/m\""));
  EXPECT_THAT(error_of_coefficients(R"("X_uu": {"value": 1.6, "unit": "kg/m"})"),
              HasSubstr("drag takes energy"));
  EXPECT_THAT(error_of_coefficients(R"("X_uu": {"value": -1.6})"), HasSubstr("unit"));
  EXPECT_THAT(error_of_coefficients(""), testing::Not(testing::Eq("no error")));
}

}  // namespace
}  // namespace fathom::config
