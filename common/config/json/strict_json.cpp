#include "config/json/strict_json.hpp"

#include <algorithm>
#include <vector>

namespace fathom::config {
namespace {

using nlohmann::json;

std::string shortened(const std::string& text, std::size_t most) {
  return text.size() <= most ? text : text.substr(0, most - 3) + "...";
}

/// Builds the value from the parser's events. An event that returns false ends the parse.
class Builder : public nlohmann::json_sax<json> {
 public:
  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(number_integer_t value) override { return put(value); }
  bool number_unsigned(number_unsigned_t value) override { return put(value); }
  bool number_float(number_float_t value, const string_t&) override { return put(value); }
  bool string(string_t& value) override { return put(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // JSON text has none
  bool start_object(std::size_t) override { return open(json::object()); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    const bool twice = open_.back().value->contains(name);
    open_.back().key = std::move(name);
    return !twice || fail(JsonFault::Kind::duplicate, "given twice", "each key once");
  }

  bool parse_error(std::size_t position, const std::string& last_token,
                   const nlohmann::detail::exception& error) override {
    constexpr int kNumberOverflow = 406;
    if (error.id == kNumberOverflow) {
      if (!open_.empty()) ++open_.back().index;
      return fail(JsonFault::Kind::number, shortened(one_line(last_token), 60),
                  "a number between -1.8e308 and 1.8e308");
    }
    std::string words = error.what();
    if (const auto at = words.find("syntax error"); at != std::string::npos) words = words.substr(at);
    position_ = position;
    return fail(JsonFault::Kind::syntax, shortened(one_line(words), 300), "");
  }

  [[nodiscard]] StrictJson take(std::string_view text) {
    if (!fault_) return {std::move(root_), std::nullopt};
    const std::size_t before = std::min(position_ > 0 ? position_ - 1 : 0, text.size());
    fault_->line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(before), '\n');
    return {nullptr, std::move(fault_)};
  }

 private:
  struct Level {
    json* value = nullptr;
    std::string key;            // of an object: the newest
    std::ptrdiff_t index = -1;  // of an array: the newest element
  };

  json* place(json value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Level& level = open_.back();
    if (level.value->is_array()) {
      ++level.index;
      level.value->push_back(std::move(value));
      return &level.value->back();
    }
    return &((*level.value)[level.key] = std::move(value));
  }

  bool put(json value) {
    place(std::move(value));
    return true;
  }

  bool open(json container) {
    if (open_.size() >= kJsonLevels) {
      ++open_.back().index;
      return fail(JsonFault::Kind::depth, "nested deeper",
                  "at most " + std::to_string(kJsonLevels) + " levels of objects and arrays");
    }
    open_.push_back({place(std::move(container)), "", -1});
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  bool fail(JsonFault::Kind kind, std::string is, std::string expectation) {
    std::string path;
    for (const Level& level : open_) {
      const bool array = level.value->is_array();
      if (array && level.index < 0) continue;
      if (!array && level.key.empty()) continue;
      if (!path.empty()) path += '.';
      path += array ? std::to_string(level.index) : shortened(one_line(level.key), 40);
    }
    fault_ = JsonFault{kind, shortened(path, 200), std::move(is), std::move(expectation), 1};
    return false;
  }

  json root_;
  std::vector<Level> open_;
  std::optional<JsonFault> fault_;
  std::size_t position_ = 0;
};

}  // namespace

StrictJson parse_strict(std::string_view text) {
  Builder builder;
  (void)json::sax_parse(text.begin(), text.end(), &builder);
  return builder.take(text);
}

std::string describe(const JsonFault& fault) {
  if (fault.kind == JsonFault::Kind::syntax) return fault.is;
  return (fault.key.empty() ? "(whole text)" : fault.key) + ": is " + fault.is + ", expected " +
         fault.expectation;
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text;
}

}  // namespace fathom::config
