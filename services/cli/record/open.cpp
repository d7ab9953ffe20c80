#include "cli/record/open.hpp"

#include <algorithm>
#include <cstdio>

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

}  // namespace fathom::cli
