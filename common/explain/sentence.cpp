#include "explain/sentence.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "health/text.hpp"
#include "samples/alignment/help.hpp"
#include "samples/kinds.hpp"

namespace fathom::explain {
namespace {

std::string degrees(double rad) {
  return brief(rad * 180.0 / std::numbers::pi) + " deg";
}

std::string signed_time(double s) {
  return std::string(s > 0.0 ? "forward" : "back") + " by " + lasting(std::abs(s));
}

/// The innovation of a kind in its unit.
std::string in_unit(const Finding& f, double value) {
  if (f.word == "heading") return degrees(value);
  if (f.word == "dvl" || f.word == "airspeed") return brief(value) + " m/s";
  return brief(value) + " m";
}

/// Positions, of whatever instrument.
const std::string kFixes = "fixes";
std::string fixes(double count) {
  return counted(count, kFixes.substr(0, 3), kFixes);
}

std::string measurements(const Finding& f, double count) {
  if (f.word == "gps" || f.word == "usbl") return fixes(count);
  return counted(count, "measurement", "measurements");
}

std::string support(const Finding& f) {
  // What follows from another thing accuses nobody.
  if (f.follows_from) return "";
  if (f.agreeing.empty()) return " Nothing else was there to tell which of the two is wrong.";
  std::string who;
  for (const Agreeing& one : f.agreeing) who += (who.empty() ? "" : ", ") + one.sensor;
  return " Meanwhile these agreed with navigation: " + who + ".";
}

std::string who_is_wrong(const Finding& f) {
  if (!f.follows_from && !f.agreeing.empty())
    return support(f) + " So " + f.subject + " is the likelier wrong one.";
  return support(f);
}

/// Navigation's heading held against the course over ground.
std::string wrong_course(const Finding& f) {
  const std::string who = f.word == "course_compass"
                              ? "Compass " + f.subject + ", and navigation's heading with it, is"
                              : "Navigation's heading is";
  return who + " off by " + degrees(f.figure("first")) + ": for " + lasting(f.figure("for_s")) +
         ", on courses up to " + degrees(f.figure("courses_apart")) +
         " apart, GPS had the vehicle go another way than the DVL with that heading, at the same speed. A "
         "DVL "
         "that is mounted otherwise than configured would look the same.";
}

std::string disagreement(const Finding& f) {
  std::string text;
  if (f.kind == Kind::jump) {
    text = f.subject + " jumped: from one " +
           (f.word == "gps" || f.word == "usbl" ? kFixes.substr(0, 3) : "measurement") +
           " to the next it stood " + in_unit(f, f.figure("first")) + " aside of navigation (sigma of that " +
           in_unit(f, f.figure("first_sigma")) + ")";
  } else {
    text = f.subject + " walked away from navigation, " + in_unit(f, f.figure("first")) +
           " when it was first refused and up to " + in_unit(f, f.figure("most"));
    if (known(f.figure("velocity_m_s")))
      text += ", its velocity up to " + brief(f.figure("velocity_m_s")) + " m/s apart";
  }
  text += ". " + measurements(f, f.figure("count")) + " of " + lasting(f.figure("for_s")) + " were refused";
  if (f.figure("disputed") > 0.0) text += ", in the end as disputed";
  return text + "." + who_is_wrong(f);
}

std::string lost(const Finding& f) {
  std::string text;
  const std::string time = lasting(f.figure("for_s"));
  if (f.word == "silent") {
    text = f.subject + " fell silent for " + time;
    if (!f.said.empty()) text += " (" + f.said + ")";
    if (known(f.figure("afterwards")))
      text +=
          " (" + counted(f.figure("afterwards"), "measurement", "measurements") + " of it came afterwards)";
  } else if (f.word == "no_fix") {
    text = f.subject + " had no fix for " + time;
  } else if (f.word == "out_of_range") {
    text = f.subject + " talked on without a usable value for " + time +
           (static_cast<SourceKind>(static_cast<int>(f.figure("kind"))) == SourceKind::dvl
                ? " (no lock on the bottom)"
                : "");
  } else if (f.word == "not_judged") {
    text = f.subject + " went on for " + time + ", and fusion judged none of its measurements";
  } else if (f.word == "source_disabled") {
    text = f.subject + " was switched off for " + time;
  } else {
    text = "Nothing of " + f.subject + " was used for " + time + ", most of it as " + f.word;
  }
  if (known(f.figure("depth_m")))
    text += ", while the vehicle was under water at " + brief(f.figure("depth_m")) + " m";
  if (f.figure("to_end") > 0.0) text += ", up to the end";
  if (known(f.figure("sigma_before_m"))) {
    text += "; the horizontal sigma went from " + brief(f.figure("sigma_before_m")) + " to " +
            brief(f.figure("sigma_after_m")) + " m";
  }
  return text + ".";
}

std::string refused(const Finding& f) {
  const std::string head =
      f.subject + ": " + brief(f.figure("count")) + " of " + brief(f.figure("of")) + " measurements ";
  if (f.word == "late") return head + "came too late to be used.";
  if (f.word == "duplicate") return head + "came twice.";
  if (f.figure("imu_silent") > 0.0)
    return head + "could not be used: the inertial samples that they wait for were silent.";
  if (f.word == "from_the_future")
    return head + "were stamped ahead of the inertial samples by more than clocks may differ.";
  if (f.word == "unknown_frame") return head + "were in a frame that is not configured.";
  return head + "were refused as " + f.word + ".";
}

std::string imu_gap(const Finding& f) {
  if (f.word == "silent") {
    const std::string at = to_iso8601(f.begin_ns, 1);
    return f.subject + " fell silent at " + at.substr(at.find('T') + 1) +
           (f.figure("to_end") > 0.0 ? " and stays so, " + lasting(f.figure("for_s")) + " up to the end"
                                     : " for " + lasting(f.figure("for_s"))) +
           (f.said.empty() ? "" : ". " + f.said) + ".";
  }
  return "Inertial samples of " + f.subject + " are missing " + counted(f.figure("gaps"), "time", "times") +
         ", at most " + brief(f.figure("longest_s")) + " s; usual is a step of " +
         brief(1e3 * f.figure("step_s")) + " ms.";
}

std::string not_aligned(const Finding& f) {
  std::string text;
  const std::string time = lasting(f.figure("for_s"));
  if (f.word == "lost") text = "Navigation aligned itself anew and was without attitude for " + time;
  if (f.word == "no_state") text = "No navigation state was given in " + time;
  if (f.word == "never") text = "Navigation was not aligned in " + time;
  if (f.word == "slow") text = "Alignment took " + time;
  for (const Evidence& one : f.evidence)
    if (one.topic == "fathom/v1/alignment") text += (&one == f.evidence.data() ? ": " : ". ") + one.what;
  while (text.ends_with('.')) text.pop_back();
  if (f.figure("waiting") > 0.0)
    text += ". " + counted(f.figure("waiting"), "measurement", "measurements") +
            " could not be used for want of it";
  return text + ".";
}

std::string wrong_lever(const Finding& f) {
  const auto way = [](double value, const char* plus, const char* minus) {
    return brief(std::abs(value)) + " m " + (value < 0.0 ? minus : plus);
  };
  std::string text = "The antenna of " + f.subject +
                     " is not where the configuration has it: its innovations turn "
                     "with the vehicle, as if it stood at least " +
                     way(f.figure("forward_m"), "further forward", "further aft") + " and " +
                     way(f.figure("right_m"), "further right", "further left") + " (+- " +
                     brief(f.figure("sigma_m")) + " m, by " + fixes(f.figure("fixes")) +
                     "; navigation takes a part of it for its own error).";
  const double speed_m_s = f.figure("speed_m_s");
  if (speed_m_s > 0.5)
    text += " Stamps that are " + brief(std::abs(f.figure("forward_m")) / speed_m_s) + " s or more too " +
            (f.figure("forward_m") < 0.0 ? "late" : "early") + " would look the same.";
  return text;
}

}  // namespace

std::string brief(double value) {
  if (!std::isfinite(value)) return "unknown";
  std::array<char, 32> text{};
  const double size = std::abs(value);
  const bool whole = size >= 100.0 || value == std::round(value);
  std::snprintf(text.data(), text.size(), whole ? "%.0f" : size >= 10.0 ? "%.1f" : "%.2f", value);
  return text.data();
}

std::string lasting(double seconds) {
  return health::duration_text(seconds);
}

std::string counted(double count, const std::string& one, const std::string& many) {
  return brief(count) + " " + (count == 1.0 ? one : many);
}

std::string sentence(const Finding& f) {
  switch (f.kind) {
    case Kind::clock_set:
      return "The clock of host " + f.subject + " was set " + signed_time(f.figure("step_s")) +
             ". Stamps are not moved by it.";
    case Kind::clock_jump:
      return "The clock of " + f.subject + " jumped " + signed_time(f.figure("step_s")) +
             ": its stamps were " + brief(f.figure("age_before_s")) + " s old when they arrived, and " +
             brief(f.figure("age_after_s")) + " s afterwards, while the arrival went on as before.";
    case Kind::second_writer:
      return brief(f.figure("writers")) + " processes publish as " + f.subject + " at once, in " +
             counted(f.figure("seconds"), "second", "seconds") + ": " + f.word + ".";
    case Kind::takeover:
      return f.subject + " took over the navigation state from " + f.word + ", which had been silent for " +
             brief(f.figure("silence_s")) + " s.";
    case Kind::restart:
      return f.subject + " was started again; its life signs were missing for " +
             lasting(f.figure("silence_s")) +
             (known(f.figure("state_silence_s"))
                  ? ", the navigation state for " + brief(f.figure("state_silence_s")) + " s"
                  : "") +
             (f.word == "resumed" ? ". It went on from a state that it had kept."
              : f.word == "anew"  ? ". It began anew, without a state of before."
                                  : ".");
    case Kind::stalled:
      return f.subject + " gave no life sign for " + lasting(f.figure("silence_s")) +
             (f.figure("to_end") > 0.0 ? ", up to the end: it died, or its host went."
                                       : " and then went on as the same process: it stood still, or the "
                                         "network between did.");
    case Kind::imu_late:
      return "Inertial samples of " + f.subject + " arrived " + brief(f.figure("age_s")) +
             " s after their instant, usual are " + brief(f.figure("usual_s")) +
             " s: the navigation state was late by as much, and aiding waited for them.";
    case Kind::imu_gap:
      return imu_gap(f);
    case Kind::not_aligned:
    case Kind::alignment_lost:
      return not_aligned(f);
    case Kind::wrong_heading:
      if (f.word.starts_with("course")) return wrong_course(f);
      if (f.word.starts_with("start"))
        return (f.word == "start" ? "The heading that navigation started with" : "Compass " + f.subject) +
               " was wrong at the start by " + degrees(f.figure("first")) +
               ", as the way by GPS shows; navigation corrected that after " + lasting(f.figure("for_s")) +
               ".";
      return "Compass " + f.subject + " disagrees with navigation by " + degrees(f.figure("first")) + ": " +
             counted(f.figure("count"), "heading", "headings") + " of " + lasting(f.figure("for_s")) +
             " were refused." + who_is_wrong(f);
    case Kind::interference:
      return "Receiver " + f.subject + " says itself that it is " + f.word + ", with " +
             fixes(f.figure("count")) + ".";
    case Kind::frozen:
      return f.subject + " froze: " + measurements(f, f.figure("count")) + " repeat one value for " +
             lasting(f.figure("for_s")) + ", while the vehicle went " + brief(f.figure("path_m")) +
             " m. They were refused.";
    case Kind::jump:
    case Kind::drag:
      return disagreement(f);
    case Kind::outliers:
      return f.subject + " gives outliers: " + brief(f.figure("count")) + " of " + brief(f.figure("of")) +
             " measurements lay beyond the gate, up to " + in_unit(f, f.figure("most")) +
             ", among good ones; " + brief(f.figure("refused")) +
             " of them were refused, the others had little weight.";
    case Kind::noisy:
      if (is_inertial(f.subject))
        return "For " + lasting(f.figure("for_s")) + " the motion strayed as if the noise of the " +
               f.subject + " were up to " + brief(f.figure("factor")) +
               " times what is configured; navigation counted with that.";
      return f.subject + " scattered for " + lasting(f.figure("for_s")) + " up to " +
             brief(f.figure("factor")) + " times as much as its sigmas say; navigation counted with that.";
    case Kind::biased:
      return "The bias of " + f.subject + " is " + brief(f.figure("bias")) + " " + f.word +
             ", and a sigma of " + brief(f.figure("configured_sigma")) + " " + f.word +
             " is configured; navigation counted with the bias.";
    case Kind::wrong_lever:
      return wrong_lever(f);
    case Kind::lost:
      return lost(f);
    case Kind::refused:
      return refused(f);
    case Kind::state_gap:
      return "The navigation state was silent for " + brief(f.figure("for_s")) + " s" +
             (f.figure("to_end") > 0.0 ? ", up to the end." : ".");
    case Kind::reset:
      return "The position stepped by " + brief(f.figure("step_m")) +
             " m without motion: navigation was put right at once. Its sigma before was " +
             brief(f.figure("sigma_before_m")) + " m.";
    case Kind::growth:
      return "The horizontal sigma grew from " + brief(f.figure("sigma_before_m")) + " to " +
             brief(f.figure("sigma_after_m")) + " m in " + lasting(f.figure("for_s")) +
             (f.word.empty() ? "." : "; missing were " + f.word + ".");
  }
  return "?";
}

std::string advice(const Finding& f) {
  switch (f.kind) {
    case Kind::clock_set:
      return "Look at the time service of the host.";
    case Kind::clock_jump:
      return "Look at how the instrument gets its time.";
    case Kind::second_writer:
      return "End the one that does not belong there; fathom doctor names it.";
    case Kind::takeover:
    case Kind::restart:
    case Kind::stalled:
      return "Look at the log of " + (f.kind == Kind::takeover ? f.word : f.subject) + " just before.";
    case Kind::imu_late:
    case Kind::imu_gap:
      if (!f.said.empty()) return "Look at what the bridge says: the port, its cable and the unit behind it.";
      return "Look at the cable, the bridge and the load of the machine.";
    case Kind::wrong_heading:
      return "Look at currents and iron near the compass, at its calibration and at its variation.";
    case Kind::wrong_lever:
      return "Measure lever_B_m of the antenna again; fathom commission fits it.";
    case Kind::frozen:
      return "Look at the instrument and its link.";
    case Kind::drag:
    case Kind::jump:
      return f.word == "gps"
                 ? "Do not believe the receiver before its position was checked; it can be switched off by "
                   "an order."
                 : "Look at the instrument, at its mounting and at what the configuration has of it.";
    case Kind::outliers:
      return f.word == "usbl" ? "Multipath: look at the geometry, at noise and at the transponder's depth."
                              : "Look at the instrument and at what lies in its way.";
    case Kind::noisy:
      if (is_inertial(f.subject))
        return "Look at the inertial unit and at what shakes it, at the time stamps of what aids it, or "
               "at its noise in the configuration.";
      return "Look at the instrument and at what disturbs it, or at its sigma in the configuration.";
    case Kind::biased:
      return "Look at the inertial unit, or at the sigma of its bias in the configuration.";
    case Kind::interference:
      return "Do not believe the receiver; look at transmitters near its antenna.";
    case Kind::lost:
      if (f.word == "no_fix") return "Look at the antenna, its cable and the sky above it.";
      if (f.word == "out_of_range") return "Look at the instrument's range and at what it looks at.";
      if (f.word == "silent")
        return "Look at the instrument, its link and its bridge; fathom doctor tells which is there.";
      return "";
    case Kind::refused:
      if (f.figure("imu_silent") > 0.0) return "";
      if (f.word == "late") return "Look at the link's delay, or raise horizon_s of the fusion service.";
      if (f.word == "unknown_frame") return "Look at the instrument's frame and at its configuration.";
      return "Look at the instrument's clock and its bridge.";
    case Kind::not_aligned:
      return "Do what alignment asks for, or give a position and a heading by order.";
    default:
      return "";
  }
}

}  // namespace fathom::explain
