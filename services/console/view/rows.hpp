#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/time.hpp"

namespace fathom::console {

/// Rows of numbers are written by hand: ten minutes are a million of them, and building a tree of JSON values
/// first takes ten times as long as writing the text.
class Rows {
 public:
  explicit Rows(std::string& out) : out_(out) {}
  void number(double value, int digits = 6) {
    comma();
    if (!std::isfinite(value)) {
      out_ += "null";
      return;
    }
    std::array<char, 40> text{};
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits);
    out_.append(text.data(), end.ptr);
  }
  void instant(TimeNs utc_ns) {
    comma();
    out_ += std::to_string(utc_ns / kNsPerMillisecond);
  }
  void whole(std::int64_t value) {
    comma();
    out_ += std::to_string(value);
  }
  void text(std::string_view words) {
    comma();
    out_ += nlohmann::json(words).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  }
  void key(std::string_view name) {
    text(name);
    out_ += ':';
    first_ = true;
  }
  void open(char bracket) {
    comma();
    out_ += bracket;
    first_ = true;
  }
  void close(char bracket) {
    out_ += bracket;
    first_ = false;
  }
  void raw(std::string_view json) {
    comma();
    out_ += json;
  }

 private:
  void comma() {
    if (!first_) out_ += ',';
    first_ = false;
  }
  std::string& out_;
  bool first_ = true;
};

}  // namespace fathom::console
