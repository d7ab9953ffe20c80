#include "cli/recording.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include <unistd.h>

#include "blackbox/enclosures.hpp"
#include "bus/topics.hpp"
#include "cli/command.hpp"

namespace fathom::cli {

record::Reader open_recording(const std::string& file) {
  auto reader = record::Reader::open(file);
  if (!reader) throw Failure(ExitCode::bad_input, reader.error().message);
  const std::string& ending = reader.value().contents().ending;
  if (!ending.empty()) {
    std::fprintf(stderr, "fathom: %s: was not closed (%s); fathom record --recover closes it\n", file.c_str(),
                 ending.c_str());
  }
  return std::move(reader.value());
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

config::LoadedConfig<config::FusionConfig> recorded_configuration(record::Reader& reader,
                                                                  const std::string& file,
                                                                  const std::string& service,
                                                                  const std::vector<std::string>& sets) {
  const std::string folder = "services/" + service + "/";
  const auto command = reader.attachment(folder + "command.json");
  const auto text = reader.attachment(folder + "config.json");
  if (!command || !text) {
    throw Failure(ExitCode::bad_input, file + ": " + (command ? text : command).error().message +
                                           ", expected the configuration of " + service +
                                           "; give it with --config");
  }
  const auto line = blackbox::command_line_from(record::text_of(command.value()));
  if (!line) throw Failure(ExitCode::bad_input, file + ": " + folder + "command.json: is no command line");
  std::string path = (std::filesystem::temp_directory_path() / "fathom-config-XXXXXX").string();
  const int descriptor = mkstemp(path.data());
  if (descriptor < 0) throw Failure(ExitCode::runtime_failure, path + ": cannot be made");
  const std::unique_ptr<const char, int (*)(const char*)> remove(path.c_str(), ::unlink);
  const record::Bytes& bytes = text.value();
  const bool written = ::write(descriptor, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  ::close(descriptor);
  if (!written) throw Failure(ExitCode::runtime_failure, path + ": cannot be written");
  config::LoadRequest request{path, line->values_of("--set")};
  request.sets.insert(request.sets.end(), sets.begin(), sets.end());
  return config::load_service_config<config::FusionConfig>(request);
}

}  // namespace fathom::cli
