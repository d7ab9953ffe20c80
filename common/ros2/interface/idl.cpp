// Reads IDL as it stands in idl/ros2: modules, structures, their fields.

#include <cctype>
#include <optional>

#include "ros2/interface/description.hpp"

namespace fathom::ros2 {
namespace {

struct Token {
  std::string text;
  int line = 1;
};

/// Words, numbers, "::" and single signs; comments, preprocessor lines and annotations are left out.
std::vector<Token> tokens_of(std::string_view text) {
  std::vector<Token> out;
  int line = 1;
  const auto word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '\n') ++line;
    if (c == '#' || text.substr(at).starts_with("//")) {
      at = std::min(text.find('\n', at), text.size());
    } else if (c == '@') {
      for (++at; at < text.size() && word(text[at]);) ++at;
    } else if (word(c)) {
      const std::size_t begin = at;
      while (at < text.size() && word(text[at])) ++at;
      out.push_back({std::string(text.substr(begin, at - begin)), line});
    } else if (text.substr(at).starts_with("::")) {
      out.push_back({"::", line});
      at += 2;
    } else {
      if (std::isspace(static_cast<unsigned char>(c)) == 0) out.push_back({std::string(1, c), line});
      ++at;
    }
  }
  return out;
}

/// "geometry_msgs::msg::dds_::Pose_" or, inside its package, "Pose_".
std::string ros_name(const std::vector<std::string>& scope, const std::vector<std::string>& words) {
  std::vector<std::string> all = words;
  if (words.size() == 1) {
    all = scope;
    all.push_back(words.front());
  }
  std::string out;
  for (const std::string& word : all) {
    if (word == "dds_") continue;
    out += (out.empty() ? "" : "/") + word;
  }
  if (out.ends_with('_')) out.pop_back();
  return out;
}

/// Recursive descent; the first fault ends it.
class Parser {
 public:
  explicit Parser(std::string_view text) : tokens_(tokens_of(text)) {}

  Result<Interfaces> parse() {
    while (!fault_ && at_ < tokens_.size()) definition();
    if (fault_) return Error{*fault_};
    return std::move(found_);
  }

 private:
  [[nodiscard]] std::string_view now() const {
    return at_ < tokens_.size() ? std::string_view(tokens_[at_].text) : std::string_view();
  }
  void wrong(const std::string& expected) {
    if (fault_) return;
    const std::string is = at_ < tokens_.size() ? "is " + tokens_[at_].text : "the text ends";
    const int line = tokens_.empty() ? 1 : tokens_[std::min(at_, tokens_.size() - 1)].line;
    fault_ = "line " + std::to_string(line) + ": " + is + ", expected " + expected;
  }
  bool take(std::string_view text) {
    if (now() != text) return false;
    ++at_;
    return true;
  }
  void need(std::string_view text) {
    if (!take(text)) wrong(std::string(text));
  }
  std::string word(const char* what) {
    if (now().empty() || (std::isalpha(static_cast<unsigned char>(now().front())) == 0)) {
      wrong(what);
      return {};
    }
    return tokens_[at_++].text;
  }
  std::uint64_t number() {
    constexpr std::size_t kMostDigits = 9;
    std::uint64_t out = 0;
    const std::string_view text = now();
    bool good = !text.empty() && text.size() <= kMostDigits;
    for (const char c : text) {
      good = good && std::isdigit(static_cast<unsigned char>(c)) != 0;
      if (good) out = out * 10 + static_cast<std::uint64_t>(c - '0');
    }
    if (!good || out == 0) {
      wrong("a number above 0");
      return 0;
    }
    ++at_;
    return out;
  }

  void definition() {
    if (take("module")) {
      scope_.push_back(word("the name of a module"));
      need("{");
      while (!fault_ && at_ < tokens_.size() && now() != "}") definition();
      need("}");
      need(";");
      scope_.pop_back();
    } else if (take("struct")) {
      structure();
    } else {
      wrong("module or struct");
    }
  }

  void structure() {
    TypeDescription type;
    type.name = ros_name(scope_, {word("the name of a structure")});
    need("{");
    while (!fault_ && now() != "}") field(type);
    need("}");
    need(";");
    if (fault_) return;
    if (type.fields.empty()) return wrong("fields in " + type.name);
    if (!found_.emplace(type.name, type).second) wrong(type.name + " only once");
  }

  void field(TypeDescription& type) {
    FieldDescription one;
    if (take("sequence")) {
      need("<");
      element(one);
      one.container = Container::sequence;
      if (take(",")) {
        one.container = Container::bounded_sequence;
        one.capacity = number();
      }
      need(">");
    } else {
      element(one);
    }
    one.name = word("the name of a field");
    if (take("[")) {
      if (one.container != Container::none) return wrong("no array of sequences");
      one.container = Container::array;
      one.capacity = number();
      need("]");
    }
    need(";");
    type.fields.push_back(std::move(one));
  }

  void element(FieldDescription& out) {
    if (take("unsigned")) {
      if (take("short")) {
        out.basic = Basic::uint16;
      } else if (take("long")) {
        out.basic = take("long") ? Basic::uint64 : Basic::uint32;
      } else {
        wrong("short or long");
      }
      return;
    }
    const std::string first = word("a type");
    if (first == "string") {
      out.basic = Basic::string;
      if (!take("<")) return;
      out.basic = Basic::bounded_string;
      out.string_capacity = number();
      return need(">");
    }
    if (first == "long") {
      out.basic = take("long") ? Basic::int64 : Basic::int32;
      return;
    }
    static const std::map<std::string_view, Basic> kBasics{
        {"int8", Basic::int8},     {"uint8", Basic::uint8},     {"octet", Basic::byte},
        {"short", Basic::int16},   {"int16", Basic::int16},     {"uint16", Basic::uint16},
        {"int32", Basic::int32},   {"uint32", Basic::uint32},   {"int64", Basic::int64},
        {"uint64", Basic::uint64}, {"boolean", Basic::boolean}, {"float", Basic::float32},
        {"double", Basic::float64}};
    if (const auto known = kBasics.find(first); known != kBasics.end()) {
      out.basic = known->second;
      return;
    }
    std::vector<std::string> words{first};
    while (take("::")) words.push_back(word("a name"));
    out.basic = Basic::nested;
    out.nested_type = ros_name(scope_, words);
  }

  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::vector<std::string> scope_;
  Interfaces found_;
  std::optional<std::string> fault_;
};

}  // namespace

Result<Interfaces> parse_idl(std::string_view text) {
  return Parser(text).parse();
}

std::string dds_type_name(std::string_view type) {
  std::string out;
  std::size_t at = 0;
  for (std::size_t slash = 0; (slash = type.find('/', at)) != std::string_view::npos; at = slash + 1) {
    out.append(type.substr(at, slash - at)).append("::");
  }
  return out.append("dds_::").append(type.substr(at)).append("_");
}

}  // namespace fathom::ros2
