#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "explain/around.hpp"

/// What was found, for people and for programs.
namespace fathom::explain {

/// What is asked.
struct Question {
  std::optional<TimeNs> at_ns{};       ///< only what was under way around an instant, and what was used then
  std::optional<std::string> alarm{};  ///< only what led to alarms of this name, or of what stands before ':'
};

/// Whether an alarm is asked for by this name, or by what stands before ':' in its own.
[[nodiscard]] bool is_of(const Alarm& alarm, const std::string& asked);

struct Answer {
  Findings findings;                    ///< all of them
  std::vector<std::size_t> roots;       ///< those to tell, most likely cause first
  std::vector<const AlarmRow*> alarms;  ///< raised ones, as asked
  std::vector<Around> instants;         ///< of --at, and of each alarm that was asked for
};

[[nodiscard]] Answer answer(const History& history, const Question& question);

/// The first line says the most likely cause; then evidence, what followed, what to do; then alarms and what
/// was used at the instants asked for. Times are UTC and seconds since the begin of the history.
[[nodiscard]] std::string account(const History& history, const Answer& answer);
[[nodiscard]] nlohmann::ordered_json to_json(const History& history, const Answer& answer);

}  // namespace fathom::explain
