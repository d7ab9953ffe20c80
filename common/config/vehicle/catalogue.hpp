#pragma once

#include <map>
#include <string>
#include <vector>

#include "config/vehicle/vehicle_config.hpp"

namespace fathom::config {

/// One figure of a data sheet, and where it stands there.
struct CatalogueFigure {
  std::string says;    ///< as the source says it, with its unit
  std::string source;  ///< document with revision, and page or section
};

/// A file of deploy/config/catalogue: what is known of a model.
struct CatalogueEntry {
  std::string title;
  SourceKind kind = SourceKind::imu;
  std::string protocol;
  double rate_hz = 0.0;
  double latency_s = 0.0;
  int baud = 0;  ///< of its serial port as delivered; 0: unknown
  int port = 0;  ///< of its TCP server; 0: unknown
  AxisNames axes = AxisNames::frd;
  RawObject bridge, fusion;
  RawObject states;  ///< how uncertain its errors are at the start, where they are states of fusion
  std::map<std::string, CatalogueFigure> figures;  ///< by the key here that follows from it
};

[[nodiscard]] ConfigKind catalogue_kind();

/// The folder of the catalogue: FATHOM_CATALOGUE_DIR, else found beside the executable or where installed.
/// Empty: there is none.
[[nodiscard]] std::string catalogue_directory();
/// Its models, sorted.
[[nodiscard]] std::vector<std::string> catalogue_models();
/// The file of a model: in a folder "catalogue" beside `file`, else in the catalogue. Throws ConfigError
/// about `key` of `file`, where the model is named.
[[nodiscard]] std::string catalogue_file(const std::string& model, const std::string& file,
                                         const std::string& key);
/// What is wrong with the models that the file of a vehicle names: that they are none of the catalogue, or
/// measure or speak something else than the file says.
void check_models(const std::string& vehicle_file, Mistakes& mistakes);

/// A file of the catalogue. Throws ConfigError.
[[nodiscard]] CatalogueEntry load_catalogue_entry(const std::string& file);

/// Every service that has a configuration.
[[nodiscard]] std::vector<std::string> all_services();
/// The words of the kinds of instruments.
[[nodiscard]] std::vector<std::pair<std::string, SourceKind>> instrument_kinds();

}  // namespace fathom::config
