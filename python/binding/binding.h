// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

// The parts of the module gaitd._native. What they raise is RuntimeError with a text for people;
// the modules in Python make of it the errors that users meet.
namespace gaitd::python {

void bind_log(pybind11::module_& module);
void bind_model(pybind11::module_& module);
void bind_connection(pybind11::module_& module);

}  // namespace gaitd::python
