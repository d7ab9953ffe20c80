// A configuration file as each service reads it. The first byte chooses the service; the rest is the file.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include "config/json/strict_json.hpp"
#include "config/registry.hpp"
#include "driver.hpp"
#include "support/paths.hpp"

namespace {

[[noreturn]] void fail(const std::string& what) {
  (void)std::fprintf(stderr, "%s\n", what.c_str());
  std::abort();
}

std::size_t depth_of(const nlohmann::json& json) {
  std::size_t deepest = 0;
  if (json.is_structured()) {
    for (const auto& inner : json) deepest = std::max(deepest, depth_of(inner));
    ++deepest;
  }
  return deepest;
}

void check_text(const std::string& text) {
  const auto json = fathom::config::parse_strict(text);
  if (json.fault) {
    const std::string words = fathom::config::describe(*json.fault);
    if (words.empty() || words != fathom::config::one_line(words))
      fail("a refusal without words of one line");
    if (words.size() > 1000) fail("a refusal of " + std::to_string(words.size()) + " bytes");
  } else if (depth_of(json.value) > fathom::config::kJsonLevels) {
    fail("nested too deep");
  }
}

/// A file that is in memory only.
class File {
 public:
  explicit File(const std::string& text) : fd_(memfd_create("configuration", MFD_CLOEXEC)) {
    if (fd_ < 0 || write(fd_, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
      fail("no memory file");
  }
  ~File() { close(fd_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

}  // namespace

std::string_view fathom::fuzz::target_name() {
  return "configuration";
}

std::vector<std::uint8_t> fathom::fuzz::target_seed() {
  const auto kinds = config::config_kinds();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i].name != "monitor") continue;
    std::ifstream in(fathom::test::source_dir() + "/deploy/config/monitor.json", std::ios::binary);
    std::vector<std::uint8_t> out{static_cast<std::uint8_t>(i)};
    out.insert(out.end(), std::istreambuf_iterator<char>(in), {});
    return out;
  }
  fail("there is no monitor");
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data + 1), size - 1);
  check_text(text);
  const auto kinds = fathom::config::config_kinds();
  const File file(text);
  try {
    kinds[data[0] % kinds.size()].check({file.path(), {}});
  } catch (const fathom::config::ConfigError& error) {
    for (const fathom::config::ConfigError& one : error.each()) {
      const std::string words = one.what();
      if (words.empty() || words != fathom::config::one_line(words))
        fail("a refusal without words of one line");
    }
  }
  return 0;
}
