#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "config/service_config.hpp"
#include "config/vehicle/vehicle_config.hpp"
#include "support/paths.hpp"

namespace fathom::config {

/// The vehicle that is shipped, to be changed, in a folder of the test's own.
class Vehicle : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("FATHOM_CATALOGUE_DIR", (test::source_dir() + "/deploy/config/catalogue").c_str(), 1);
    std::ifstream in(test::source_dir() + "/deploy/config/vehicle.json");
    file = nlohmann::json::parse(in);
    folder = std::filesystem::path(::testing::TempDir()) /
             ("vehicle_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string write(const std::string& name, const nlohmann::json& text) {
    const auto path = (folder / name).string();
    std::ofstream(path) << text.dump(2);
    return path;
  }
  std::string vehicle() { return write("vehicle.json", file); }
  nlohmann::json& instrument(const std::string& name) {
    for (nlohmann::json& one : file["instruments"]) {
      if (one["name"] == name) return one;
    }
    throw std::runtime_error(name);
  }
  template <class Config>
  Config load(const char* service, LoadRequest request = {}) {
    return load_service_config<Config>(with_vehicle(std::move(request), vehicle(), service)).value;
  }
  /// What is said of a file that cannot be used; empty where it can.
  std::string complaint() {
    for (const ConfigKind& kind : config_kinds()) {
      if (kind.name != "vehicle") continue;
      try {
        kind.check({vehicle(), {}});
      } catch (const ConfigError& error) {
        return error.what();
      }
    }
    return "";
  }

  nlohmann::json file;
  std::filesystem::path folder;
};

}  // namespace fathom::config
