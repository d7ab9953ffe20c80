#pragma once

#include <string>

#include "explain/finding.hpp"

/// The one place where findings become English.
namespace fathom::explain {

/// What was found, with its figures: one to three sentences, without the instant.
[[nodiscard]] std::string sentence(const Finding& finding);

/// What to do about it, one sentence; empty where there is nothing to do.
[[nodiscard]] std::string advice(const Finding& finding);

/// A number for people, three digits.
[[nodiscard]] std::string brief(double value);
/// A time for people, "12.3 s" or "4 min 05 s".
[[nodiscard]] std::string lasting(double seconds);
/// "1 fix", "3 fixes".
[[nodiscard]] std::string counted(double count, const std::string& one, const std::string& many);

}  // namespace fathom::explain
