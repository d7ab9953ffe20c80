#include "logs/ros2/schema.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <utility>

namespace fathom::logs::ros2 {
namespace {

constexpr std::size_t kMostElements = 1'000'000'000;
constexpr std::size_t kShown = 60;  // characters of the text that an error repeats

struct Named {
  std::string_view word;
  Basic type;
};
constexpr std::array<Named, 14> kBasics{{{"bool", Basic::boolean},
                                         {"byte", Basic::u8},
                                         {"char", Basic::u8},
                                         {"int8", Basic::i8},
                                         {"uint8", Basic::u8},
                                         {"int16", Basic::i16},
                                         {"uint16", Basic::u16},
                                         {"int32", Basic::i32},
                                         {"uint32", Basic::u32},
                                         {"int64", Basic::i64},
                                         {"uint64", Basic::u64},
                                         {"float32", Basic::f32},
                                         {"float64", Basic::f64},
                                         {"string", Basic::string}}};

/// A line of a definition, not yet resolved.
struct Line {
  std::size_t number = 0;
  std::string type;
  Node node;
};
struct Definition {
  std::vector<Line> lines;
};

Node number(const char* name, Basic basic) {
  Node node;
  node.name = name;
  node.basic = basic;
  return node;
}

bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}
std::string_view trimmed(std::string_view text) {
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}
bool of_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}
std::optional<std::size_t> whole(std::string_view text) {
  std::size_t value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end != text.data() + text.size() || value > kMostElements) return std::nullopt;
  return value;
}

std::string in_quotes(std::string_view text) {
  return "'" + std::string(text.substr(0, kShown)) + "'";
}

/// "[]", "[N]", "[<=N]" at the end of a type.
std::string take_array(std::string_view& type, Node& node) {
  if (type.empty() || type.back() != ']') return {};
  const std::size_t open = type.rfind('[');
  if (open == std::string_view::npos) return "a ] without its [";
  std::string_view inside = type.substr(open + 1, type.size() - open - 2);
  type = type.substr(0, open);
  node.array = Node::Array::fixed;
  if (inside.empty() || inside.starts_with("<=")) {
    node.array = Node::Array::sequence;
    node.count = 0;
    if (inside.empty()) return {};
    node.bounded = true;
    inside.remove_prefix(2);
  }
  const auto count = whole(inside);
  if (!count || *count == 0) return "its array has no size, expected a number above 0";
  node.count = *count;
  return {};
}

/// A field of one line; nothing for a blank line, a comment, a constant.
Result<std::optional<Line>> parse_line(std::string_view text, std::size_t number) {
  using Answer = std::optional<Line>;
  text = trimmed(text);
  if (text.empty() || text.front() == '#') return Answer{};
  const auto fail = [&](const std::string& why) {
    return Error{"line " + std::to_string(number) + ": " + in_quotes(text) + ": " + why};
  };
  const std::size_t gap = text.find_first_of(" \t");
  if (gap == std::string_view::npos) return fail("expected a type and a name");
  Line line{number, {}, {}};
  std::string_view type = text.substr(0, gap);
  std::string_view rest = trimmed(text.substr(gap));
  std::size_t length = 0;
  while (length < rest.size() && of_name(rest[length])) ++length;
  line.node.name = rest.substr(0, length);
  rest = trimmed(rest.substr(length));
  if (rest.starts_with('=')) return Answer{};  // a constant: not in the bytes
  if (length == 0) return fail("expected a name behind the type");
  if (const std::string why = take_array(type, line.node); !why.empty()) return fail(why);
  if (const std::size_t bound = type.find("<="); bound != std::string_view::npos) {
    const auto longest = whole(type.substr(bound + 2));
    type = type.substr(0, bound);
    if (!longest || type != "string") return fail("expected string<=N");
    line.node.longest = *longest;
  }
  if (type == "wstring") return fail("wstring has no one form in CDR and is not read");
  if (!std::all_of(type.begin(), type.end(), [](char c) { return of_name(c) || c == '/'; }) || type.empty())
    return fail("that is no type");
  line.type = type;
  for (const Named& one : kBasics) {
    if (one.word == type) line.node.basic = one.type;
  }
  return Answer{std::move(line)};
}

class Parser {
 public:
  Parser(std::string_view type, std::size_t kept) : kept_(kept) { out_.type = short_type(type); }

  Result<Schema> parse(std::string_view text) {
    if (text.size() > kLongestText)
      return Error{"a text of " + std::to_string(text.size()) + " bytes, expected at most " +
                   std::to_string(kLongestText)};
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
      return Error{"its text is empty: what recorded it did not find the definition"};
    if (std::string why = split(text); !why.empty()) return Error{why};
    if (std::string why = resolve(out_.type, out_.root, 0); !why.empty()) return Error{why};
    name_all(out_.root, "");
    return std::move(out_);
  }

