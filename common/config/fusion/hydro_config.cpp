#include "config/fusion/hydro_config.hpp"

#include <algorithm>

#include "config/json/schema.hpp"

namespace fathom::config {
namespace {

using estimation::hydro::CoefficientEntry;
using estimation::hydro::HydroCoefficients;

const CoefficientEntry* find_entry(const std::string& name) {
  const auto table = estimation::hydro::coefficient_table();
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const auto& one) { return one.name == name; });
  return found == table.end() ? nullptr : &*found;
}

HydroCoefficients values_of(const HydroFile& file) {
  HydroCoefficients out;
  for (const auto& [name, entry] : file.coefficients) out.*find_entry(name)->member = entry.value;
  return out;
}

std::optional<Complaint> complaint_about(const HydroFile& file) {
  for (const auto& [name, entry] : file.coefficients) {
    const CoefficientEntry* known = find_entry(name);
    if (known == nullptr) {
      std::vector<std::string> names;
      for (const auto& one : estimation::hydro::coefficient_table()) names.emplace_back(one.name);
      return Complaint{"coefficients." + name, "", "one of " + list_words(names)};
    }
    if (entry.unit != known->unit)
      return Complaint{"coefficients." + name + ".unit", "", "\"" + std::string(known->unit) + "\""};
  }
  auto found = values_of(file).complaint();
  if (found) found->key = "coefficients." + found->key;
  return found;
}

}  // namespace

void describe(Schema<HydroEntry>& s) {
  s.field("value", &HydroEntry::value, "of the coefficient, in its unit").required();
  s.field("unit", &HydroEntry::unit, "of the value; rad is written where an angle is").required();
  s.field("source", &HydroEntry::source, "where the value comes from");
  s.field("sigma", &HydroEntry::sigma, "of the value, in its unit; 0: not told").range(0, 1e9);
}

void describe(Schema<HydroFile>& s) {
  s.field("vehicle", &HydroFile::vehicle, "whose coefficients these are").required();
  s.field("source", &HydroFile::source, "of the values that do not name their own").required();
  s.field("coefficients", &HydroFile::coefficients,
          "dimensional, body axes forward-right-down, by the names of Gertler and Hagen; \"dot\" marks an "
          "acceleration, dr and ds the fins; what is not listed is zero")
      .required();
  s.check_values(complaint_about);
}

HydroCoefficients load_hydro_coefficients(const std::string& file) {
  return values_of(load<HydroFile>({file, {}}));
}

ConfigKind hydro_kind() {
  return make_kind<HydroFile>("hydro");
}

}  // namespace fathom::config
