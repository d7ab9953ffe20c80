#include "bus/detail/qos/profiles.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "base/disk/folder.hpp"
#include "base/disk/regular_file.hpp"
#include "bus/detail/versions/settings.hpp"
#include "bus/detail/workarounds/dds_log.hpp"
#include "bus/option_error.hpp"
#include "bus/profiles.hpp"
#include "samples/kinds.hpp"

namespace fathom::bus::detail {
namespace {

namespace fs = std::filesystem;

Duration to_duration(DurationNs ns) {
  return {static_cast<std::int32_t>(ns / kNsPerSecond), static_cast<std::uint32_t>(ns % kNsPerSecond)};
}

[[noreturn]] void no_profile(const std::string& topic, const char* kind) {
  throw BusError("topic " + topic + ": the QoS profiles have no " + kind + " '" + topic + "'");
}

// What instruments have that name no profile of their own.
constexpr const char* kInstrument = "fathom/v1/instrument";

bool is_instrument(const std::string& topic) {
  bool found = false;
  for_each_kind([&](auto kind) { found = found || kind.kTopic == topic; });
  return found;
}

void check_deadline(const std::string& topic, const std::optional<DurationNs>& deadline) {
  if (deadline && *deadline <= 0) {
    throw BusError("topic " + topic + ": deadline " + std::to_string(*deadline) +
                   " ns: expected more than 0");
  }
}

}  // namespace

std::string find_profiles_dir(const std::string& configured) {
  std::vector<fs::path> places;
  const char* environment = std::getenv("FATHOM_DDS_DIR");
  if (!configured.empty()) {
    places.emplace_back(configured);
  } else if (environment != nullptr && *environment != '\0') {
    places.emplace_back(environment);
  } else {
    std::error_code ignored;
    fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    // build/bin and build/tests are two levels below the repository, bin one level below an installation.
    for (int level = 0; level < 4 && folder.has_relative_path(); ++level) {
      places.push_back(folder / "deploy" / "dds");
      places.push_back(folder / "share" / "fathom" / "dds");
      folder = folder.parent_path();
    }
  }
  std::string looked;
  for (const fs::path& place : places) {
    std::error_code ignored;
    if (fs::is_regular_file(place / "participant.xml", ignored)) return place.string();
    looked += (looked.empty() ? "" : ", ") + place.string();
  }
  throw OptionError("no QoS profiles (participant.xml and others) in: " + looked);
}

void load_profiles(const std::string& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const fs::path& file : paths_in(folder, failed)) {
    if (file.extension() == ".xml") files.push_back(fs::weakly_canonical(file));
  }
  if (failed || files.empty()) throw OptionError(folder + ": expected a folder with QoS profiles (*.xml)");
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    if (const std::string wrong = no_regular_file(file); !wrong.empty()) {
      throw OptionError(file.string() + ": " + wrong);
    }
    if (!load_profiles_file(file.string())) {
      throw BusError(file.string() + ": not a file of QoS profiles that Fast DDS understands" +
                     last_dds_error());
    }
  }
}

dds::DataWriterQos writer_qos(const dds::Publisher& publisher, const std::string& topic,
                              const WriterOptions& options) {
  check_deadline(topic, options.deadline_ns);
  dds::DataWriterQos qos;
  if (!done(publisher.get_datawriter_qos_from_profile(topic, qos)) &&
      !(is_instrument(topic) && done(publisher.get_datawriter_qos_from_profile(kInstrument, qos)))) {
    no_profile(topic, "data_writer");
  }
  if (options.deadline_ns) qos.deadline().period = to_duration(*options.deadline_ns);
  if (qos.ownership().kind == dds::EXCLUSIVE_OWNERSHIP_QOS) {
    if (options.ownership_strength < 0) {
      throw BusError("topic " + topic + ": ownership strength " + std::to_string(options.ownership_strength) +
                     ": expected 0 or more");
    }
    qos.ownership_strength().value = static_cast<std::uint32_t>(options.ownership_strength);
  }
  return qos;
}

dds::DataReaderQos reader_qos(const dds::Subscriber& subscriber, const std::string& topic,
                              const ReaderOptions& options) {
  check_deadline(topic, options.deadline_ns);
  dds::DataReaderQos qos;
  const bool variant = !options.profile_suffix.empty() && done(subscriber.get_datareader_qos_from_profile(
                                                              topic + "." + options.profile_suffix, qos));
  if (!variant) {
    if (!options.profile_suffix.empty() && options.profile_suffix != "deep") {
      no_profile(topic + "." + options.profile_suffix, "data_reader");
    }
    if (!done(subscriber.get_datareader_qos_from_profile(topic, qos)) &&
        !(is_instrument(topic) && done(subscriber.get_datareader_qos_from_profile(kInstrument, qos)))) {
      no_profile(topic, "data_reader");
    }
  }
  if (options.deadline_ns) qos.deadline().period = to_duration(*options.deadline_ns);
  return qos;
}

Policy policy_of(dds::QosPolicyId_t id) {
  switch (id) {
    case dds::RELIABILITY_QOS_POLICY_ID:
      return Policy::reliability;
    case dds::DURABILITY_QOS_POLICY_ID:
      return Policy::durability;
    case dds::DEADLINE_QOS_POLICY_ID:
      return Policy::deadline;
    case dds::OWNERSHIP_QOS_POLICY_ID:
      return Policy::ownership;
    case dds::LIVELINESS_QOS_POLICY_ID:
      return Policy::liveliness;
    default:
      return Policy::other;
  }
}

}  // namespace fathom::bus::detail

std::string fathom::bus::profiles_folder(const std::string& configured) {
  return detail::find_profiles_dir(configured);
}
