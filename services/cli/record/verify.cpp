#include "cli/record/verify.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "archive/checkpoint.hpp"
#include "bus/cdr.hpp"
#include "cli/command.hpp"
#include "cli/record/proof.hpp"
#include "cli/recording.hpp"
#include "runtime/build_info.hpp"
#include "samples/status/health.hpp"

namespace fathom::cli {
namespace {

/// A run of a fusion service: all that one process said.
struct Run {
  std::string service;
  bool from_its_begin = false;
  std::string why_not;           ///< from its begin
  std::vector<TimeNs> inertial;  ///< stamps of what it took
  std::unique_ptr<Proof> proof;
  std::string from;      ///< where it begins, for people
  std::string no_proof;  ///< why there is none
};

/// The part of a writer's identity that is its process'.
std::string process_of(const record::Channel& channel) {
  const auto guid = channel.metadata.find("writer_guid");
  return guid == channel.metadata.end() ? "" : guid->second.substr(0, 24);
}

struct File {
  std::string name;
  record::Reader reader;
};

class Verification {
 public:
  explicit Verification(const std::vector<std::string>& files) : name_(files.front()) {
    for (const std::string& file : files) files_.push_back({file, open_recording(file)});
  }

  ExitCode run() {
    for (File& file : files_) find_runs(file);
    for (auto& [process, run] : runs_) begin(run);
    if (runs_.empty()) {
      throw Failure(ExitCode::bad_input,
                    name_ + ": no fusion service says in it what it took (fathom/v1/intake)");
    }
    record::Selection selection;
    for_each_kind([&](auto kind) { selection.topics.emplace_back(kind.kTopic); });
    for (const char* topic :
         {"fathom/v1/command", "fathom/v1/intake", "fathom/v1/nav_state", "fathom/v1/verdict"})
      selection.topics.emplace_back(topic);
    record::Outcome all;
    for (File& file : files_) {
      const record::Outcome outcome =
          file.reader.read(selection, [&](const record::Channel& channel, const record::Message& message) {
            take(channel, message);
            return true;
          });
      all.problems.insert(all.problems.end(), outcome.problems.begin(), outcome.problems.end());
    }
    return answer(all);
  }

 private:
  void find_runs(File& file) {
    file.reader.read({{"fathom/v1/intake"}},
                     [&](const record::Channel& channel, const record::Message& message) {
                       const auto intake = bus::from_cdr<IntakeRecord>(message.data);
                       if (intake) look(runs_[process_of(channel)], *intake);
                       return true;
                     });
    file.reader.read({{"fathom/v1/service_status"}},
                     [&](const record::Channel& channel, const record::Message& message) {
                       const auto status = bus::from_cdr<ServiceStatus>(message.data);
                       if (status && runs_.contains(process_of(channel))) {
                         versions_.insert(status->version);
                         hashes_[status->header.sensor.str()].insert(status->config_hash);
                       }
                       return true;
                     });
  }

  static void look(Run& run, const IntakeRecord& intake) {
    if (run.service.empty()) {
      run.service = intake.header.sensor.str();
      run.from_its_begin = !intake.resumed && intake.first == 0;
      run.why_not = intake.resumed ? "it went on from a state of another run"
                                   : "it had taken " + std::to_string(intake.first) +
                                         " samples before the recording began";
    }
    for (const IntakeEntry& entry : intake.entries) {
      if (!entry.is_order && entry.source == SourceKind::imu) run.inertial.push_back(entry.stamp_ns);
    }
  }

  /// From its begin, or from the first checkpoint of its own that is in the recording.
  void begin(Run& run) {
    run.no_proof = run.why_not + ", and no checkpoint of it is in the recording";
    for (File& file : files_) {
      if (!file.reader.attachment("services/" + run.service + "/config.json")) continue;
      const auto loaded = recorded_configuration(file.reader, file.name, run.service);
      own_hashes_[run.service] = loaded.hash;
      if (run.from_its_begin) {
        run.proof = std::make_unique<Proof>(loaded.value);
        return;
      }
      for (const record::AttachmentIndex& index : file.reader.contents().attachments) {
        if (index.name != "services/" + run.service + "/checkpoint") continue;
        const auto bytes = file.reader.attachment(index);
        if (!bytes) continue;
        const auto checkpoint = archive::decode(std::as_bytes(std::span(bytes.value())));
        if (!checkpoint) continue;
        const TimeNs stamp_ns = checkpoint.value().label.stamp_ns;
        if (std::find(run.inertial.begin(), run.inertial.end(), stamp_ns) == run.inertial.end()) continue;
        run.proof = std::make_unique<Proof>(loaded.value, checkpoint.value().archive);
        run.from = ", from its checkpoint of " + to_iso8601(stamp_ns) + " on";
        return;
      }
    }
    if (run.from_its_begin) {
      throw Failure(ExitCode::bad_input, name_ + ": the configuration of " + run.service +
                                             " is not in the recording, expected services/" + run.service +
                                             "/config.json");
    }
  }

