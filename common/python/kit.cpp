#include "python/kit.hpp"

#include <limits>

namespace fathom::python {
namespace {

template <class E>
void add_enumeration(py::module_& module, Kit& kit) {
  py::dict members;
  for (std::size_t i = 0; i < Enumeration<E>::count; ++i) {
    members[text_of(to_string(static_cast<E>(i)))] = i;
  }
  py::object made =
      py::module_::import("enum").attr("Enum")(Enumeration<E>::name, members, py::arg("module") = "fathom");
  made.attr("__doc__") = Enumeration<E>::doc;
  module.attr(Enumeration<E>::name) = made;
  kit.enumerations[Enumeration<E>::slot] = made;
}

py::object integer_of(py::handle value, const std::string& where, const std::string& expected) {
  py::object out = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  if (!out) {
    PyErr_Clear();
    wrong_type(where, expected, value);
  }
  return out;
}

}  // namespace

KitPtr make_kit(py::module_& module) {
  auto kit = std::make_shared<Kit>();
  try {
    kit->numpy = py::module_::import("numpy");
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ImportError)) throw;
  }
  add_enumeration<NavMode>(module, *kit);
  add_enumeration<AlignmentPhase>(module, *kit);
  add_enumeration<Severity>(module, *kit);
  add_enumeration<Presence>(module, *kit);
  return kit;
}

void wrong_type(const std::string& where, const std::string& expected, py::handle got) {
  throw py::type_error(where + ": expected " + expected + ", got " + Py_TYPE(got.ptr())->tp_name);
}

void wrong_value(const std::string& where, const std::string& expected, py::handle got) {
  throw py::value_error(where + ": expected " + expected + ", got " + std::string(py::repr(got)));
}

py::str text_of(std::string_view bytes) {
  PyObject* text = PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace");
  if (text == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(text);
}

double number_from(py::handle value, const std::string& where) {
  const double out = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() != nullptr) {
    const bool too_large = PyErr_ExceptionMatches(PyExc_OverflowError) != 0;
    PyErr_Clear();
    if (too_large) wrong_value(where, "a number that a float can hold", value);
    wrong_type(where, "a number", value);
  }
  return out;
}

bool truth_from(py::handle value, const std::string& where) {
  if (!py::isinstance<py::bool_>(value)) wrong_type(where, "True or False", value);
  return value.ptr() == Py_True;
}

std::string text_from(py::handle value, const std::string& where, std::size_t most_bytes) {
  if (!py::isinstance<py::str>(value)) wrong_type(where, "a str", value);
  Py_ssize_t size = 0;
  const char* bytes = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
  if (bytes == nullptr) {
    PyErr_Clear();
    wrong_value(where, "text that UTF-8 can say", value);
  }
  std::string out(bytes, static_cast<std::size_t>(size));
  if (out.size() > most_bytes)
    wrong_value(where, "at most " + std::to_string(most_bytes) + " bytes of UTF-8", value);
  if (out.find('\0') != std::string::npos) wrong_value(where, "text without a zero byte", value);
  return out;
}

std::int64_t signed_from(py::handle value, const std::string& where) {
  const py::object whole = integer_of(value, where, "an int");
  const std::int64_t out = PyLong_AsLongLong(whole.ptr());
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    wrong_value(where, "an int of 64 bits", value);
  }
  return out;
}

std::uint64_t unsigned_from(py::handle value, const std::string& where, std::uint64_t most) {
  const py::object whole = integer_of(value, where, "an int");
  const std::uint64_t out = PyLong_AsUnsignedLongLong(whole.ptr());
  const bool outside = PyErr_Occurred() != nullptr;
  PyErr_Clear();
  if (outside || out > most) wrong_value(where, "an int from 0 to " + std::to_string(most), value);
  return out;
}

py::tuple items_from(py::handle value, const std::string& where, const std::string& expected) {
  if (py::isinstance<py::str>(value) || py::isinstance<py::bytes>(value) ||
      PySequence_Check(value.ptr()) == 0) {
    wrong_type(where, expected, value);
  }
  PyObject* items = PySequence_Tuple(value.ptr());
  if (items == nullptr) {
    PyErr_Clear();
    wrong_type(where, expected, value);
  }
  return py::reinterpret_steal<py::tuple>(items);
}

void numbers_from(py::handle value, const std::string& where, double* out, std::size_t count) {
  const std::string expected = std::to_string(count) + " numbers";
  const py::tuple items = items_from(value, where, expected);
  if (items.size() != count) wrong_value(where, expected, value);
  for (std::size_t i = 0; i < count; ++i)
    out[i] = number_from(items[i], where + "[" + std::to_string(i) + "]");
}

void rows_from(py::handle value, const std::string& where, double* out) {
  const std::string expected = "3 rows of 3 numbers";
  const py::tuple rows = items_from(value, where, expected);
  if (rows.size() != 3) wrong_value(where, expected, value);
  for (std::size_t i = 0; i < 3; ++i)
    numbers_from(rows[i], where + "[" + std::to_string(i) + "]", out + 3 * i, 3);
}

py::object array_of(const Kit& kit, const double* values, std::size_t count) {
  if (!kit.numpy.is_none()) {
    // Over bytes of its own: numpy does not write to those.
    const py::bytes bytes(reinterpret_cast<const char*>(values), count * sizeof(double));
    py::object array = kit.numpy.attr("frombuffer")(bytes, "f8");
    return count == 9 ? array.attr("reshape")(3, 3) : array;
  }
  if (count == 9) {
    return py::make_tuple(array_of(kit, values, 3), array_of(kit, values + 3, 3),
                          array_of(kit, values + 6, 3));
  }
  py::tuple out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = py::float_(values[i]);
  return out;
}

}  // namespace fathom::python
