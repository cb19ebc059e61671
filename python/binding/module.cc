// SPDX-License-Identifier: Apache-2.0
#include "python/binding/binding.h"

PYBIND11_MODULE(_native, module) {
  module.doc() =
      "The C++ of gaitd that the package uses. No part of its interface: use the package.";
  module.attr("version") = GAITD_VERSION;
  gaitd::python::bind_log(module);
  gaitd::python::bind_model(module);
  gaitd::python::bind_connection(module);
}
