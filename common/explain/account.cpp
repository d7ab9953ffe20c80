#include "explain/account.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "explain/sentence.hpp"

namespace fathom::explain {
namespace {

constexpr std::size_t kMostAlarms = 30;  // of a long log the first ones, for people

/// "12:34:56.789 (+120.0 s)"
std::string when(const History& history, TimeNs at_ns) {
  const std::string text = to_iso8601(at_ns, 1);
  return text.substr(text.find('T') + 1) + " (+" + brief(to_seconds(at_ns - history.from_ns())) + " s)";
}

std::string span(const History& history, const Finding& one) {
  std::string text = when(history, one.begin_ns);
  if (one.end_ns - one.begin_ns > kNsPerSecond) text += " to " + when(history, one.end_ns);
  return text;
}

/// A finding in short: its first sentence.
std::string in_short(const Finding& one) {
  const std::string text = sentence(one);
  return text.substr(0, std::min(text.find(". "), text.size() - 1)) + ".";
}

std::string used_text(const Around& then) {
  std::string off;
  std::string used;
  std::string rest;
  for (const SourceThen& one : then.sources) {
    if (one.kind == SourceKind::imu) continue;
    const std::uint64_t all = one.all();
    if (all > 0 && one.counts[static_cast<std::size_t>(VerdictKind::source_disabled)] == all) {
      if ((", " + off + ", ").find(", " + one.sensor + ", ") == std::string::npos)
        off += (off.empty() ? "" : ", ") + one.sensor;
      continue;
    }
    if (one.used() > 0) {
      used += (used.empty() ? "" : ", ") + one.sensor + " (" + std::to_string(one.used()) + " of " +
              std::to_string(all) + ")";
    }
    if (one.used() < all) {
      rest += "\n    " + one.sensor + ": " + std::to_string(all - one.used()) + " of " + std::to_string(all) +
              " not used, most of them as " + std::string(to_string(one.main_reason()));
      if (known(one.worst_sigmas)) rest += ", up to " + brief(one.worst_sigmas) + " sigma off";
      rest += known(one.last_used_s) ? "; the last one used was " + lasting(one.last_used_s) + " before"
                                     : "; none had been used yet";
      rest += ".";
    } else if (all == 0) {
      rest +=
          "\n    " + one.sensor + ": nothing was judged" +
          (known(one.last_used_s) ? "; the last one used was " + lasting(one.last_used_s) + " before" : "") +
          ".";
    }
  }
  return "    In the 10 s before it used " + (used.empty() ? "nothing but inertial samples" : used) + "." +
         rest +
         (off.empty() ? "" : "\n    Not to be used by the configuration, or switched off: " + off + ".") +
         "\n";
}

std::string instant(const History& history, const Around& then) {
  std::string text = "At " + when(history, then.at_ns) + "\n";
  if (then.state == nullptr) {
    text += "    There was no navigation state.\n";
  } else {
    text += "    Navigation was " + std::string(to_string(then.state->mode)) + ", alignment " +
            std::string(to_string(then.state->alignment)) + ", horizontal sigma " +
            brief(then.state->sigma_m) + " m";
    if (then.earlier != nullptr && then.earlier->at_ns < then.state->at_ns && known(then.earlier->sigma_m))
      text += " (" + brief(then.earlier->sigma_m) + " m " +
              lasting(to_seconds(then.state->at_ns - then.earlier->at_ns)) + " earlier)";
    text += ".\n";
  }
  return text + used_text(then);
}

std::string tell(const History& history, const Answer& answer, std::size_t root, bool first) {
  const Finding& one = answer.findings[root];
  std::string text = (first ? "Most likely: " : "Besides: ") + sentence(one) + "\n";
  text += "  when: " + span(history, one) + "\n";
  for (const Evidence& evidence : one.evidence) {
    text += "  seen in: " + evidence.topic + ", " + evidence.what;
    if (evidence.count > 1) text += " (" + std::to_string(evidence.count) + ")";
    text += "\n";
  }
  for (const Finding& effect : answer.findings)
    if (effect.follows_from == root)
      text += "  then: " + span(history, effect) + ": " + sentence(effect) + "\n";
  if (const std::string what = advice(one); !what.empty()) text += "  do: " + what + "\n";
  return text;
}

std::string alarms_text(const History& history, const Answer& answer) {
  if (answer.alarms.empty()) return "";
  std::string text = "Alarms\n";
  std::size_t count = 0;
  for (const AlarmRow* row : answer.alarms) {
    if (++count > kMostAlarms) {
      text += "  and " + std::to_string(answer.alarms.size() - kMostAlarms) + " more\n";
      break;
    }
    text += "  " + when(history, row->log_ns) + " " + row->alarm.alarm.str() + ": " + row->alarm.text + "\n";
    const auto cause = behind(answer.findings, *row);
    text +=
        "    " +
        (cause ? "led to by: " + in_short(answer.findings[*cause]) : "nothing else stands out around it") +
        "\n";
  }
  return text;
}

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json json_of(const Around& then) {
  nlohmann::ordered_json out;
  out["at_ns"] = then.at_ns;
  if (then.state != nullptr) {
    out["mode"] = to_string(then.state->mode);
    out["alignment"] = to_string(then.state->alignment);
    out["horizontal_sigma_m"] = number(then.state->sigma_m);
  }
  out["sources"] = nlohmann::ordered_json::array();
  for (const SourceThen& one : then.sources) {
    nlohmann::ordered_json source{{"sensor", one.sensor},
                                  {"kind", to_string(one.kind)},
                                  {"last_used_s", number(one.last_used_s)},
                                  {"last_heard_s", number(one.last_heard_s)}};
    for (std::size_t i = 0; i < one.counts.size(); ++i)
      if (one.counts[i] > 0)
        source["verdicts"][std::string(to_string(static_cast<VerdictKind>(i)))] = one.counts[i];
    out["sources"].push_back(std::move(source));
  }
  return out;
}

}  // namespace

bool is_of(const Alarm& alarm, const std::string& asked) {
  const std::string name = alarm.alarm.str();
  return name == asked || name.substr(0, name.find(':')) == asked;
}

Answer answer(const History& history, const Question& question) {
  Answer out;
  out.findings = findings(history);
  const bool all = !question.at_ns && !question.alarm;
  std::vector<bool> wanted(out.findings.size(), all);
  for (const AlarmRow& row : history.alarms()) {
    if (!row.alarm.active) continue;
    if (question.alarm && !is_of(row.alarm, *question.alarm)) continue;
    if (question.at_ns && std::abs(row.log_ns - *question.at_ns) > Around::kWindow_ns) continue;
    out.alarms.push_back(&row);
    if (!question.alarm) continue;
    out.instants.push_back(around(history, row.log_ns));
    if (const auto cause = behind(out.findings, row)) wanted[*cause] = true;
  }
  if (question.at_ns) {
    out.instants.push_back(around(history, *question.at_ns));
    for (const std::size_t i : under_way(out.findings, *question.at_ns))
      wanted[out.findings[i].follows_from.value_or(i)] = true;
  }
  for (std::size_t i = 0; i < out.findings.size(); ++i)
    if (wanted[i] && !out.findings[i].follows_from) out.roots.push_back(i);
  return out;
}

std::string account(const History& history, const Answer& answer) {
  std::string text;
  bool first = true;
  for (const std::size_t root : answer.roots) {
    if (!named(answer.findings[root])) continue;
    text += tell(history, answer, root, first);
    first = false;
  }
  if (first) text += "Nothing stands out: all that was refused, lost or late belongs to such a run.\n";
  std::string notes;
  for (const std::size_t root : answer.roots)
    if (!named(answer.findings[root]))
      notes += "  " + span(history, answer.findings[root]) + ": " + sentence(answer.findings[root]) + "\n";
  if (!notes.empty()) text += "What belongs to such a run\n" + notes;
  for (const Around& then : answer.instants) text += instant(history, then);
  text += alarms_text(history, answer);
  if (history.forgotten() > 0)
    text += "The log is longer than is kept at once: this is about what came from " +
            when(history, history.from_ns()) + " on.\n";
  return text;
}

nlohmann::ordered_json to_json(const History& history, const Answer& answer) {
  nlohmann::ordered_json out;
  out["vehicle"] = history.vehicle().str();
  out["from_ns"] = history.from_ns();
  out["to_ns"] = history.to_ns();
  out["summary"] = answer.roots.empty() || !named(answer.findings[answer.roots.front()])
                       ? "Nothing stands out."
                       : sentence(answer.findings[answer.roots.front()]);
  out["roots"] = answer.roots;
  out["findings"] = nlohmann::ordered_json::array();
  for (const Finding& one : answer.findings) {
    nlohmann::ordered_json row{{"kind", to_string(one.kind)}, {"weight", to_string(one.weight)},
                               {"subject", one.subject},      {"begin_ns", one.begin_ns},
                               {"end_ns", one.end_ns},        {"text", sentence(one)},
                               {"advice", advice(one)}};
    row["follows_from"] = one.follows_from ? nlohmann::ordered_json(*one.follows_from) : nullptr;
    row["figures"] = nlohmann::ordered_json::object();
    for (const Figure& figure : one.figures) row["figures"][figure.name] = number(figure.value);
    row["evidence"] = nlohmann::ordered_json::array();
    const auto seen = [&row](const Evidence& evidence) {
      row["evidence"].push_back(
          {{"topic", evidence.topic}, {"count", evidence.count}, {"what", evidence.what}});
    };
    for (const Evidence& evidence : one.evidence) seen(evidence);
    for (const Agreeing& other : one.agreeing)
      seen({"fathom/v1/verdict", other.used, other.sensor + " used meanwhile"});
    out["findings"].push_back(std::move(row));
  }
  out["alarms"] = nlohmann::ordered_json::array();
  for (const AlarmRow* row : answer.alarms) {
    const auto cause = behind(answer.findings, *row);
    out["alarms"].push_back({{"alarm", row->alarm.alarm.str()},
                             {"at_ns", row->log_ns},
                             {"severity", to_string(row->alarm.severity)},
                             {"text", row->alarm.text},
                             {"led_to_by", cause ? nlohmann::ordered_json(*cause) : nullptr}});
  }
  out["instants"] = nlohmann::ordered_json::array();
  for (const Around& then : answer.instants) out["instants"].push_back(json_of(then));
  return out;
}

}  // namespace fathom::explain
