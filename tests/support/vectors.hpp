#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/paths.hpp"

namespace fathom::test {

/// Numerical vectors by name; an empty object when tests/vectors lacks the file.
inline nlohmann::json load_vectors() {
  std::ifstream in(vectors_dir() + "/strapdown_and_aiding.json");
  nlohmann::json by_name = nlohmann::json::object();
  if (!in) return by_name;
  const nlohmann::json all = nlohmann::json::parse(in);
  for (const auto& one : all.at("vectors")) by_name[one.at("name").get<std::string>()] = one;
  return by_name;
}

inline Eigen::Vector3d vector3(const nlohmann::json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

inline Eigen::MatrixXd matrix(const nlohmann::json& j) {
  Eigen::MatrixXd m(j.size(), j.at(0).size());
  for (std::size_t r = 0; r < j.size(); ++r)
    for (std::size_t c = 0; c < j.at(r).size(); ++c)
      m(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = j.at(r).at(c).get<double>();
  return m;
}

/// Largest difference over the largest value expected.
inline double relative_error(const Eigen::MatrixXd& actual, const Eigen::MatrixXd& expected) {
  return (actual - expected).cwiseAbs().maxCoeff() / std::max(expected.cwiseAbs().maxCoeff(), 1e-300);
}

inline double relative_error(double actual, double expected) {
  return std::abs(actual - expected) / std::max(std::abs(expected), 1e-300);
}

/// A test that needs the vectors.
class VectorsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    vectors_ = load_vectors();
    ASSERT_FALSE(vectors_.empty()) << "no numerical vectors in " << vectors_dir();
  }
  [[nodiscard]] const nlohmann::json& in(const char* name) const { return vectors_.at(name).at("inputs"); }
  [[nodiscard]] const nlohmann::json& out(const char* name) const { return vectors_.at(name).at("expected"); }

  nlohmann::json vectors_;
};

}  // namespace fathom::test
