// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "cli/rpc_client.h"
#include "daemon/server/rights.h"
#include "python/binding/binding.h"

namespace gaitd::python {
namespace {

namespace py = pybind11;

// A connected descriptor, which then belongs to the caller, and the path of its socket.
std::pair<int, std::string> connect(const std::string& socket, const std::string& role) {
  const auto found = std::ranges::find(daemon::kRoleNames, role);
  if (found == daemon::kRoleNames.end()) {
    throw py::value_error("role '" + role + "': expected observe, command or administer");
  }
  const auto wanted = static_cast<daemon::Role>(found - daemon::kRoleNames.begin());
  std::string reached;
  std::string error;
  int descriptor = -1;
  {
    const py::gil_scoped_release others_run;
    descriptor = cli::connect_to_gaitd(cli::Destination::of(socket, wanted), &reached, &error);
  }
  if (descriptor < 0) throw std::runtime_error(error);
  return {descriptor, reached};
}

}  // namespace

void bind_connection(py::module_& module) {
  module.def("connect", &connect, py::arg("socket"), py::arg("role"));
}

}  // namespace gaitd::python
