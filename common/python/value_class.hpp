#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "base/name.hpp"
#include "python/kit.hpp"

namespace fathom::python {

/// How a type crosses over: `out` to Python, `in` from it, `type` as type hints say it, `same` with NaN equal
/// to NaN. This one is for types that are a ValueClass themselves.
template <class M>
struct Crossing {
  static std::string type() { return py::str(py::type::of<M>().attr("__name__")); }
  static py::object out(const Kit&, const M& value) { return py::cast(value); }
  static M in(const Kit&, py::handle value, const std::string& where) {
    if (!py::isinstance<M>(value)) wrong_type(where, "a fathom." + type(), value);
    return value.cast<M>();
  }
  static bool same(const M& a, const M& b) { return py::cast(a).equal(py::cast(b)); }
};

template <class M>
struct PlainCrossing {
  static bool same(const M& a, const M& b) { return a == b; }
};

template <>
struct Crossing<double> {
  static std::string type() { return "float"; }
  static py::object out(const Kit&, double value) { return py::float_(value); }
  static double in(const Kit&, py::handle value, const std::string& where) {
    return number_from(value, where);
  }
  static bool same(double a, double b) { return a == b || (a != a && b != b); }
};

template <>
struct Crossing<bool> : PlainCrossing<bool> {
  static std::string type() { return "bool"; }
  static py::object out(const Kit&, bool value) { return py::bool_(value); }
  static bool in(const Kit&, py::handle value, const std::string& where) { return truth_from(value, where); }
};

template <>
struct Crossing<std::int64_t> : PlainCrossing<std::int64_t> {
  static std::string type() { return "int"; }
  static py::object out(const Kit&, std::int64_t value) { return py::int_(value); }
  static std::int64_t in(const Kit&, py::handle value, const std::string& where) {
    return signed_from(value, where);
  }
};

template <class U>
struct UnsignedCrossing : PlainCrossing<U> {
  static std::string type() { return "int"; }
  static py::object out(const Kit&, U value) { return py::int_(value); }
  static U in(const Kit&, py::handle value, const std::string& where) {
    return static_cast<U>(unsigned_from(value, where, std::numeric_limits<U>::max()));
  }
};
template <>
struct Crossing<std::uint32_t> : UnsignedCrossing<std::uint32_t> {};
template <>
struct Crossing<std::uint64_t> : UnsignedCrossing<std::uint64_t> {};

template <>
struct Crossing<std::string> : PlainCrossing<std::string> {
  static std::string type() { return "str"; }
  static py::object out(const Kit&, const std::string& value) { return text_of(value); }
  static std::string in(const Kit&, py::handle value, const std::string& where) {
    return text_from(value, where, std::numeric_limits<std::uint16_t>::max());
  }
};

template <>
struct Crossing<Name> : PlainCrossing<Name> {
  static std::string type() { return "str"; }
  static py::object out(const Kit&, const Name& value) { return text_of(value.view()); }
  static Name in(const Kit&, py::handle value, const std::string& where) {
    return {std::string_view(text_from(value, where, Name::kCapacity))};
  }
};

/// Zero-terminated text.
template <std::size_t N>
struct Crossing<std::array<char, N>> : PlainCrossing<std::array<char, N>> {
  static std::string type() { return "str"; }
  static py::object out(const Kit&, const std::array<char, N>& value) {
    return text_of({value.data(),
                    static_cast<std::size_t>(std::find(value.begin(), value.end(), '\0') - value.begin())});
  }
  static std::array<char, N> in(const Kit&, py::handle value, const std::string& where) {
    const std::string text = text_from(value, where, N - 1);
    std::array<char, N> out{};
    std::copy(text.begin(), text.end(), out.begin());
    return out;
  }
};

/// Vectors and quaternions; nine are the rows of a matrix.
template <std::size_t N>
struct Crossing<std::array<double, N>> {
  static std::string type() { return "Array"; }
  static py::object out(const Kit& kit, const std::array<double, N>& value) {
    return array_of(kit, value.data(), N);
  }
  static std::array<double, N> in(const Kit&, py::handle value, const std::string& where) {
    std::array<double, N> out{};
    if constexpr (N == 9) {
      rows_from(value, where, out.data());
    } else {
      numbers_from(value, where, out.data(), N);
    }
    return out;
  }
  static bool same(const std::array<double, N>& a, const std::array<double, N>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), Crossing<double>::same);
  }
};

template <class M>
struct Crossing<std::vector<M>> {
  static std::string type() { return "tuple[" + Crossing<M>::type() + ", ...]"; }
  static py::object out(const Kit& kit, const std::vector<M>& value) {
    py::tuple out(value.size());
    for (std::size_t i = 0; i < value.size(); ++i) out[i] = Crossing<M>::out(kit, value[i]);
    return out;
  }
  static std::vector<M> in(const Kit& kit, py::handle value, const std::string& where) {
    std::vector<M> out;
    const py::tuple items = items_from(value, where, "a list of " + Crossing<M>::type());
    for (std::size_t i = 0; i < items.size(); ++i) {
      out.push_back(Crossing<M>::in(kit, items[i], where + "[" + std::to_string(i) + "]"));
    }
    return out;
  }
  static bool same(const std::vector<M>& a, const std::vector<M>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), Crossing<M>::same);
  }
};

