#include "cli/record/verify.hpp"

#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

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
  std::unique_ptr<Proof> proof;
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
                       if (runs_.contains(process_of(channel))) return true;
                       const auto intake = bus::from_cdr<IntakeRecord>(message.data);
                       if (intake) begin(file, runs_[process_of(channel)], *intake);
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

  void begin(File& file, Run& run, const IntakeRecord& intake) {
    run.service = intake.header.sensor.str();
    if (intake.resumed) {
      run.no_proof = "it went on from a state of another run, which is not in the recording";
    } else if (intake.first != 0) {
      run.no_proof = "it had taken " + std::to_string(intake.first) + " samples before the recording began";
    } else {
      const auto loaded = recorded_configuration(file.reader, file.name, run.service);
      own_hashes_[run.service] = loaded.hash;
      run.proof = std::make_unique<Proof>(loaded.value);
    }
  }

  void take(const record::Channel& channel, const record::Message& message) {
    const auto own = runs_.find(process_of(channel));
    Proof* proof = own == runs_.end() ? nullptr : own->second.proof.get();
    if (channel.topic == "fathom/v1/intake") {
      const auto intake = bus::from_cdr<IntakeRecord>(message.data);
      if (proof == nullptr || !intake) return;
      if (intake->resumed) {
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
      const std::string who = name_ + ": " + run.service + " (" + process.substr(0, 8) + "): ";
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
               std::to_string(run.proof->taken()) + " samples and orders";
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
