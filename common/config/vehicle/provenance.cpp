#include "config/vehicle/provenance.hpp"

#include <algorithm>
#include <map>

namespace fathom::config {
namespace {

using nlohmann::json;

/// What is said of each key; in place of an index there is "[]".
using Descriptions = std::map<std::string, const FieldRow*>;

class Walk {
 public:
  Walk(const Layers& layers, const std::vector<FieldRow>& rows) : layers_(layers) {
    for (const FieldRow& row : rows) {
      described_[row.key] = &row;
      const auto dot = row.key.rfind('.');
      if (row.info.decides()) deciding_[dot == std::string::npos ? "" : row.key.substr(0, dot)] = &row;
    }
  }

  void visit(const json& node, const std::string& key, const std::string& pattern) {
    const bool list = node.is_array() && !(!node.empty() && node.front().is_object());
    if (list || !node.is_structured() || node.empty()) {
      out_.push_back({key, node, layers_.origin_of(key)});
    } else if (node.is_array()) {
      for (std::size_t i = 0; i < node.size(); ++i)
        visit(node[i], key + "." + std::to_string(i), pattern + "[]");
    } else {
      for (const auto& [part, child] : node.items()) {
        const std::string inner = pattern.empty() ? part : pattern + "." + part;
        if (!means_something(node, pattern, inner)) continue;
        visit(child, key.empty() ? part : key + "." + part, inner);
      }
    }
  }

  std::vector<Provenance> take() { return std::move(out_); }

 private:
  [[nodiscard]] bool means_something(const json& around, const std::string& pattern,
                                     const std::string& inner) const {
    const auto row = described_.find(inner);
    const auto decider = deciding_.find(pattern);
    if (row == described_.end() || decider == deciding_.end() || row->second->info.only_for.empty())
      return true;
    const FieldInfo& info = decider->second->info;
    if (!around.contains(info.key) || !around.at(info.key).is_string()) return true;
    const auto word = around.at(info.key).get<std::string>();
    return row->second->info.known_to(info.choice_of == nullptr ? word : info.choice_of(word));
  }

  const Layers& layers_;
  Descriptions described_;
  Descriptions deciding_;
  std::vector<Provenance> out_;
};

}  // namespace

std::vector<Provenance> provenance(const ConfigKind& kind, const LoadRequest& request) {
  const Layers layers = layers_of(request);
  const json effective = json::parse(kind.effective(request));
  const std::vector<FieldRow> rows = kind.rows();
  Walk walk(layers, rows);
  walk.visit(effective, "", "");
  return walk.take();
}

}  // namespace fathom::config