 private:
  // Lines to definitions.
  std::string split(std::string_view text) {
    std::string name = out_.type;
    bool expects_name = false;
    Definition* now = &definitions_[name];
    for (std::size_t number = 1; !text.empty(); ++number) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      const std::string_view bare = trimmed(line);
      if (bare.size() >= 3 && bare.find_first_not_of('=') == std::string_view::npos) {
        expects_name = true;
        continue;
      }
      if (expects_name && !bare.empty()) {
        if (!bare.starts_with("MSG:"))
          return "line " + std::to_string(number) + ": " + in_quotes(bare) + ": expected MSG: and a type";
        name = short_type(trimmed(bare.substr(4)));
        now = &definitions_[name];
        *now = {};
        expects_name = false;
        continue;
      }
      auto found = parse_line(line, number);
      if (!found) return found.error().message;
      if (found.value()) now->lines.push_back(std::move(*found.value()));
    }
    return {};
  }

  // The definition of a word as it is used in a message of `package`.
  [[nodiscard]] const Definition* find(const std::string& word, std::string_view owner, std::string& name) {
    name = short_type(word);
    if (name == "Header") name = "std_msgs/Header";
    if (name == "time") name = "builtin_interfaces/Time";
    if (name == "duration") name = "builtin_interfaces/Duration";
    if (name.find('/') == std::string::npos) name = std::string(owner.substr(0, owner.find('/') + 1)) + name;
    const auto found = definitions_.find(name);
    if (found != definitions_.end()) return &found->second;
    if (name != "builtin_interfaces/Time" && name != "builtin_interfaces/Duration") return nullptr;
    Definition& made = definitions_[name];
    made.lines.push_back({0, "int32", number("sec", Basic::i32)});
    made.lines.push_back({0, "uint32", number("nanosec", Basic::u32)});
    return &made;
  }

  // Fills the members of a message and what they count.
  std::string resolve(const std::string& name, Node& message, std::size_t depth) {
    if (depth >= kDeepest)
      return name + ": messages within messages, deeper than " + std::to_string(kDeepest) +
             " or one within itself";
    const Definition& definition = definitions_.at(name);
    for (const Line& line : definition.lines) {
      if (++nodes_ > kMostNodes) return name + ": more than " + std::to_string(kMostNodes) + " fields";
      Node node = line.node;
      node.kept = node.array == Node::Array::none    ? 1
                  : node.array == Node::Array::fixed ? node.count
                  : node.bounded                     ? std::min(node.count, kept_)
                                                     : kept_;
      if (node.basic) {
        (*node.basic == Basic::string ? node.texts : node.columns) = 1;
      } else {
        std::string inner;
        if (find(line.type, name, inner) == nullptr)
          return "line " + std::to_string(line.number) + ": field " + node.name + ": type " +
                 in_quotes(line.type) +
                 " is not defined, expected a basic type or a definition behind MSG: " + in_quotes(inner);
        if (std::string why = resolve(inner, node, depth + 1); !why.empty()) return why;
      }
      // Held against the limit before it is multiplied: none of these overflows.
      if (node.kept > kMostColumns || node.columns * node.kept > kMostColumns ||
          node.texts * node.kept > kMostColumns)
        return too_large(name, node.name);
      message.columns += node.columns * node.kept + (node.array == Node::Array::sequence ? 1 : 0);
      message.texts += node.texts * node.kept;
      if (message.columns > kMostColumns || message.texts > kMostColumns) return too_large(name, node.name);
      message.members.push_back(std::move(node));
    }
    if (definition.lines.empty()) {
      // An empty structure has one byte on the wire.
      message.members.push_back(number("structure_needs_at_least_one_member", Basic::u8));
      message.members.back().columns = 1;
      message.columns = 1;
    }
    return {};
  }
  static std::string too_large(const std::string& type, const std::string& field) {
    return type + ": field " + field + ": more than " + std::to_string(kMostColumns) + " numbers a message";
  }

  void name_all(const Node& message, const std::string& prefix) {
    for (const Node& node : message.members) {
      const std::string label = prefix + node.name;
      if (node.array == Node::Array::sequence) out_.columns.push_back(label + ".length");
      for (std::size_t i = 0; i < node.kept; ++i) {
        const std::string one =
            node.array == Node::Array::none ? label : label + "[" + std::to_string(i) + "]";
        if (!node.basic) {
          name_all(node, one + ".");
        } else {
          (*node.basic == Basic::string ? out_.texts : out_.columns).push_back(one);
        }
      }
    }
  }

  std::size_t kept_;
  std::size_t nodes_ = 0;
  std::map<std::string, Definition> definitions_;
  Schema out_;
};

}  // namespace

std::size_t size_of(Basic type) {
  switch (type) {
    case Basic::boolean:
    case Basic::i8:
    case Basic::u8:
      return 1;
    case Basic::i16:
    case Basic::u16:
      return 2;
    case Basic::i64:
    case Basic::u64:
    case Basic::f64:
      return 8;
    case Basic::i32:
    case Basic::u32:
    case Basic::f32:
    case Basic::string:  // its length
      return 4;
  }
  return 1;
}

std::string short_type(std::string_view name) {
  const std::size_t first = name.find('/');
  const std::size_t last = name.rfind('/');
  if (first == std::string_view::npos || first == last) return std::string(name);
  return std::string(name.substr(0, first)) + std::string(name.substr(last));
}

Result<Schema> parse(std::string_view type, std::string_view text, std::size_t kept) {
  return Parser(type, kept).parse(text);
}

}  // namespace fathom::logs::ros2
