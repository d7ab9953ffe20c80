#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace fathom {

/// What was wrong and what was expected, in one sentence for a human.
struct Error {
  std::string message;
};

/// A value or the reason why there is none. For input that may be bad at run time; configuration throws
/// instead.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool ok() const { return std::holds_alternative<T>(state_); }
  explicit operator bool() const { return ok(); }
  /// Precondition: ok().
  [[nodiscard]] const T& value() const {
    assert(ok());
    return std::get<T>(state_);
  }
  [[nodiscard]] T& value() {
    assert(ok());
    return std::get<T>(state_);
  }
  /// Precondition: !ok().
  [[nodiscard]] const Error& error() const {
    assert(!ok());
    return std::get<Error>(state_);
  }

 private:
  std::variant<T, Error> state_;
};

}  // namespace fathom
