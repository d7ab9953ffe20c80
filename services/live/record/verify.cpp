#include "live/record/verify.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "archive/checkpoint.hpp"
#include "bus/cdr.hpp"
#include "cli/command.hpp"
#include "cli/recording.hpp"
#include "live/record/proof.hpp"
#include "live/record/spans.hpp"
#include "live/record/state_pool.hpp"
#include "runtime/build_info.hpp"
#include "samples/status/health.hpp"

namespace fathom::cli {
namespace {

/// A run of a fusion service: all that one process said.
struct Run {
  std::string service;
  std::uint64_t first = ~0ULL;  ///< number of the first entry of its list that is in the recording
  IntakeKind first_kind{};
  std::string version;
  std::string config_hash;
  std::set<TimeNs> inertial;  ///< stamps of what it took, where its beginning is not in the recording
  std::unique_ptr<Proof> proof;
};

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
    for (const File& file : files_) {
      const record::Statistics& all = file.reader.contents().statistics;
      if (all.message_count > 0) begin_ns_ = std::min(begin_ns_, all.message_start_time);
    }
    for (File& file : files_) find_runs(file);
    if (runs_.empty()) {
      throw Failure(ExitCode::bad_input,
                    name_ + ": no fusion service says in it what it took (fathom/v1/intake)");
    }
    for (auto& [process, run] : runs_) {
      run.version = lives_[process].version;
      run.config_hash = lives_[process].config_hash;
      begin(run);
    }
    const record::Selection selection =
        sensors_and({"fathom/v1/command", "fathom/v1/intake", "fathom/v1/nav_state", "fathom/v1/verdict"});
    record::Outcome all;
    for (File& file : files_) {
      const record::Outcome outcome =
          file.reader.read(selection, [&](const record::Channel& channel, const record::Message& message) {
            take(channel, message);
            return true;
          });
      all.problems.insert(all.problems.end(), outcome.problems.begin(), outcome.problems.end());
    }
    finish();
    return answer(all);
  }

 private:
  static record::Selection sensors_and(const std::vector<const char*>& topics) {
    record::Selection out;
    for_each_kind([&](auto kind) { out.topics.emplace_back(kind.kTopic); });
    out.topics.insert(out.topics.end(), topics.begin(), topics.end());
    return out;
  }

  /// Gives the sample to `take` where the channel is that of a sensor.
  template <class Take>
  static void read_sample(const record::Channel& channel, const record::Message& message, Take take) {
    for_each_kind([&](auto kind) {
      if (channel.topic != kind.kTopic) return;
      if (const auto sample = bus::from_cdr<typename decltype(kind)::Sample>(message.data)) take(*sample);
    });
  }

  void find_runs(File& file) {
    file.reader.read(sensors_and({"fathom/v1/intake", "fathom/v1/service_status"}),
                     [&](const record::Channel& channel, const record::Message& message) {
                       find_run(channel, message, static_cast<std::size_t>(&file - files_.data()));
                       return true;
                     });
  }

  void find_run(const record::Channel& channel, const record::Message& message, std::size_t file) {
    if (channel.topic == "fathom/v1/intake") {
      if (said_before(message)) return;
      if (const auto intake = bus::from_cdr<IntakeRecord>(message.data))
        look(runs_[process_of(channel)], *intake);
    } else if (channel.topic == "fathom/v1/service_status") {
      const auto status = bus::from_cdr<ServiceStatus>(message.data);
      if (!status) return;
      ServiceStatus& kept = lives_[process_of(channel)];
      kept.version = status->version;
      kept.config_hash = status->config_hash;
    } else {
      read_sample(channel, message, [&]<class T>(const T& sample) {
        spans_.note(kSourceOf<T>, sample.header, {process_of(channel), file, Name(writer_of(channel))});
      });
    }
  }

  /// Before the recorder was there, and kept for it by the writer: the samples of that time are not in the
  /// recording.
  [[nodiscard]] bool said_before(const record::Message& message) const {
    return message.publish_time < begin_ns_;
  }

