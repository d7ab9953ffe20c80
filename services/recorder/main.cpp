#include <algorithm>
#include <string>
#include <vector>

#include "base/nearest.hpp"
#include "bus/topics.hpp"
#include "config/json/error.hpp"
#include "config/recorder_config.hpp"
#include "host/run.hpp"
#include "recorder/recorder_service.hpp"

namespace {

/// Throws where a topic that is to be kept is none: nothing would ever come of it.
void refuse_unknown_topics(const fathom::config::RecorderConfig& config, const std::string& file) {
  std::vector<std::string> known;
  for (const fathom::bus::TopicInfo& one : fathom::bus::all_topics()) known.emplace_back(one.topic);
  for (std::size_t i = 0; i < config.topics.size(); ++i) {
    const std::string& topic = config.topics[i];
    if (std::find(known.begin(), known.end(), topic) != known.end()) continue;
    const auto meant = fathom::nearest(topic, known);
    std::string list;
    for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
    throw fathom::config::ConfigError(file, "topics." + std::to_string(i), '"' + topic + '"',
                                      "one of " + list + (meant ? "; the nearest is " + *meant : ""));
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace fathom;
  return host::run<config::RecorderConfig>(
      argc, argv, {"recorder", "Records everything that is said on the vehicle network.", true},
      [](host::ServiceHost& host, const config::RecorderConfig& config) {
        const recorder::RecorderService service(host, config);
        return host.run();
      },
      [](const config::RecorderConfig& config, const std::string& file, bool /*check*/) {
        refuse_unknown_topics(config, file);
      });
}
