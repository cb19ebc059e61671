// SPDX-License-Identifier: Apache-2.0
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "daemon/telemetry/robot_motion.h"
#include "python/binding/binding.h"

namespace gaitd::python {
namespace {

namespace py = pybind11;
using Rows = py::array_t<double, py::array::c_style | py::array::forcecast>;

class Model {
 public:
  explicit Model(const std::map<std::string, std::string>& metadata)
      : motion_(daemon::RobotMotion::load(metadata)) {
    if (motion_ == nullptr)
      throw std::runtime_error("no robot description (robot_urdf) that can be read");
  }

  std::string name() const { return motion_->model().name; }
  double total_mass() const { return motion_->model().total_mass; }

  std::vector<std::string> links() const {
    std::vector<std::string> names;
    for (const auto& link : motion_->links()) names.push_back(link.name);
    return names;
  }

  // name, least and greatest position, limits of velocity and effort
  std::vector<std::tuple<std::string, double, double, double, double>> joints() const {
    std::vector<std::tuple<std::string, double, double, double, double>> joints;
    for (int i = 0; i < motion_->model().joint_count; ++i) {
      const GaitdJoint& joint = motion_->model().joints[i];
      joints.emplace_back(joint.name, joint.position_min, joint.position_max, joint.velocity_limit,
                          joint.effort_limit);
    }
    return joints;
  }

  // Homogeneous matrices, n x 4 x 4, of a link in the world.
  py::array_t<double> poses(std::size_t link, const Rows& pelvis, const Rows& joints) {
    const auto count = pelvis.ndim() == 2 ? pelvis.shape(0) : 0;
    if (link >= motion_->links().size() || pelvis.ndim() != 2 || pelvis.shape(1) != 6 ||
        joints.ndim() != 2 || joints.shape(0) != count ||
        joints.shape(1) != motion_->model().joint_count) {
      throw py::value_error("expected a pelvis of n x 6 and joints of n x " +
                            std::to_string(motion_->model().joint_count));
    }
    py::array_t<double> poses({count, py::ssize_t{4}, py::ssize_t{4}});
    const double* pelvis_row = pelvis.data();
    const double* joints_row = joints.data();
    double* out = poses.mutable_data();
    {
      const py::gil_scoped_release others_run;
      const std::scoped_lock lock(mutex_);
      const auto joint_count = static_cast<std::size_t>(motion_->model().joint_count);
      for (py::ssize_t i = 0; i < count;
           ++i, pelvis_row += 6, joints_row += joint_count, out += 16) {
        motion_->place(std::span<const double, 6>(pelvis_row, 6), {joints_row, joint_count});
        Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(out, 4, 4) =
            motion_->X_link(motion_->links()[link]).matrix();
      }
    }
    return poses;
  }

 private:
  std::mutex mutex_;  // of the pose that motion_ is in
  std::unique_ptr<daemon::RobotMotion> motion_;
};

}  // namespace

void bind_model(py::module_& module) {
  py::class_<Model>(module, "Model")
      .def(py::init<const std::map<std::string, std::string>&>(), py::arg("metadata"))
      .def_property_readonly("name", &Model::name)
      .def_property_readonly("total_mass", &Model::total_mass)
      .def("links", &Model::links)
      .def("joints", &Model::joints)
      .def("poses", &Model::poses, py::arg("link"), py::arg("pelvis"), py::arg("joints"));
}

}  // namespace gaitd::python