  void look(Run& run, const IntakeRecord& intake) {
    run.service = intake.header.sensor.str();
    if (intake.entries.empty()) return;
    if (intake.first < run.first) {
      run.first = intake.first;
      run.first_kind = intake.entries.front().kind;
    }
    for (const IntakeEntry& entry : intake.entries) {
      if (entry.kind == IntakeKind::state) pool_.want(entry.stamp_ns, entry.sequence);
      if (entry.kind == IntakeKind::sample && entry.source == SourceKind::imu)
        run.inertial.insert(entry.stamp_ns);
    }
  }

  /// From its beginning, or from the first state of its own that is in the recording.
  void begin(Run& run) {
    for (File& file : files_) {
      if (!holds_configuration(file.reader, run.service)) continue;
      const auto loaded = recorded_configuration(file.reader, file.name, run.service, {}, run.config_hash);
      const bool exact = run.config_hash.empty() || loaded.hash == run.config_hash;
      if (!exact && &file != &files_.back()) continue;  // it may be in the next file
      own_hashes_[&run] = loaded.hash;
      Proof::Begin from{run.first, run.first == 0 && run.first_kind != IntakeKind::state, checkpoints_of(run),
                        [this](const IntakeEntry& entry) { return !spans_.hold(entry); }};
      run.proof = std::make_unique<Proof>(loaded.value, pool_, std::move(from));
      run.inertial.clear();
      return;
    }
    throw Failure(ExitCode::bad_input, name_ + ": the configuration of " + run.service +
                                           " is not in the recording, expected services/" + run.service +
                                           "/config.json or vehicle.json");
  }

  /// The recorded states of a run, which others may have gone on from, too.
  std::map<TimeNs, std::vector<std::byte>> checkpoints_of(const Run& run) {
    std::map<TimeNs, std::vector<std::byte>> out;
    for (File& file : files_) {
      for (const record::AttachmentIndex& index : file.reader.contents().attachments) {
        if (index.name != "services/" + run.service + "/checkpoint") continue;
        const auto bytes = file.reader.attachment(index);
        if (!bytes) continue;
        auto checkpoint = archive::decode(std::as_bytes(std::span(bytes.value())));
        if (!checkpoint) continue;
        const TimeNs stamp_ns = checkpoint.value().label.stamp_ns;
        pool_.offer(stamp_ns, checkpoint.value().archive);
        if (run.inertial.contains(stamp_ns)) out[stamp_ns] = std::move(checkpoint.value().archive);
      }
    }
    return out;
  }

  void take(const record::Channel& channel, const record::Message& message) {
    const auto own = runs_.find(process_of(channel));
    Proof* proof = own == runs_.end() ? nullptr : own->second.proof.get();
    const auto give = [&](const auto& sample) {
      if (proof != nullptr && sample) proof->add(*sample);
    };
    if (channel.topic == "fathom/v1/intake") {
      if (!said_before(message)) give(bus::from_cdr<IntakeRecord>(message.data));
    } else if (channel.topic == "fathom/v1/nav_state") {
      give(bus::from_cdr<NavState>(message.data));
    } else if (channel.topic == "fathom/v1/verdict") {
      give(bus::from_cdr<Verdict>(message.data));
    } else if (channel.topic == "fathom/v1/command") {
      if (const auto order = bus::from_cdr<Command>(message.data))
        for (auto& [process, run] : runs_) run.proof->add(*order);
    } else {
      const Name name(writer_of(channel));
      read_sample(channel, message, [&](const auto& sample) {
        for (auto& [process, run] : runs_) run.proof->add(AnySample(sample), name);
      });
    }
  }

  /// What one run goes on from may follow from what another one said last.
  void finish() {
    const auto any = [&](auto does) {
      bool done = false;
      for (auto& [process, run] : runs_) done = does(*run.proof) || done;
      return done;
    };
    do {
      while (any([](Proof& proof) { return proof.go_on(); })) continue;
    } while (any([](Proof& proof) { return proof.give_up_waiting(); }));
    for (auto& [process, run] : runs_) run.proof->finish();
  }

