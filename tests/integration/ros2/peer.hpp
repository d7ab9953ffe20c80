#pragma once

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/process.hpp"

namespace fathom::test {

/// A node of ROS 2 in another process, on Cyclone DDS.
class Peer {
 public:
  Peer(const std::string& role, std::uint32_t domain, std::vector<std::string> more = {}, bool humble = false)
      : process_(program(humble), arguments(role, domain, std::move(more))) {}

  /// What it printed until it ended by itself.
  std::string output() {
    (void)process_.wait();
    return process_.out() + process_.err();
  }
  [[nodiscard]] std::string so_far() const { return process_.out(); }

 private:
  static std::string program(bool humble) {
    setenv("CYCLONEDDS_URI", FATHOM_CYCLONE_CONFIG, 1);
    return humble ? "../tests/ros2_peer_humble" : "../tests/ros2_peer";
  }
  static std::vector<std::string> arguments(const std::string& role, std::uint32_t domain,
                                            std::vector<std::string> more) {
    std::vector<std::string> out{role, std::to_string(domain)};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }

  Process process_;
};

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) out.push_back(line);
  return out;
}

inline std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream words(line);
  for (std::string word; words >> word;) out.push_back(word);
  return out;
}

/// "name value value" a line: the values by name, the last ones where there are several.
inline std::map<std::string, std::vector<std::string>> said(const std::string& text) {
  std::map<std::string, std::vector<std::string>> out;
  for (const std::string& line : lines_of(text)) {
    std::vector<std::string> words = words_of(line);
    if (words.empty()) continue;
    const std::string name = words.front();
    words.erase(words.begin());
    out[name] = std::move(words);
  }
  return out;
}

}  // namespace fathom::test
