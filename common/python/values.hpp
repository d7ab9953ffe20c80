#pragma once

#include "python/kit.hpp"

namespace fathom::python {

/// The plain values of the client: samples, health, limits, routes.
void add_values(py::module_& module, const KitPtr& kit);

}  // namespace fathom::python
