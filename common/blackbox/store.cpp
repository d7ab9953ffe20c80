#include "blackbox/store.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <system_error>

#include "base/disk/folder.hpp"
#include "blackbox/enclosures.hpp"
#include "record/idl.hpp"
#include "samples/kinds.hpp"

namespace fathom::blackbox {
namespace {

namespace fs = std::filesystem;

constexpr DurationNs kRetryNs = 2 * kNsPerSecond;     // after a failure to begin a file
constexpr DurationNs kSettled_ns = 3 * kNsPerSecond;  // then a file that changes is of this recording
constexpr std::size_t kMostLatched = 4096;            // keys come from the network: bounded
constexpr std::uint16_t kMostChannels = 8192;         // likewise writers
constexpr std::uint64_t kMostMarks = 10'000;          // of a file

/// Samples of instruments, and the truth that they are held against, have chunks of their own: navigating
/// anew reads nothing else. They stand before those of what follows from them, wherever the file is cut off.
bool is_measured(const std::string& topic) {
  bool out = topic == "fathom/v1/truth";
  for_each_kind([&](auto kind) { out = out || topic == decltype(kind)::kTopic; });
  return out;
}

std::string file_stamp(TimeNs now_ns) {
  std::string text = to_iso8601(now_ns, 0);
  std::erase_if(text, [](char c) { return c == '-' || c == ':'; });
  return text;
}

}  // namespace

Store::Store(Options options, Create create, Say say)
    : options_(std::move(options)), create_(std::move(create)), say_(std::move(say)) {}

void Store::add(Origin origin) {
  known_.push_back({std::move(origin)});
}

void Store::add(Sample sample) {
  Known& known = known_.at(sample.origin);
  const std::uint32_t sequence = ++known.sequence;
  const bool latched = known.origin.latched;
  if (options_.around_events && (!keep_until_ns_ || sample.log_ns > *keep_until_ns_)) {
    if (latched) keep_latched(sample, sequence);
    ring_bytes_ += sample.bytes.size();
    ring_.emplace_back(std::move(sample), sequence);
    const TimeNs newest_ns = ring_.back().first.log_ns;
    while (!ring_.empty() && (ring_.front().first.log_ns < newest_ns - options_.before_ns ||
                              ring_bytes_ > options_.before_bytes)) {
      ring_bytes_ -= ring_.front().first.bytes.size();
      ring_.pop_front();
    }
    return;
  }
  const bool is_ready = ready(sample.log_ns);
  if (latched) keep_latched(sample, sequence);  // after a new file began, which repeats those before it
  if (is_ready) return write(sample, sequence);
  note_lost(known.origin.topic, {1, sample.log_ns, sample.log_ns});
}

void Store::write(Sample& sample, std::uint32_t sequence) {
  Known& known = known_.at(sample.origin);
  if (known.channel == 0) {
    const Origin& origin = known.origin;
    auto [schema, is_new] = schemas_.try_emplace(origin.type, 0);
    if (is_new) {
      const auto idl = record::self_contained_idl(record::idl_files(), origin.type);
      // Of a type of others the name alone is known.
      schema->second = idl ? writer_->add_schema(origin.type, "omgidl", idl.value())
                           : writer_->add_schema(origin.type, "", "");
    }
    known.channel = writer_->add_channel(schema->second, origin.topic, "cdr",
                                         {{"writer", origin.writer},
                                          {"writer_guid", origin.writer_guid},
                                          {"latched", origin.latched ? "true" : "false"}},
                                         is_measured(origin.topic) ? 0U : 1U);
  }
  const std::string why =
      writer_->write({known.channel, sequence, sample.log_ns, sample.publish_ns, sample.bytes});
  if (!why.empty()) fail(why);
}

void Store::keep_latched(const Sample& sample, std::uint32_t sequence) {
  const std::pair<std::string, std::string> key(known_.at(sample.origin).origin.topic, sample.key);
  const auto found = latched_.find(key);
  if (found != latched_.end()) {
    found->second = {sample, sequence};
  } else if (latched_.size() < kMostLatched) {
    latched_.emplace(key, std::pair(sample, sequence));
  }
}

void Store::add(const Event& event) {
  if (options_.around_events && event.keeps) {
    keep_until_ns_ = std::max(keep_until_ns_.value_or(0), event.time_ns + options_.after_ns);
    if (!ring_.empty() && ready(ring_.front().first.log_ns)) {
      for (auto& [sample, sequence] : ring_) write(sample, sequence);
      ring_.clear();
      ring_bytes_ = 0;
    }
  }
  const bool wanted = !options_.around_events || keep_until_ns_;
  if (!wanted || marks_ >= kMostMarks || !ready(event.time_ns)) return;
  ++marks_;
  const std::string why = writer_->add({"event",
                                        {{"kind", event.kind},
                                         {"text", event.text},
                                         {"time_ns", std::to_string(event.time_ns)},
                                         {"time", to_iso8601(event.time_ns)}}});
  if (!why.empty()) fail(why);
}

void Store::add(Enclosure enclosure) {
  Enclosure& kept = enclosures_[enclosure.name];
  kept = std::move(enclosure);
  if (!kept.path.empty()) again_ns_[kept.name] = kept.created_ns + kSettled_ns;
  if (writer_ && kept.path.empty()) enclose(kept);
}

void Store::enclose_again(TimeNs now_ns) {
  for (auto due = again_ns_.begin(); due != again_ns_.end();) {
    if (due->second > now_ns) {
      ++due;
      continue;
    }
    Enclosure one = enclosures_.at(due->first);
    const auto data = read_enclosed(one.path);
    if (!data) {  // it may come: a fusion that has heard no inertial unit has no state yet
      due->second = now_ns + kSettled_ns;
      ++due;
      continue;
    }
    due = again_ns_.erase(due);
    one.data = *data;
    one.created_ns = now_ns;
    enclose(one);
  }
}

void Store::enclose(const Enclosure& one) {
  const std::string why =
      writer_->attach({one.created_ns, one.created_ns, one.name, one.media_type, one.data, 0});
  if (!why.empty()) fail(why);
}

void Store::add_dropped(const std::map<std::string, Dropped>& dropped) {
  std::uint64_t total = 0;
  for (const auto& [topic, one] : dropped) {
    note_lost(topic, one);
    total += one.count;
  }
  if (total > 0) say_(true, std::to_string(total) + " samples were dropped: the disk does not keep up");
}

void Store::note_lost(const std::string& topic, const Dropped& one) {
  Dropped& sum = dropped_[topic];
  if (sum.count == 0) sum.first_ns = one.first_ns;
  sum.count += one.count;
  sum.last_ns = one.last_ns;
  counts_.lost += one.count;
}

bool Store::ready(TimeNs now_ns) {
  if (writer_) return true;
  if (!counts_.trouble.empty() && now_ns >= retry_ns_ - kRetryNs && now_ns < retry_ns_) return false;
  begin(now_ns);
  return writer_ != nullptr;
}

void Store::begin(TimeNs now_ns) {
  keep_quota();
  path_ = next_path(now_ns);
  auto sink = create_(path_);
  if (!sink) {
    retry_ns_ = now_ns + kRetryNs;
    return fail(sink.error().message);
  }
  record::WriterOptions options;
  options.compression = options_.compression;
  options.library = options_.library;
  writer_ = std::make_unique<record::Writer>(std::move(sink.value()), options);
  schemas_.clear();
  for (Known& known : known_) known.channel = 0;
  began_ns_ = now_ns;
  marks_ = 0;
  if (const std::string why = writer_->begin(); !why.empty()) {
    retry_ns_ = now_ns + kRetryNs;
    writer_.reset();
    std::error_code ignored;
    fs::remove(path_, ignored);
    return fail(why);
  }
  ++counts_.files;
  counts_.file = path_.string();
  say_(false, "recording to " + path_.string());
  for (const auto& [name, one] : enclosures_) {
    if (one.path.empty())
      enclose(one);
    else
      again_ns_[name] = now_ns + kSettled_ns;
  }
  for (auto& [key, entry] : latched_) {
    Sample again = entry.first;
    again.log_ns = now_ns;
    write(again, entry.second);
  }
}

void Store::settle(TimeNs now_ns) {
  if (!writer_) return;
  enclose_again(now_ns);
  std::string why = writer_->flush();
  if (why.empty() && !dropped_.empty()) {
    record::TextMap told;
    for (const auto& [topic, one] : dropped_) {
      told[topic] = std::to_string(one.count) + " samples from " + to_iso8601(one.first_ns) + " to " +
                    to_iso8601(one.last_ns);
    }
    why = writer_->add({"dropped", told});
    if (why.empty()) dropped_.clear();
  }
  if (why.empty()) why = writer_->sync();
  if (writer_->is_removed()) return begin_in_place_of_removed(now_ns);
  if (why.empty()) well();
  if (!why.empty()) {
    fail(why);
    // Somebody put another disk there, or moved the file away to make room.
    if (!writer_->is_at(path_)) {
      leave_file();
      return begin(now_ns);
    }
  }
  counts_.bytes = bytes_before_ + writer_->size();
  counts_.samples = samples_before_ + writer_->messages();
  const bool large = options_.split_bytes > 0 && writer_->size() >= options_.split_bytes;
  const bool old = options_.split_ns > 0 && now_ns - began_ns_ >= options_.split_ns;
  if (keep_until_ns_ && now_ns > *keep_until_ns_) {
    keep_until_ns_.reset();
    if (!single_file()) end_file();
  } else if (!single_file() && (large || old)) {
    end_file();
    begin(now_ns);
  }
}

void Store::begin_in_place_of_removed(TimeNs now_ns) {
  const std::uint64_t gone = writer_->messages();
  note_lost("every topic", {gone, began_ns_, now_ns});
  fail("the file was removed while it was written, and " + std::to_string(gone) + " samples with it");
  writer_.reset();
  begin(now_ns);
}

void Store::leave_file() {
  bytes_before_ += writer_->size();
  samples_before_ += writer_->messages();
  writer_.reset();
}

void Store::end_file() {
  if (const std::string why = writer_->finish(); !why.empty()) fail(why);
  leave_file();
  counts_.bytes = bytes_before_;
  counts_.samples = samples_before_;
  counts_.file.clear();
}

void Store::finish() {
  if (!writer_) return;
  settle(began_ns_);
  if (writer_) end_file();
}

/// The file cannot be written now. What was on its way there is lost.
void Store::fail(const std::string& why) {
  if (writer_) {
    for (const auto& [channel, one] : writer_->take_lost()) {
      for (const Known& known : known_) {
        if (known.channel != channel) continue;
        note_lost(known.origin.topic, {one.count, one.first_time, one.last_time});
        break;
      }
    }
  }
  if (counts_.trouble.empty()) say_(true, path_.string() + ": cannot be written: " + why);
  counts_.trouble = why;
  // Where it is the room that is missing, the oldest makes it.
  if (options_.quota_bytes > 0 && why == std::generic_category().message(ENOSPC)) remove_oldest();
}

void Store::well() {
  if (counts_.trouble.empty()) return;
  say_(false, path_.string() + ": is written again, " + std::to_string(counts_.lost) + " samples were lost");
  counts_.trouble.clear();
}

bool Store::remove_oldest() {
  if (single_file()) return false;
  for (const fs::path& one : recordings_in(options_.out)) {
    if (one == path_) continue;
    std::error_code failed;
    fs::remove(one, failed);
    if (failed) continue;
    ++counts_.removed;
    say_(false, one.string() + ": removed, to make room");
    return true;
  }
  return false;
}

void Store::keep_quota() {
  if (options_.quota_bytes == 0 || single_file()) return;
  path_.clear();
  const auto used = [this] {
    std::uint64_t sum = 0;
    for (const fs::path& one : recordings_in(options_.out)) {
      std::error_code failed;
      const std::uint64_t size = fs::file_size(one, failed);
      if (!failed) sum += size;
    }
    return sum;
  };
  while (used() + options_.split_bytes > options_.quota_bytes && remove_oldest()) {
  }
}

fs::path Store::next_path(TimeNs now_ns) {
  if (single_file()) return options_.out;
  std::array<char, 16> number{};
  fs::path path;
  std::error_code ignored;
  do {
    std::snprintf(number.data(), number.size(), "-%03d.mcap", number_++);
    path = options_.out / ("fathom-" + file_stamp(now_ns) + number.data());
  } while (fs::exists(path, ignored));
  return path;
}

std::vector<fs::path> recordings_in(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code failed;
  for (const fs::path& file : paths_in(folder, failed)) {
    const std::string name = file.filename().string();
    if (name.starts_with("fathom-") && name.ends_with(".mcap")) out.push_back(file);
  }
  std::sort(out.begin(), out.end());
  return out;
}

Result<std::unique_ptr<record::Sink>> create_file(const fs::path& path) {
  std::error_code failed;
  if (path.has_parent_path()) fs::create_directories(path.parent_path(), failed);
  auto sink = record::FileSink::create(path);
  if (!sink) return sink.error();
  return std::unique_ptr<record::Sink>(std::move(sink.value()));
}

}  // namespace fathom::blackbox
