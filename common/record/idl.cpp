#include "record/idl.hpp"

#include <cctype>
#include <map>
#include <set>
#include <vector>

namespace fathom::record {
namespace {

constexpr std::string_view kModule = "fathom::v1::";

bool of_identifier(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// A definition: its text with the comments before it, and the words in it.
struct Definition {
  std::string name;
  std::string text;
  std::set<std::string> words;
};

/// Cuts the text of a file into the definitions of its module.
class Cutter {
 public:
  explicit Cutter(std::string_view text) : text_(text) {}

  std::vector<Definition> cut() {
    while (at_ < text_.size()) step();
    return std::move(found_);
  }

 private:
  void step() {
    const char c = text_[at_];
    if (text_.substr(at_).starts_with("//") || c == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else if (of_identifier(c)) {
      std::size_t end = at_;
      while (end < text_.size() && of_identifier(text_[end])) ++end;
      word(std::string(text_.substr(at_, end - at_)));
      at_ = end;
    } else {
      ++at_;
      if (c == '{') open();
      if (c == '}') close();
      if (c == ';') semicolon();
    }
  }

  void word(std::string word) {
    if (words_.empty() && word == "module") in_module_head_ = true;
    if (in_definition_ && name_.empty() && depth_ == modules_) name_ = word;
    if (depth_ == modules_ && (word == "struct" || word == "enum")) in_definition_ = true;
    words_.insert(std::move(word));
  }
  void open() {
    ++depth_;
    if (!in_module_head_) return;
    ++modules_;
    begin_anew();
  }
  void close() {
    if (depth_ == modules_ && modules_ > 0) --modules_;
    if (depth_ > 0) --depth_;
  }
  void semicolon() {
    if (depth_ != modules_) return;
    if (!name_.empty()) {
      std::string_view text = text_.substr(begin_, at_ - begin_);
      text.remove_prefix(std::min(text.find_first_not_of("\n "), text.size()));
      found_.push_back({name_, std::string(text), words_});
    }
    begin_anew();
  }
  void begin_anew() {
    begin_ = at_;
    words_.clear();
    name_.clear();
    in_module_head_ = in_definition_ = false;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t begin_ = 0;
  int depth_ = 0;
  int modules_ = 0;
  bool in_module_head_ = false;
  bool in_definition_ = false;
  std::string name_;
  std::set<std::string> words_;
  std::vector<Definition> found_;
};

}  // namespace

Result<std::string> self_contained_idl(std::span<const IdlFile> files, std::string_view type) {
  std::vector<Definition> all;
  for (const IdlFile& file : files) {
    for (Definition& one : Cutter(file.text).cut()) all.push_back(std::move(one));
  }
  std::set<std::string> wanted;
  const std::string name(type.starts_with(kModule) ? type.substr(kModule.size()) : type);
  wanted.insert(name);
  bool is_there = false;
  for (auto one = all.rbegin(); one != all.rend(); ++one) {  // a type comes after those it is made of
    if (!wanted.contains(one->name)) continue;
    is_there = is_there || one->name == name;
    wanted.insert(one->words.begin(), one->words.end());
  }
  if (!is_there) return Error{"no IDL file defines " + std::string(type)};
  std::string out = "module fathom {\nmodule v1 {\n\n";
  for (const Definition& one : all) {
    if (wanted.contains(one.name)) out += one.text + "\n\n";
  }
  return out + "};  // module v1\n};  // module fathom\n";
}

}  // namespace fathom::record
