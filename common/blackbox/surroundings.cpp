#include "blackbox/surroundings.hpp"

#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/disk/folder.hpp"
#include "blackbox/enclosures.hpp"
#include "bus/profiles.hpp"

namespace fathom::blackbox {

Enclosure process_of(const ServiceStatus& status, TimeNs now_ns) {
  const nlohmann::ordered_json json{{"host", status.host},
                                    {"pid", status.pid},
                                    {"version", status.version},
                                    {"config_hash", status.config_hash},
                                    {"started", to_iso8601(status.started_ns)},
                                    {"utc_offset_s", to_seconds(status.utc_offset_ns)}};
  // What comes from the network may be no UTF-8.
  const std::string text = json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  return {"services/" + status.header.sensor.str() + "/process.json",
          "application/json",
          now_ns,
          {text.begin(), text.end()}};
}

std::vector<Enclosure> qos_profiles(const std::string& configured, TimeNs now_ns) {
  std::vector<Enclosure> out;
  std::error_code failed;
  for (const std::filesystem::path& file : paths_in(bus::profiles_folder(configured), failed)) {
    if (file.extension() != ".xml") continue;
    if (auto bytes = read_enclosed(file.string()))
      out.push_back({"qos/" + file.filename().string(), "application/xml", now_ns, std::move(*bytes)});
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return out;
}

}  // namespace fathom::blackbox
