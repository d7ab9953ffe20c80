#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blackbox/options.hpp"
#include "blackbox/queue.hpp"
#include "blackbox/sample.hpp"
#include "record/writer.hpp"

namespace fathom::blackbox {

/// How recording goes.
struct StoreCounts {
  std::uint64_t samples = 0;  ///< on the disk
  std::uint64_t bytes = 0;    ///< of all files of this run
  std::uint64_t files = 0;
  std::uint64_t lost = 0;     ///< arrived and not kept, because the disk was full or too slow
  std::uint64_t removed = 0;  ///< old files, for the quota or for room
  std::string trouble;        ///< why nothing is written now; empty when all is well
  std::string file;           ///< that is written now
};

/// What is on the disk: begins files, splits them, repeats latched samples, keeps to the quota. Belongs to
/// the disk's thread. Time is an argument, and files are made by a function, so that it is tested without a
/// disk.
class Store {
 public:
  /// Makes the file of this path. The error says why it cannot be made.
  using Create = std::function<Result<std::unique_ptr<record::Sink>>(const std::filesystem::path& path)>;
  /// What people should read, as a line of the log.
  using Say = std::function<void(bool is_trouble, const std::string& line)>;

  Store(Options options, Create create, Say say);

  void add(Origin origin);
  void add(Sample sample);
  void add(const Event& event);
  /// Stands in every file that is begun afterwards, too, in the place of an earlier one of its name.
  void add(Enclosure enclosure);
  void add_dropped(const std::map<std::string, Dropped>& dropped);

  /// Brings everything to the disk, and begins a new file when it is time.
  void settle(TimeNs now_ns);
  /// Closes the file.
  void finish();

  [[nodiscard]] const StoreCounts& counts() const { return counts_; }

 private:
  struct Known {
    Origin origin;
    std::uint16_t channel = 0;  ///< in the open file; 0: none yet
    std::uint32_t sequence = 0;
  };

  [[nodiscard]] bool ready(TimeNs now_ns);
  void begin(TimeNs now_ns);
  void write(Sample& sample, std::uint32_t sequence);
  void keep_latched(const Sample& sample, std::uint32_t sequence);
  void enclose(const Enclosure& one);
  /// Those that change, when it is time.
  void enclose_again(TimeNs now_ns);
  void end_file();
  void begin_in_place_of_removed(TimeNs now_ns);
  /// As it is; what it holds is counted.
  void leave_file();
  void note_lost(const std::string& topic, const Dropped& one);
  void fail(const std::string& why);
  void well();
  void keep_quota();
  bool remove_oldest();
  [[nodiscard]] std::filesystem::path next_path(TimeNs now_ns);
  [[nodiscard]] bool single_file() const { return options_.out.extension() == ".mcap"; }

  Options options_;
  Create create_;
  Say say_;
  StoreCounts counts_;
  std::vector<Known> known_;
  std::map<std::string, Enclosure> enclosures_;
  std::map<std::string, TimeNs> again_ns_;  // when those that change are read
  /// Last samples of latched topics, by topic and key; with their sequence.
  std::map<std::pair<std::string, std::string>, std::pair<Sample, std::uint32_t>> latched_;
  std::map<std::string, Dropped> dropped_;             // not yet told in a file
  std::deque<std::pair<Sample, std::uint32_t>> ring_;  // before an event
  std::uint64_t ring_bytes_ = 0;
  std::optional<TimeNs> keep_until_ns_;  // of events
  std::unique_ptr<record::Writer> writer_;
  std::map<std::string, std::uint16_t> schemas_;  // in the open file
  std::filesystem::path path_;
  TimeNs began_ns_ = 0;
  TimeNs retry_ns_ = 0;
  std::uint64_t marks_ = 0;
  std::uint64_t bytes_before_ = 0;  // of closed files
  std::uint64_t samples_before_ = 0;
  int number_ = 0;
};

/// Names of a folder's recordings, the oldest first.
[[nodiscard]] std::vector<std::filesystem::path> recordings_in(const std::filesystem::path& folder);

/// Create of real files; missing folders are made.
[[nodiscard]] Result<std::unique_ptr<record::Sink>> create_file(const std::filesystem::path& path);

}  // namespace fathom::blackbox