  void take(const record::Channel& channel, const record::Message& message) {
    const auto own = runs_.find(process_of(channel));
    Proof* proof = own == runs_.end() ? nullptr : own->second.proof.get();
    if (channel.topic == "fathom/v1/intake") {
      const auto intake = bus::from_cdr<IntakeRecord>(message.data);
      if (proof == nullptr || !intake) return;
      if (intake->resumed && own->second.from_its_begin) {
        own->second.no_proof = "it took up a state of another fusion";
        own->second.proof.reset();
      } else {
        proof->add(*intake);
      }
    } else if (channel.topic == "fathom/v1/nav_state") {
      if (const auto state = bus::from_cdr<NavState>(message.data); proof != nullptr && state)
        proof->add(*state);
    } else if (channel.topic == "fathom/v1/verdict") {
      if (const auto verdict = bus::from_cdr<Verdict>(message.data); proof != nullptr && verdict)
        proof->add(*verdict);
    } else if (channel.topic == "fathom/v1/command") {
      if (const auto order = bus::from_cdr<Command>(message.data)) to_all(*order);
    } else {
      for_each_kind([&](auto kind) {
        if (channel.topic != kind.kTopic) return;
        const auto sample = bus::from_cdr<typename decltype(kind)::Sample>(message.data);
        if (sample) to_all(AnySample(*sample));
      });
    }
  }
  void to_all(const auto& sample) {
    for (auto& [process, run] : runs_) {
      if (run.proof) run.proof->add(sample);
    }
  }

  /// Why states may differ although nobody changed the recording.
  std::string why(const std::string& service, const record::Outcome& outcome) {
    if (!outcome.problems.empty()) return "the recording is damaged: " + outcome.problems.front();
    for (const File& file : files_) {
      for (const auto& index : file.reader.contents().metadata) {
        if (index.name == "dropped") return "the recorder dropped samples (metadata 'dropped')";
      }
    }
    if (!hashes_[service].empty() && !hashes_[service].contains(own_hashes_[service])) {
      return "the configuration that is enclosed (" + own_hashes_[service] + ") is not the one that ran (" +
             *hashes_[service].begin() + ")";
    }
    const std::string own(runtime::version());
    if (!versions_.empty() && !versions_.contains(own))
      return "fusion was of another build (" + *versions_.begin() + "; this is " + own + ")";
    return "a sample or what was said of it is not as it was, or the processor computes otherwise";
  }

  ExitCode answer(const record::Outcome& outcome) {
    ExitCode code = ExitCode::done;
    for (auto& [process, run] : runs_) {
      const std::string who = name_ + ": " + run.service + " (" + process.substr(8, 8) + "): ";
      std::string line;
      if (run.proof) run.proof->finish();
      if (!run.proof) {
        line = "cannot be proved: " + run.no_proof;
      } else if (!run.proof->difference().empty()) {
        line = run.proof->difference() + "; " + why(run.service, outcome) + " (" +
               std::to_string(run.proof->states()) + " states before it are equal)";
      } else {
        line = "equal to the last bit: " + std::to_string(run.proof->states()) + " navigation states and " +
               std::to_string(run.proof->verdicts()) + " verdicts follow from " +
               std::to_string(run.proof->taken()) + " samples and orders" + run.from;
        if (run.proof->unheard() > 0)
          line += "; " + std::to_string(run.proof->unheard()) + " further states are not in the recording";
      }
      if (!run.proof || !run.proof->difference().empty() || run.proof->states() == 0) code = ExitCode::no;
      std::printf("%s%s\n", who.c_str(), line.c_str());
    }
    return code;
  }

  std::string name_;  // of the first file
  std::vector<File> files_;
  std::map<std::string, Run> runs_;  // by process
  std::set<std::string> versions_;
  std::map<std::string, std::set<std::string>> hashes_;
  std::map<std::string, std::string> own_hashes_;
};

}  // namespace

ExitCode verify(const std::vector<std::string>& files) {
  return Verification(files).run();
}

}  // namespace fathom::cli