  /// Why states may differ although nobody changed the recording.
  std::string why(const Run& run, const record::Outcome& outcome) {
    if (!outcome.problems.empty()) return "the recording is damaged: " + outcome.problems.front();
    for (const File& file : files_) {
      for (const auto& index : file.reader.contents().metadata) {
        if (index.name == "dropped") return "the recorder dropped samples (metadata 'dropped')";
      }
    }
    const std::string& hash = own_hashes_[&run];
    if (!run.config_hash.empty() && run.config_hash != hash) {
      return "the configuration that is enclosed (" + hash + ") is not the one that ran (" + run.config_hash +
             ")";
    }
    const std::string own(runtime::version());
    if (!run.version.empty() && run.version != own)
      return "fusion was of another build (" + run.version + "; this is " + own + ")";
    return "a sample or what was said of it is not as it was, or the processor computes otherwise";
  }

  static std::string lacks(const Proof& proof) {
    std::string out = "the recording lacks what fusion took while the recorder did not hear the bridge: ";
    for (const std::string& one : proof.lacking())
      out += (&one == &proof.lacking().front() ? "" : ", ") + one;
    const std::uint64_t more = proof.lacking_count() - proof.lacking().size();
    return more == 0 ? out : out + " and " + std::to_string(more) + " more";
  }

  static std::string why_not(const Run& run) {
    const Proof& proof = *run.proof;
    if (!proof.missing().empty()) return proof.missing();
    if (proof.lacking_count() > 0) {
      const std::string before =
          proof.states() == 0 ? "" : " (" + std::to_string(proof.states()) + " states before it are equal)";
      return lacks(proof) + ", and no checkpoint of later is in it" + before;
    }
    return "it had taken " + std::to_string(run.first) +
           " samples before the recording began, and no checkpoint of it is in it";
  }

  std::string line_of(const Run& run, const record::Outcome& outcome) {
    const Proof& proof = *run.proof;
    const std::string states = std::to_string(proof.states());
    if (!proof.difference().empty())
      return proof.difference() + "; " + why(run, outcome) + " (" + states + " states before it are equal)";
    if (proof.taken() == 0 || !proof.is_whole()) return "cannot be proved: " + why_not(run);
    std::string line = "equal to the last bit: " + states + " navigation states and " +
                       std::to_string(proof.verdicts()) + " verdicts follow from " +
                       std::to_string(proof.taken()) + " samples and orders";
    if (proof.taken_up() > 0)
      line += ", and " + std::to_string(proof.taken_up()) + " states that it took up from those who had them";
    const auto from_ns = proof.whole_from_ns() ? proof.whole_from_ns() : proof.from_ns();
    const bool gap =
        proof.states_before() > 0;  // they were proved from the beginning on, and go on from there
    if (from_ns)
      line += (gap ? ", with a gap before its state of " : ", from its state of ") + to_iso8601(*from_ns) +
              (gap ? "" : " on");
    if (proof.lacking_count() > 0) line += "; " + lacks(proof);
    if (proof.unheard() > 0)
      line += "; " + std::to_string(proof.unheard()) + " further states are not in the recording";
    if (!proof.missing().empty()) line += "; not all of it is proved: " + proof.missing();
    return line;
  }

  ExitCode answer(const record::Outcome& outcome) {
    bool good = true;
    std::uint64_t states = 0;
    for (auto& [process, run] : runs_) {
      const Proof& proof = *run.proof;
      std::printf("%s: %s (%s): %s\n", name_.c_str(), run.service.c_str(), process.substr(8, 8).c_str(),
                  line_of(run, outcome).c_str());
      good = good && proof.difference().empty() && proof.missing().empty() && proof.taken() > 0 &&
             proof.is_whole();
      states += proof.states();
    }
    return good && states > 0 ? ExitCode::done : ExitCode::no;
  }

  std::string name_;  // of the first file
  std::vector<File> files_;
  TimeNs begin_ns_ = std::numeric_limits<TimeNs>::max();  // log time of the first message
  StatePool pool_;
  Spans spans_;
  std::map<std::string, Run> runs_;             // by process
  std::map<std::string, ServiceStatus> lives_;  // likewise, of all services: version and configuration
  std::map<const Run*, std::string> own_hashes_;
};

}  // namespace

ExitCode verify(const std::vector<std::string>& files) {
  return Verification(files).run();
}

}  // namespace fathom::cli
