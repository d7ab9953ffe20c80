// Every configuration file that is shipped must load, and name the schema that describes it.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "config/registry.hpp"
#include "support/paths.hpp"

namespace fathom::config {
namespace {

const std::filesystem::path kShipped = std::filesystem::path(test::source_dir()) / "deploy/config";

const ConfigKind* kind_named(std::string_view name) {
  for (const auto& kind : config_kinds()) {
    if (kind.name == name) return &kind;
  }
  return nullptr;
}

// The kind is what the file's "$schema" names: schema/fusion.schema.json is of kind "fusion".
std::string kind_of(const std::filesystem::path& file) {
  const auto json = nlohmann::json::parse(std::ifstream(file), nullptr, false);
  if (!json.is_object() || !json.contains("$schema")) return "";
  const std::filesystem::path schema = json["$schema"].get<std::string>();
  EXPECT_TRUE(std::filesystem::exists(file.parent_path() / schema)) << file << " names " << schema;
  return schema.stem().stem().string();
}

TEST(ShippedFiles, EveryOneLoads) {
  int files = 0;
  std::set<std::string> kinds;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kShipped)) {
    if (entry.path().extension() != ".json" || entry.path().parent_path().filename() == "schema") continue;
    SCOPED_TRACE(entry.path().string());
    const std::string name = kind_of(entry.path());
    const ConfigKind* kind = kind_named(name);
    ASSERT_NE(kind, nullptr) << "$schema names no kind of configuration: " << name;
    EXPECT_NO_THROW(kind->check({entry.path().string(), {}}));
    kinds.insert(name);
    ++files;
  }
  EXPECT_EQ(kinds.size(), config_kinds().size()) << "a kind without a shipped file, in " << files << " files";
}

TEST(ShippedFiles, UnknownKeyIsRefusedInEveryKind) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kShipped)) {
    if (entry.path().extension() != ".json" || entry.path().parent_path().filename() == "schema") continue;
    const ConfigKind* kind = kind_named(kind_of(entry.path()));
    ASSERT_NE(kind, nullptr);
    EXPECT_THROW(kind->check({entry.path().string(), {"no_such_key=1"}}), ConfigError) << entry.path();
  }
}

}  // namespace
}  // namespace fathom::config
