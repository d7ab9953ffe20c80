// What the models of a vehicle's instruments say against its file. It is read as it stands, so that a mistake
// elsewhere in the file hides none here.

#include <algorithm>

#include "codec/registry.hpp"
#include "config/json/layers.hpp"
#include "config/vehicle/catalogue.hpp"

namespace fathom::config {
namespace {

using nlohmann::json;

/// The protocol's own name for any spelling or alias; empty for no protocol.
std::string_view protocol_name(const std::string& text) {
  const codec::Protocol* protocol = codec::find_protocol(text);
  return protocol == nullptr ? std::string_view{} : protocol->name;
}

/// The text under a key; empty where there is none.
std::string text_at(const json& instrument, const char* key) {
  return instrument.contains(key) && instrument.at(key).is_string() ? instrument.at(key).get<std::string>()
                                                                    : "";
}

void check_model(const json& instrument, const std::string& file, const std::string& key,
                 Mistakes& mistakes) {
  const std::string model = text_at(instrument, "model");
  if (model.empty() || instrument.value("enabled", json(true)) == false) return;
  CatalogueEntry entry;
  if (!mistakes.in([&] { entry = load_catalogue_entry(catalogue_file(model, file, key + ".model")); }))
    return;
  const std::string kind = text_at(instrument, "kind");
  const auto kinds = instrument_kinds();
  const bool known =
      std::any_of(kinds.begin(), kinds.end(), [&](const auto& one) { return one.first == kind; });
  if (known && kind != to_string(entry.kind))
    mistakes.add({file, key + ".kind", "\"" + kind + "\"",
                  "\"" + std::string(to_string(entry.kind)) + "\", which " + model + " measures"});
  const std::string protocol = text_at(instrument, "protocol");
  const std::string_view speaks = protocol_name(entry.protocol);
  // A receiver may be set to another protocol than it is delivered with. An inertial unit has one.
  if (kind == to_string(SourceKind::imu) && !protocol.empty() && !speaks.empty() &&
      protocol_name(protocol) != speaks)
    mistakes.add({file, key + ".protocol", "\"" + protocol + "\"",
                  "\"" + std::string(speaks) + "\", which " + model + " speaks"});
}

}  // namespace

void check_models(const std::string& vehicle_file, Mistakes& mistakes) {
  json file;
  if (!mistakes.in([&] { file = read_file(vehicle_file); })) return;
  if (!file.is_object() || !file.contains("instruments") || !file.at("instruments").is_array()) return;
  const json& instruments = file.at("instruments");
  for (std::size_t i = 0; i < instruments.size(); ++i) {
    if (instruments.at(i).is_object())
      check_model(instruments.at(i), vehicle_file, "instruments." + std::to_string(i), mistakes);
  }
}

}  // namespace fathom::config