template <Enumerated E>
struct Crossing<E> : PlainCrossing<E> {
  static std::string type() { return Enumeration<E>::name; }
  static py::object out(const Kit& kit, E value) {
    return kit.enumerations[Enumeration<E>::slot](static_cast<unsigned>(value));
  }
  static E in(const Kit& kit, py::handle value, const std::string& where) {
    if (!py::isinstance(value, kit.enumerations[Enumeration<E>::slot]))
      wrong_type(where, "a fathom." + type(), value);
    return static_cast<E>(value.attr("value").cast<unsigned>());
  }
};

/// A plain value as an immutable Python class. Each field is named once; its property, its place in the
/// constructor, repr, comparison, pickling and the type hints follow.
template <class T>
class ValueClass {
 public:
  /// `label`: how messages call it.
  ValueClass(py::module_& module, KitPtr kit, const char* name, const char* doc, std::string label = "")
      : kit_(std::move(kit)), label_(label.empty() ? name : std::move(label)), class_(module, name, doc) {
    class_.attr("__module__") = "fathom";
  }

  template <class M>
  ValueClass& field(const char* name, M T::*member, const char* doc) {
    return field(
        name, Crossing<M>::type(),
        [member](const Kit& kit, const T& value) { return Crossing<M>::out(kit, value.*member); },
        [member](const Kit& kit, T& value, py::handle given, const std::string& where) {
          value.*member = Crossing<M>::in(kit, given, where);
        },
        [member](const T& a, const T& b) { return Crossing<M>::same(a.*member, b.*member); }, doc);
  }

  using Get = std::function<py::object(const Kit&, const T&)>;
  using Set = std::function<void(const Kit&, T&, py::handle, const std::string& where)>;
  using Same = std::function<bool(const T&, const T&)>;

  ValueClass& field(const char* name, const std::string& type, Get get, Set set, Same same, const char* doc) {
    auto made = std::make_shared<const Field>(Field{name, std::move(get), std::move(set), std::move(same)});
    fields_->push_back(made);
    annotations_[name] = type;
    class_.def_property_readonly(
        name, [made, kit = kit_](const T& value) { return made->get(*kit, value); }, doc);
    return *this;
  }

  void done() {
    class_.attr("__annotations__") = annotations_;
    const auto make = [fields = fields_, kit = kit_, label = label_](const py::dict& given) {
      T value{};
      for (const auto& [key, item] : given)
        set(*fields, *kit, label, value, key.template cast<std::string>(), item);
      return value;
    };
    const auto state = [fields = fields_, kit = kit_](const T& value) {
      py::dict out;
      for (const auto& field : *fields) out[field->name.c_str()] = field->get(*kit, value);
      return out;
    };
    class_.def(py::init([make, label = label_](const py::args& args, const py::kwargs& kwargs) {
      if (!args.empty()) throw py::type_error(label + ": expected named values only, got one without a name");
      return make(kwargs);
    }));
    class_.def("__repr__", [state, label = label_](const T& value) {
      py::list parts;
      for (const auto& [key, item] : state(value)) parts.append(py::str(key) + py::str("=") + py::repr(item));
      return py::str(label + "(") + py::str(", ").attr("join")(parts) + py::str(")");
    });
    class_.def("__eq__", [fields = fields_](const T& a, py::handle other) -> py::object {
      if (!py::isinstance<T>(other)) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
      const T& b = other.cast<const T&>();
      return py::bool_(
          std::all_of(fields->begin(), fields->end(), [&](const auto& field) { return field->same(a, b); }));
    });
    class_.def(py::pickle(state, make));
  }

 private:
  struct Field {
    std::string name;
    Get get;
    Set set;
    Same same;
  };
  using Fields = std::vector<std::shared_ptr<const Field>>;

  static void set(const Fields& fields, const Kit& kit, const std::string& label, T& value,
                  const std::string& name, py::handle given) {
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const auto& field) { return field->name == name; });
    if (found != fields.end()) return (*found)->set(kit, value, given, label + "." + name);
    std::string known;
    for (const auto& field : fields) known += (known.empty() ? "" : ", ") + field->name;
    throw py::type_error(label + ": has no " + name + ", expected one of " + known);
  }

  KitPtr kit_;
  std::string label_;
  py::class_<T> class_;
  py::dict annotations_;
  std::shared_ptr<Fields> fields_ = std::make_shared<Fields>();
};

}  // namespace fathom::python
