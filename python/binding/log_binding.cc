// SPDX-License-Identifier: Apache-2.0
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "daemon/config/issues.h"
#include "daemon/config/scenario.h"
#include "daemon/log/column_log.h"
#include "daemon/log/glob.h"
#include "daemon/verdict/verdict.h"
#include "python/binding/binding.h"

namespace gaitd::python {
namespace {

namespace py = pybind11;
using Kind = daemon::SignalDescription::Kind;

class Log {
 public:
  Log(const std::string& path, bool keep) : path_(path) {
    const py::gil_scoped_release others_run;
    std::string error;
    log_ = daemon::open_by_columns(path, keep, &error);
    if (log_.columns == nullptr) throw std::runtime_error(error);
  }

  const std::string& info() const { return columns().info(); }
  const std::string& columns_file() const { return log_.file; }
  bool read_anew() const { return log_.read_anew; }
  std::uint64_t rows() const { return columns().rows(); }

  // name, kind, unit, words
  std::vector<std::tuple<std::string, std::string, std::string, std::vector<std::string>>> table()
      const {
    static constexpr std::array kKinds = {"real", "integer", "boolean", "enumeration"};
    std::vector<std::tuple<std::string, std::string, std::string, std::vector<std::string>>> table;
    for (const auto& signal : columns().signals()) {
      table.emplace_back(signal.name, kKinds[static_cast<std::size_t>(signal.kind)], signal.unit,
                         signal.words);
    }
    return table;
  }

  py::array_t<double> read(std::size_t signal, std::uint64_t first, std::uint64_t count,
                           std::uint64_t step) const {
    const bool there =
        signal < columns().signals().size() && step > 0 &&
        (count == 0 || (first < rows() && (count - 1) <= (rows() - 1 - first) / step));
    if (!there) throw py::index_error("no such signal or rows");
    py::array_t<double> values(static_cast<py::ssize_t>(count));
    const std::span<double> out(values.mutable_data(), count);
    bool sound = false;
    {
      const py::gil_scoped_release others_run;
      sound = columns().read(signal, first, step, out);
    }
    if (!sound) {
      throw std::runtime_error(
          path_ + ": its columns (" + (log_.file.empty() ? "a temporary file" : log_.file) +
          ") are not any more what was written; delete them and open the log again");
    }
    return values;
  }

 private:
  const daemon::ColumnFile& columns() const { return *log_.columns; }

  std::string path_;
  daemon::ColumnLog log_;
};

// As `gaitctl run` judges, by what the log says was expected; "expected": false if it says nothing.
std::string verdict(const std::string& path) {
  const py::gil_scoped_release others_run;
  std::string error;
  const auto log = daemon::LogReader::open(path, &error);
  if (log == nullptr) throw std::runtime_error(error);
  const auto section = log->metadata_value("expect");
  const auto expected = section ? daemon::read_logged_expectations(*section) : std::nullopt;
  return daemon::verdict_json(
      daemon::compute_verdict(*log, expected.value_or(daemon::Expectations())));
}

}  // namespace

void bind_log(py::module_& module) {
  py::class_<Log>(module, "Log")
      .def(py::init<const std::string&, bool>(), py::arg("path"), py::arg("keep"))
      .def_property_readonly("info", &Log::info)
      .def_property_readonly("columns_file", &Log::columns_file)
      .def_property_readonly("read_anew", &Log::read_anew)
      .def_property_readonly("rows", &Log::rows)
      .def("table", &Log::table)
      .def("read", &Log::read, py::arg("signal"), py::arg("first"), py::arg("count"),
           py::arg("step"));
  module.def("verdict", &verdict, py::arg("path"));
  module.def("glob_match", &daemon::glob_match, py::arg("pattern"), py::arg("text"));
  module.def("suggestion", &daemon::suggestion, py::arg("name"), py::arg("candidates"));
}

}  // namespace gaitd::python
