#include "cli/init/proposal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "config/vehicle/catalogue.hpp"
#include "config/vehicle/vehicle_config.hpp"
#include "samples/kinds.hpp"

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string role_name(SourceKind kind) {
  const std::string role(role_of(kind));
  return role.substr(0, role.rfind("_bridge"));
}

Json port_json(const runtime::ByteSourceConfig& port) {
  switch (port.type) {
    case runtime::SourceType::serial: {
      Json out = {{"type", "serial"}, {"path", port.path}, {"baud", port.baud}};
      if (port.framing != runtime::Framing::n8_1) out["framing"] = to_string(port.framing);
      return out;
    }
    case runtime::SourceType::tcp_client:
      return {{"type", "tcp_client"}, {"address", port.address}, {"port", port.port}};
    default:
      return {{"type", "udp"}, {"address", port.address}, {"port", port.port}};
  }
}

/// Whether a key of an instrument means something for a kind, and whether it has to be said.
struct KeyOfKind {
  bool known = false;
  bool required = false;
};
KeyOfKind key_of(const std::string& key, SourceKind kind) {
  static const std::vector<config::FieldRow> kRows = config::vehicle_kind().rows();
  const std::string word(to_string(kind));
  for (const config::FieldRow& row : kRows) {
    if (row.key != "instruments[]." + key) continue;
    const auto& needed = row.info.required_for;
    return {row.info.known_to(word), std::find(needed.begin(), needed.end(), word) != needed.end()};
  }
  return {};
}

/// What a vehicle has a port for, where a port says several things: what has a place, as a receiver that says
/// a heading as well, and of those what says most.
const SeenKind& leading(const std::vector<SeenKind>& kinds) {
  return *std::max_element(kinds.begin(), kinds.end(), [](const SeenKind& a, const SeenKind& b) {
    return std::pair(key_of("position_m", a.kind).known, a.samples) <
           std::pair(key_of("position_m", b.kind).known, b.samples);
  });
}

/// The kind's word; that of the bridge where one instrument says several.
std::string name_of(const std::vector<SeenKind>& kinds, SourceKind lead) {
  const auto of_bridge = [lead](const SeenKind& one) { return role_of(one.kind) == role_of(lead); };
  return std::count_if(kinds.begin(), kinds.end(), of_bridge) > 1 ? role_name(lead)
                                                                  : std::string(to_string(lead));
}

std::string number_text(double value, const char* format) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

/// The models of the catalogue that speak the protocol. The only one is taken: its protocol is its maker's
/// own.
void add_model(SourceKind kind, const std::string& protocol, Proposal& out) {
  std::vector<std::string> models;
  for (const std::string& model : config::catalogue_models()) {
    const auto entry = config::load_catalogue_entry(config::catalogue_directory() + "/" + model + ".json");
    if (entry.kind == kind && entry.protocol == protocol) models.push_back(model);
  }
  if (models.empty()) return;
  const bool own = !protocol.starts_with("nmea") && !protocol.starts_with("ascii_");
  if (models.size() == 1 && own) {
    out.instrument["model"] = models.front();
    out.notes.push_back("its protocol is that of model " + models.front());
    return;
  }
  std::string all;
  for (const std::string& model : models) all += (all.empty() ? "" : ", ") + model;
  out.notes.push_back("of the catalogue these speak so: " + all +
                      "; \"model\" brings the figures of the data sheet");
}

void add_depth(const Recognition& seen, Proposal& out) {
  if (seen.protocol != "paroscientific" && seen.protocol != "ascii_depth") return;  // others say their unit
  const auto unit = seen.depth_m ? unit_in_air(*seen.depth_m) : std::nullopt;
  out.instrument["bridge"] = {{"unit", unit.value_or("psi")}};
  if (seen.protocol == "ascii_depth") {
    out.instrument["bridge"] = {{"unit", "m"}};
    out.notes.push_back("its number is taken for metres of depth; say another unit in bridge.unit");
  } else if (unit) {
    out.notes.push_back("its pressure is an atmosphere in " + *unit +
                        ", so that is its unit if the vehicle is in air");
  } else {
    out.notes.push_back("the unit of its pressure cannot be told; psi is written, and has to be checked");
  }
}

/// What a unit of KVH does unless it was set otherwise: at rest nothing in its messages says it.
void add_kvh(Proposal& out) {
  out.instrument["bridge"] = {{"kvh", {{"rotation", "delta"}}}};
  out.notes.push_back(
      "it is taken to give delta angles in radians, as it does unless it was set otherwise; say rotation and "
      "rotation_unit in bridge.kvh if it was (=ROTFMT, =ROTUNITS)");
}

void add_mounting(const Recognition& seen, Proposal& out) {
  const auto upright = seen.mean_force_S ? upright_rpy_deg(*seen.mean_force_S) : std::nullopt;
  out.has_mounting = true;
  out.instrument["mounting_rpy_deg"] = upright.value_or(std::array<double, 3>{0.0, 0.0, 0.0});
  if (seen.mean_force_S && upright)
    out.notes.push_back(
        "roll and pitch of its mounting are from gravity, if the vehicle is level; yaw cannot be told");
  else
    out.notes.push_back("which way round it is cannot be told");
}

