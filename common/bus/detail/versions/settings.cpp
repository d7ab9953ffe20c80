#include "bus/detail/versions/settings.hpp"

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#if FATHOM_FASTDDS_MAJOR >= 3
#include <fstream>
#include <iterator>
#include <mutex>
#include <set>
#include <string_view>
#include <utility>
#endif

namespace fathom::bus::detail {

#if FATHOM_FASTDDS_MAJOR < 3

bool load_profiles_file(const std::string& path) {
  return done(dds::DomainParticipantFactory::get_instance()->load_XML_profiles_file(path));
}

#else
namespace {

/// In the words of Fast DDS 3.
std::string translated(std::string profiles) {
  using Words = std::pair<std::string_view, std::string_view>;
  for (const auto& [old, now] : {Words{"heartbeatPeriod>", "heartbeat_period>"},
                                 Words{"nackSupressionDuration>", "nack_supression_duration>"}}) {
    for (std::size_t at = 0; (at = profiles.find(old, at)) != std::string::npos; at += now.size()) {
      profiles.replace(at, old.size(), now);
    }
  }
  return profiles;
}

}  // namespace

bool load_profiles_file(const std::string& path) {
  static std::mutex mutex;
  static std::set<std::string> loaded;  // per process, as the profiles are
  const std::lock_guard lock(mutex);
  if (loaded.contains(path)) return true;
  std::ifstream file(path);
  const std::string text = translated({std::istreambuf_iterator<char>(file), {}});
  if (!done(dds::DomainParticipantFactory::get_instance()->load_XML_profiles_string(text.data(),
                                                                                    text.size()))) {
    return false;
  }
  loaded.insert(path);
  return true;
}

#endif

}  // namespace fathom::bus::detail
