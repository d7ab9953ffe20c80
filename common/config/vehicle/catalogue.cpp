#include "config/vehicle/catalogue.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "base/disk/folder.hpp"
#include "base/nearest.hpp"
#include "config/vehicle/raw_object.hpp"

namespace fathom::config {

namespace fs = std::filesystem;

void describe(Schema<CatalogueFigure>& s) {
  s.field("says", &CatalogueFigure::says, "the figure as its source has it, with unit").required();
  s.field("source", &CatalogueFigure::source, "document with its revision, and page or section").required();
  s.check([](const CatalogueFigure& figure) -> std::pair<std::string, std::string> {
    if (figure.says.empty()) return {"says", "the figure"};
    if (figure.source.empty()) return {"source", "where the figure stands"};
    return {};
  });
}

void describe(Schema<CatalogueEntry>& s) {
  using C = CatalogueEntry;
  s.field("title", &C::title, "maker and model").required();
  s.field("kind", &C::kind, "what it measures").words(instrument_kinds()).decides().required();
  s.field("protocol", &C::protocol, "what its bytes mean; empty: nothing that this build reads");
  s.field("rate_hz", &C::rate_hz, "its usual rate; 0: there is none").unit("Hz").range(0, 10'000);
  s.field("latency_s", &C::latency_s, "from validity to arrival of the quickest frame")
      .unit("s")
      .range(0, 60);
  s.field("baud", &C::baud, "of its serial port as delivered; 0: unknown").range(0, 4'000'000);
  s.field("port", &C::port, "of its TCP server; 0: unknown").range(0, 65'535);
  s.field("axes", &C::axes, "how it names its axes")
      .words({{"frd", AxisNames::frd}, {"flu", AxisNames::flu}})
      .only_for({std::string(to_string(SourceKind::imu))});
  s.field("bridge", &C::bridge, "keys of the instrument in the file of its bridge");
  s.field("fusion", &C::fusion, "keys of the instrument in the file of fusion");
  s.field("states", &C::states,
          "how uncertain its errors are at the start: keys of engine.states in the file of fusion");
  s.field("figures", &C::figures, "where each figure stands, by its key here, e.g. fusion.sigma_m_s");
  s.check([](const C& entry) -> std::pair<std::string, std::string> {
    std::set<std::string> needed;
    for (const auto& [section, keys] : {std::pair{"fusion.", &entry.fusion}, {"states.", &entry.states}}) {
      const nlohmann::json object = nlohmann::json::parse(keys->json);
      for (const auto& [key, value] : object.items()) {
        if (key != "$comment") needed.insert(section + key);
      }
    }
    if (entry.rate_hz > 0.0) needed.insert("rate_hz");
    if (entry.latency_s > 0.0) needed.insert("latency_s");
    if (entry.baud > 0) needed.insert("baud");
    if (entry.port > 0) needed.insert("port");
    for (const std::string& key : needed) {
      if (!entry.figures.contains(key)) return {"figures", key + " among them, with its source"};
    }
    for (const auto& [key, figure] : entry.figures) {
      if (!needed.contains(key)) return {"figures." + key, "a key that stands in this file"};
    }
    return {};
  });
}

std::string catalogue_directory() {
  std::error_code error;
  if (const char* given = std::getenv("FATHOM_CATALOGUE_DIR");
      given != nullptr && fs::is_directory(given, error)) {
    return given;
  }
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (error) return "";
  for (const auto* relative : {"../../deploy/config/catalogue", "../share/fathom/config/catalogue"}) {
    const fs::path candidate = (executable.parent_path() / relative).lexically_normal();
    if (fs::is_directory(candidate, error)) return candidate.string();
  }
  return "";
}

std::vector<std::string> catalogue_models() {
  std::vector<std::string> models;
  std::error_code error;
  const std::string folder = catalogue_directory();
  if (folder.empty()) return models;
  for (const fs::path& file : paths_in(folder, error)) {
    if (file.extension() == ".json") models.push_back(file.stem().string());
  }
  std::sort(models.begin(), models.end());
  return models;
}

std::string catalogue_file(const std::string& model, const std::string& file, const std::string& key) {
  const fs::path beside = fs::path(file).parent_path() / "catalogue" / (model + ".json");
  std::error_code failed;
  if (model.find('/') == std::string::npos && fs::exists(beside, failed)) return beside.string();
  const std::vector<std::string> models = catalogue_models();
  if (std::find(models.begin(), models.end(), model) == models.end()) {
    if (models.empty())
      throw ConfigError(
          file, key, "\"" + model + "\"",
          "a model of the catalogue, which was not found; FATHOM_CATALOGUE_DIR names its folder");
    const auto meant = nearest(model, models);
    throw ConfigError(
        file, key, "\"" + model + "\"",
        (meant ? "a model of the catalogue; the nearest is " + *meant + "; known models: " : "one of ") +
            list_words(models));
  }
  return (fs::path(catalogue_directory()) / (model + ".json")).string();
}

CatalogueEntry load_catalogue_entry(const std::string& file) {
  return load<CatalogueEntry>({file, {}});
}

ConfigKind catalogue_kind() {
  return make_kind<CatalogueEntry>("catalogue");
}

}  // namespace fathom::config