/// An instrument but for its port.
Proposal proposal_of(const Heard& heard, const SeenKind& kind, const std::string& name) {
  const Recognition& seen = *heard.recognition;
  Proposal made;
  made.instrument = {{"name", name}, {"kind", to_string(kind.kind)}, {"protocol", seen.protocol}};
  const double rate_hz = tidy_rate_hz(kind.rate_hz, kind.samples);
  made.instrument["rate_hz"] = rate_hz > 0.0 ? rate_hz : 1.0;
  add_model(kind.kind, seen.protocol, made);
  made.what = name + ": " + runtime::describe_source(heard.port) + ", " + seen.protocol + ", " +
              number_text(kind.rate_hz, "%.4g Hz") +
              number_text(100.0 * seen.share, ", %.0f % % of its bytes understood");
  if (rate_hz == 0.0) made.notes.push_back("too few samples to count its rate; 1 Hz is written");
  made.has_place = key_of("position_m", kind.kind).known;
  if (made.has_place) made.instrument["position_m"] = {0.0, 0.0, 0.0};
  if (key_of("mounting_rpy_deg", kind.kind).required) add_mounting(seen, made);
  if (kind.kind == SourceKind::depth) add_depth(seen, made);
  if (seen.protocol == "kvh") add_kvh(made);
  if (seen.protocol == "nmea_attitude") {
    made.notes.push_back(
        "where its sentence does not say which north the heading is from, north of its bridge does");
  }
  if (kind.kind == SourceKind::propulsion || kind.kind == SourceKind::fins) {
    made.instrument["fusion"] = {{"enabled", false}};
    made.notes.push_back("navigation does without it until fusion.enabled and what it means are said");
  }
  return made;
}

}  // namespace

double tidy_rate_hz(double rate_hz, std::uint64_t samples) {
  if (!(rate_hz > 0.0) || samples == 0) return 0.0;
  const double tolerance = std::max(0.03, 1.5 / static_cast<double>(samples));
  for (const double step : {100.0, 50.0, 25.0, 10.0, 5.0, 1.0, 0.5, 0.1, 0.05, 0.01}) {
    if (step < 0.1 * rate_hz) break;
    const double near = std::round(rate_hz / step) * step;
    if (near > 0.0 && std::abs(near - rate_hz) <= tolerance * near) return std::round(near * 1000.0) / 1000.0;
  }
  return std::round(rate_hz * 1000.0) / 1000.0;
}

std::optional<std::array<double, 3>> upright_rpy_deg(const std::array<double, 3>& f) {
  const double norm = std::hypot(f[0], f[1], f[2]);
  if (std::abs(norm - 9.81) > 1.0) return std::nullopt;  // not at rest, or not in m/s^2
  constexpr double kUp = 0.9;                            // of the whole: within 26 degrees
  // Specific force points up. In axes forward, right, down that is (0, 0, -1).
  const std::array<double, 3> up{f[0] / norm, f[1] / norm, f[2] / norm};
  if (up[2] < -kUp) return std::array<double, 3>{0.0, 0.0, 0.0};
  if (up[2] > kUp) return std::array<double, 3>{180.0, 0.0, 0.0};
  if (up[1] > kUp) return std::array<double, 3>{-90.0, 0.0, 0.0};
  if (up[1] < -kUp) return std::array<double, 3>{90.0, 0.0, 0.0};
  if (up[0] > kUp) return std::array<double, 3>{0.0, 90.0, 0.0};
  if (up[0] < -kUp) return std::array<double, 3>{0.0, -90.0, 0.0};
  return std::nullopt;
}

std::optional<std::string> unit_in_air(double depth_as_psi_m) {
  constexpr double kAtmosphere_Pa = 101'325.0;
  constexpr double kPsi_Pa = 6'894.757;
  constexpr double kWater_Pa_m = 10'055.0;
  const double number = (kAtmosphere_Pa + depth_as_psi_m * kWater_Pa_m) / kPsi_Pa;
  // The water's compressibility makes the largest numbers a little larger: a tenth either way is allowed for.
  for (const auto& [unit, pascal] :
       {std::pair{"psi", kPsi_Pa}, {"bar", 1e5}, {"kPa", 1e3}, {"dbar", 1e4}, {"mbar", 1e2}}) {
    if (std::abs(number * pascal / kAtmosphere_Pa - 1.0) < 0.1) return unit;
  }
  return std::nullopt;
}

std::vector<Proposal> propose(const std::vector<Heard>& heard) {
  std::vector<Proposal> out;
  std::map<std::string, int> names;
  for (const Heard& one : heard) {
    if (!one.recognition || one.recognition->kinds.empty()) continue;
    const Recognition& seen = *one.recognition;
    const SeenKind& lead = leading(seen.kinds);
    // What an autopilot says of the same vehicle is not for navigation unasked (deploy/DOORS.md).
    const bool all = seen.protocol != "mavlink";
    std::vector<SourceKind> bridges{lead.kind};  // a kind of each, the leading one's first
    std::string elsewhere;
    for (const SeenKind& kind : seen.kinds) {
      const auto is_here = [&kind](SourceKind of) { return role_of(of) == role_of(kind.kind); };
      if (std::any_of(bridges.begin(), bridges.end(), is_here)) continue;
      if (all) {
        bridges.push_back(kind.kind);
      } else {
        elsewhere += (elsewhere.empty() ? "" : ", ") + std::string(to_string(kind.kind));
      }
    }
    Json port = port_json(one.port);
    if (bridges.size() > 1) port["shared"] = true;
    for (const SourceKind bridge : bridges) {
      const std::string base = name_of(seen.kinds, bridge);
      const int count = ++names[base];
      const std::string name = base + (count == 1 ? "" : std::to_string(count));
      bool first = true;
      for (const SeenKind& kind : seen.kinds) {
        if (role_of(kind.kind) != role_of(bridge)) continue;
        out.push_back(proposal_of(one, kind, name));
        if (first) out.back().instrument["port"] = port;
        first = false;
      }
    }
    if (!elsewhere.empty())
      out.back().notes.push_back("the port says " + elsewhere +
                                 " as well, which another bridge would read: " + role_name(lead.kind) +
                                 " is taken");
  }
  return out;
}

}  // namespace fathom::cli
