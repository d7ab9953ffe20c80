#include "cli/recording.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include "blackbox/enclosures.hpp"
#include "bus/topics.hpp"
#include "cli/command.hpp"
#include "config/json/error.hpp"
#include "config/vehicle/vehicle_config.hpp"

namespace fathom::cli {

namespace fs = std::filesystem;

record::Reader open_recording(const std::string& file) {
  auto reader = record::Reader::open(file);
  if (!reader) throw Failure(ExitCode::bad_input, reader.error().message);
  if (reader.value().contents().header.profile == "ros2") {
    throw Failure(ExitCode::bad_input,
                  file + ": a bag of ROS 2, expected a recording of fathom; fathom import " + file +
                      " --out DIR makes a data set of it");
  }
  const std::string& ending = reader.value().contents().ending;
  if (!ending.empty()) {
    std::fprintf(stderr, "fathom: %s: was not closed (%s); fathom record --recover closes it\n", file.c_str(),
                 ending.c_str());
  }
  return std::move(reader.value());
}

std::string writer_of(const record::Channel& channel) {
  const auto found = channel.metadata.find("writer");
  return found == channel.metadata.end() ? "" : found->second;
}

std::string process_of(const record::Channel& channel) {
  const auto guid = channel.metadata.find("writer_guid");
  return guid == channel.metadata.end() ? "" : process_of_writer(guid->second);
}

std::string process_of_writer(const std::string& guid) {
  return guid.substr(0, 24);
}

std::vector<std::string> topics_of(const std::vector<std::string>& words) {
  std::vector<std::string> out;
  const auto all = bus::all_topics();
  for (const std::string& word : words) {
    const std::string full = word.find('/') == std::string::npos ? "fathom/v1/" + word : word;
    if (std::none_of(all.begin(), all.end(), [&](const auto& topic) { return full == topic.topic; }))
      throw Failure(ExitCode::bad_configuration, "--topic " + word + ": there is no such topic");
    out.push_back(full);
  }
  return out;
}

namespace {

/// Files as a configuration refers to them, for as long as it is loaded.
class Folder {
 public:
  Folder() {
    std::string path = (fs::temp_directory_path() / "fathom-config-XXXXXX").string();
    if (mkdtemp(path.data()) == nullptr) throw Failure(ExitCode::runtime_failure, path + ": cannot be made");
    path_ = path;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string path() const { return path_.string(); }
  /// `name` relative to the folder, and inside of it.
  fs::path put(const fs::path& name, const record::Bytes& bytes) {
    fs::path path = path_ / name;
    std::error_code failed;
    fs::create_directories(path.parent_path(), failed);
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.flush();
    if (!file) throw Failure(ExitCode::runtime_failure, path.string() + ": cannot be written");
    return path;
  }

 private:
  fs::path path_;
};

/// The same of another place.
config::ConfigError said_anew(const config::ConfigError& error, const std::string& place) {
  std::vector<config::ConfigError> out;
  for (const config::ConfigError& one : error.each()) {
    if (one.key().empty()) {
      out.emplace_back(place, std::string(one.what()).substr(one.file().size() + 2));
    } else {
      out.emplace_back(place, one.key(), one.value(), one.expectation());
    }
  }
  return config::ConfigError(std::move(out));
}

/// A file stands in the recording, not where it was put for reading.
config::ConfigError in_the_recording(const config::ConfigError& error, const std::string& put,
                                     const std::string& place) {
  std::vector<config::ConfigError> out;
  for (const config::ConfigError& one : error.each())
    out.push_back(one.file().starts_with(put) ? said_anew(one, place + one.file().substr(put.size() + 1))
                                              : one);
  return config::ConfigError(std::move(out));
}

/// What was enclosed of one service at one time, with its command line.
config::LoadedConfig<config::FusionConfig> load_enclosed(record::Reader& reader, const std::string& file,
                                                         const std::string& folder,
                                                         const record::AttachmentIndex& command,
                                                         const std::vector<std::string>& sets) {
  const auto failed = [&](const std::string& what) {
    return Failure(ExitCode::bad_input,
                   file + ": " + folder + what + ", expected the configuration; give it with --config");
  };
  const auto content = [&](const record::AttachmentIndex& one) {
    auto bytes = reader.attachment(one);
    if (!bytes) throw failed(one.name.substr(folder.size()) + ": " + bytes.error().message);
    return std::move(bytes.value());
  };
  Folder files;
  config::LoadRequest request;
  std::string vehicle;
  for (const record::AttachmentIndex& one : reader.contents().attachments) {
    const bool same = one.create_time == command.create_time && one.name.starts_with(folder);
    const std::string name = same ? one.name.substr(folder.size()) : "";
    if (name == "config.json") {
      request.file = files.put(name, content(one)).string();
    } else if (blackbox::is_referred(name)) {
      const fs::path path = files.put(blackbox::referred_path(name), content(one));
      if (name == "vehicle.json") vehicle = path.string();
    }
  }
  const auto line = blackbox::command_line_from(record::text_of(content(command)));
  if (!line) throw failed("command.json: is no command line");
  const auto load = [&](const std::vector<std::string>& further) {
    config::LoadRequest whole = request;
    whole.sets = line->values_of("--set");
    whole.sets.insert(whole.sets.end(), further.begin(), further.end());
    if (!vehicle.empty()) whole = config::with_vehicle(std::move(whole), vehicle, "fusion");
    return config::load_service_config<config::FusionConfig>(whole);
  };
  try {
    return load(sets);
  } catch (const config::ConfigError& error) {
    try {
      (void)load({});
    } catch (const config::ConfigError&) {
      throw in_the_recording(error, files.path(), file + ": " + folder);
    }
    throw said_anew(error, "--set");  // without the overrides it is well
  }
}

/// Command lines of a service beside which its configuration is there.
std::vector<record::AttachmentIndex> commands_of(const record::Reader& reader, const std::string& folder) {
  const auto& all = reader.contents().attachments;
  std::vector<record::AttachmentIndex> out;
  for (const auto& command : all) {
    if (command.name != folder + "command.json") continue;
    const bool configured = std::any_of(all.begin(), all.end(), [&](const auto& one) {
      return one.create_time == command.create_time &&
             (one.name == folder + "config.json" || one.name == folder + "vehicle.json");
    });
    if (configured) out.push_back(command);
  }
  return out;
}

std::string folder_of(const std::string& service) {
  return "services/" + service + "/";
}

}  // namespace

bool holds_configuration(const record::Reader& reader, const std::string& service) {
  return !commands_of(reader, folder_of(service)).empty();
}

config::LoadedConfig<config::FusionConfig> recorded_configuration(record::Reader& reader,
                                                                  const std::string& file,
                                                                  const std::string& service,
                                                                  const std::vector<std::string>& sets,
                                                                  const std::string& hash) {
  const std::string folder = folder_of(service);
  const std::vector<record::AttachmentIndex> all = commands_of(reader, folder);
  if (all.empty()) {
    throw Failure(ExitCode::bad_input, file + ": " + folder +
                                           "config.json or vehicle.json: is not there, expected " +
                                           "the configuration of " + service + "; give it with --config");
  }
  auto last = load_enclosed(reader, file, folder, all.back(), sets);
  for (std::size_t back = 2; !hash.empty() && last.hash != hash && back <= all.size(); ++back) {
    auto one = load_enclosed(reader, file, folder, all[all.size() - back], sets);
    if (one.hash == hash) return one;
  }
  return last;
}

}  // namespace fathom::cli
