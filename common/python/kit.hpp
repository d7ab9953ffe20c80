#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include <pybind11/pybind11.h>

#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"

namespace fathom::python {

namespace py = pybind11;

/// The enumerations that cross over: how they are called, and how many values they have.
template <class E>
struct Enumeration;
template <>
struct Enumeration<NavMode> {
  static constexpr std::size_t slot = 0, count = 6;
  static constexpr const char* name = "NavMode";
  static constexpr const char* doc = "What the navigation state rests on right now.";
};
template <>
struct Enumeration<AlignmentPhase> {
  static constexpr std::size_t slot = 1, count = 8;
  static constexpr const char* name = "AlignmentPhase";
  static constexpr const char* doc = "How far alignment has come.";
};
template <>
struct Enumeration<Severity> {
  static constexpr std::size_t slot = 2, count = 3;
  static constexpr const char* name = "Severity";
  static constexpr const char* doc = "How bad what an alarm says is.";
};
template <>
struct Enumeration<Presence> {
  static constexpr std::size_t slot = 3, count = 4;
  static constexpr const char* name = "Presence";
  static constexpr const char* doc = "Whether a stream or a service is heard.";
};

template <class E>
concept Enumerated = requires {
  Enumeration<E>::slot;
};

/// What conversions need of Python: numpy where it is there, and the enumerations.
struct Kit {
  py::object numpy = py::none();
  std::array<py::object, 4> enumerations{};
};
using KitPtr = std::shared_ptr<const Kit>;

/// Makes the enumerations in `module`, and looks for numpy.
[[nodiscard]] KitPtr make_kit(py::module_& module);

/// "WHERE: expected EXPECTED, got GOT" as TypeError, naming the type of what was given; as ValueError, naming
/// it.
[[noreturn]] void wrong_type(const std::string& where, const std::string& expected, py::handle got);
[[noreturn]] void wrong_value(const std::string& where, const std::string& expected, py::handle got);

/// Text of the network, whatever its bytes are.
[[nodiscard]] py::str text_of(std::string_view bytes);

// Python to C++, each with a sentence for what does not fit.
[[nodiscard]] double number_from(py::handle value, const std::string& where);
[[nodiscard]] bool truth_from(py::handle value, const std::string& where);
[[nodiscard]] std::string text_from(py::handle value, const std::string& where, std::size_t most_bytes);
[[nodiscard]] std::int64_t signed_from(py::handle value, const std::string& where);
[[nodiscard]] std::uint64_t unsigned_from(py::handle value, const std::string& where, std::uint64_t most);
/// A list, a tuple or whatever has items and a length; no text. `expected` says of what.
[[nodiscard]] py::tuple items_from(py::handle value, const std::string& where, const std::string& expected);
void numbers_from(py::handle value, const std::string& where, double* out, std::size_t count);
void rows_from(py::handle value, const std::string& where, double* out);

/// An array of numpy that cannot be written to, else a tuple. With 9 values: three rows.
[[nodiscard]] py::object array_of(const Kit& kit, const double* values, std::size_t count);

}  // namespace fathom::python
