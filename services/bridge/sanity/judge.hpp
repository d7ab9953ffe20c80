#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "bridge/sanity.hpp"

namespace fathom::bridge {

/// Why a sample is not published; nothing: it is.
using Judgement = std::optional<Refused>;
using Limits = config::SampleLimits;

/// Asks the values of a sample one after the other. What is found first is the verdict.
class Judge {
 public:
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  /// One value, or those of an array.
  struct Values {
    Values(const double& value) : all(&value, 1) {}  // NOLINT(google-explicit-constructor)
    template <std::size_t N>
    Values(const std::array<double, N>& values) : all(values) {}  // NOLINT(google-explicit-constructor)
    std::span<const double> all;
  };

  /// Numbers: neither unknown nor infinite.
  Judge& numbers(std::string_view field, const Values& values);
  /// Not infinite. They may be unknown.
  Judge& finite(std::string_view field, const Values& values);
  /// From `least` to `most`. What is unknown breaks no limit.
  Judge& within(std::string_view field, const Values& values, double least, double most);
  /// Of either sign. What is unknown breaks no limit.
  Judge& at_most(std::string_view field, const Values& values, double most) {
    return within(field, values, -most, most);
  }
  Judge& not_negative(std::string_view field, const Values& values) {
    return within(field, values, 0.0, kNoLimit);
  }
  /// What is unknown breaks no limit.
  Judge& positive(std::string_view field, double value);

  [[nodiscard]] const Judgement& verdict() const { return verdict_; }

 private:
  void refuse(Refusal why, std::string_view field, const Values& values, std::size_t index, double least,
              double most);

  Judgement verdict_;
};

/// Of each kind in a file of its own.
template <class Sample>
[[nodiscard]] Judgement judge(const Sample& sample, const Limits& limits);

}  // namespace fathom::bridge
