#pragma once

// Fields of a configuration struct without any file format: key, unit, range, sentence. One function
// describes a struct, and whoever needs its fields walks it: the loader of files, the check of ranges, the
// documentation.
//
//   struct Link { std::string host; double timeout_s = 1.0; };
//   template <template <class> class Walk>
//   void describe(Walk<Link>& fields) {
//     fields.field("host", &Link::host, "address of the device").required();
//     fields.field("timeout_s", &Link::timeout_s, "given up after").unit("s").range(0.01, 60);
//   }
//
// A walk offers `field(key, member, sentence)`, which returns a FieldRef. The default of a field is that of
// the struct's member.

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fathom {

/// What is said of a field, whatever its type.
struct FieldInfo {
  std::string key;
  std::string sentence;
  std::string unit{};
  bool required = false;
  std::vector<std::string> only_for{};      ///< choices of the struct that know this key; empty: all
  std::vector<std::string> required_for{};  ///< choices that need it
  /// Of the field that decides which of the others mean something: its choices.
  std::vector<std::string> choices{};
  /// Likewise: the choice that a text of this field stands for, where there are other spellings.
  std::string (*choice_of)(const std::string& text) = nullptr;

  [[nodiscard]] bool decides() const { return !choices.empty(); }
  [[nodiscard]] bool known_to(const std::string& choice) const;
};

/// What a text may be.
enum class TextForm : std::uint8_t {
  free,           ///< anything without control characters
  optional_name,  ///< what is_name() accepts, or nothing
  name            ///< what is_name() accepts
};

/// What a value has to keep to. `L` is the type of a single value.
template <class L>
struct Rules {
  double low = -std::numeric_limits<double>::infinity();  ///< of the number as written in a file
  double high = std::numeric_limits<double>::infinity();
  double factor = 1.0;  ///< member = factor * number in a file
  bool nullable = false;
  TextForm text = TextForm::free;
  std::vector<std::pair<std::string, L>> words;
};

// What a container is made of in the end: the type that rules apply to.
template <class M>
struct LeafOf {
  using type = M;
};
template <class U>
struct LeafOf<std::vector<U>> : LeafOf<U> {};
template <class U, std::size_t N>
struct LeafOf<std::array<U, N>> : LeafOf<U> {};
template <class U>
struct LeafOf<std::optional<U>> : LeafOf<U> {};
template <class U>
struct LeafOf<std::map<std::string, U>> : LeafOf<U> {};
template <class M>
using Leaf = typename LeafOf<M>::type;

/// Handle to refine a field after naming it.
template <class M>
class FieldRef {
 public:
  FieldRef(FieldInfo& info, std::shared_ptr<Rules<Leaf<M>>> rules) : info_(&info), rules_(std::move(rules)) {}

  /// Inclusive bounds of the number as written in the file.
  FieldRef& range(double low, double high) {
    rules_->low = low;
    rules_->high = high;
    return *this;
  }
  /// Unit of the number in the file; the key ends in it as well.
  FieldRef& unit(std::string text) {
    info_->unit = std::move(text);
    return *this;
  }
  /// The file must give it: there is no safe default (frames, units, paths).
  FieldRef& required() {
    info_->required = true;
    return *this;
  }
  /// member = factor * number in the file; e.g. a key in degrees for a member in radians.
  FieldRef& scaled(double factor) {
    rules_->factor = factor;
    return *this;
  }
  /// null in the file means "unknown" (NaN); numbers only.
  FieldRef& nullable() {
    rules_->nullable = true;
    return *this;
  }
  /// A name (base/is_name.hpp).
  FieldRef& name() {
    rules_->text = TextForm::name;
    return *this;
  }
  /// A name or nothing.
  FieldRef& optional_name() {
    rules_->text = TextForm::optional_name;
    return *this;
  }
  /// The words of an enum, or the only strings allowed.
  FieldRef& words(std::vector<std::pair<std::string, Leaf<M>>> list) {
    rules_->words = std::move(list);
    return *this;
  }
  /// Its words decide which of the other fields mean something.
  FieldRef& decides() {
    for (const auto& [word, value] : rules_->words) info_->choices.push_back(word);
    return *this;
  }
  /// Likewise of a text with several spellings of each choice.
  FieldRef& decides(std::vector<std::string> choices, std::string (*choice_of)(const std::string&)) {
    info_->choices = std::move(choices);
    info_->choice_of = choice_of;
    return *this;
  }
  /// It means something for these choices of the deciding field, and is refused for others.
  FieldRef& only_for(std::vector<std::string> choices) {
    info_->only_for = std::move(choices);
    return *this;
  }
  /// These choices of the deciding field have no safe default.
  FieldRef& required_for(std::vector<std::string> choices) {
    info_->required_for = std::move(choices);
    return *this;
  }

 private:
  FieldInfo* info_;
  std::shared_ptr<Rules<Leaf<M>>> rules_;
};

/// A value that cannot be used. The key is a dotted path.
struct Complaint {
  std::string key;
  std::string value;
  std::string expectation;

  /// "KEY: VALUE: expected EXPECTATION"
  [[nodiscard]] std::string text() const { return key + ": " + value + ": expected " + expectation; }
};

/// " from 1 to 60", " of at least 1", or nothing where there is no bound.
[[nodiscard]] std::string range_text(double low, double high, bool integer);

/// "a, b, c"
[[nodiscard]] std::string list_words(const std::vector<std::string>& words);

}  // namespace fathom
