// SPDX-License-Identifier: Apache-2.0
#include "collada.h"

#include <Eigen/Geometry>
#include <charconv>
#include <map>
#include <string_view>

#include "gaitd/sdk/bounds.h"
#include "xml_reader.h"

namespace gaitd::dynamics {
namespace {

constexpr double kDegree = 0.017453292519943295;

std::vector<double> numbers(const TiXmlElement* element) {
  const char* text = element == nullptr ? nullptr : element->GetText();
  std::string_view rest = text == nullptr ? "" : text;
  std::vector<double> out;
  while (out.size() < 3 * bounds::kMeshPoints) {
    const std::size_t begin = rest.find_first_not_of(" \t\r\n+");
    if (begin == std::string_view::npos) break;
    rest.remove_prefix(begin);
    double value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error != std::errc()) break;
    out.push_back(value);
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  }
  return out;
}

std::string attribute(const TiXmlElement* element, const char* name) {
  const char* value = element == nullptr ? nullptr : element->Attribute(name);
  return value == nullptr ? "" : value;
}

class Reader {
 public:
  explicit Reader(std::vector<Eigen::Vector3d>* points) : points_(*points) {}

  void read(const TiXmlElement& root) {
    if (const TiXmlElement* asset = root.FirstChildElement("asset")) {
      if (const TiXmlElement* unit = asset->FirstChildElement("unit")) {
        unit->QueryDoubleAttribute("meter", &unit_);
      }
    }
    if (const TiXmlElement* library = root.FirstChildElement("library_geometries")) {
      for (const TiXmlElement* e = library->FirstChildElement("geometry"); e != nullptr;
           e = e->NextSiblingElement("geometry")) {
        geometries_[attribute(e, "id")] = positions(*e);
      }
    }
    const Eigen::Affine3d scale(Eigen::Scaling(unit_));
    if (const TiXmlElement* library = root.FirstChildElement("library_visual_scenes")) {
      if (const TiXmlElement* scene = library->FirstChildElement("visual_scene")) {
        add_nodes(*scene, scale);
      }
    }
    if (!points_.empty()) return;
    for (const auto& [id, corners] : geometries_) add(corners, scale);
  }

 private:
  static std::vector<double> positions(const TiXmlElement& geometry) {
    const TiXmlElement* mesh = geometry.FirstChildElement("mesh");
    if (mesh == nullptr) return {};
    std::string source;
    if (const TiXmlElement* vertices = mesh->FirstChildElement("vertices")) {
      for (const TiXmlElement* e = vertices->FirstChildElement("input"); e != nullptr;
           e = e->NextSiblingElement("input")) {
        if (attribute(e, "semantic") == "POSITION") source = attribute(e, "source");
      }
    }
    for (const TiXmlElement* e = mesh->FirstChildElement("source"); e != nullptr;
         e = e->NextSiblingElement("source")) {
      if ("#" + attribute(e, "id") == source) return numbers(e->FirstChildElement("float_array"));
    }
    return {};
  }

  void add_nodes(const TiXmlElement& parent, const Eigen::Affine3d& X) {
    for (const TiXmlElement* node = parent.FirstChildElement("node"); node != nullptr;
         node = node->NextSiblingElement("node")) {
      const Eigen::Affine3d own = X * transform(*node);
      for (const TiXmlElement* e = node->FirstChildElement("instance_geometry"); e != nullptr;
           e = e->NextSiblingElement("instance_geometry")) {
        const std::string url = attribute(e, "url");
        const auto found = geometries_.find(url.empty() ? url : url.substr(1));
        if (found != geometries_.end()) add(found->second, own);
      }
      add_nodes(*node, own);
    }
  }

  static Eigen::Affine3d transform(const TiXmlElement& node) {
    Eigen::Affine3d X = Eigen::Affine3d::Identity();
    for (const TiXmlElement* e = node.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string tag = e->Value();
      if (tag != "matrix" && tag != "translate" && tag != "rotate" && tag != "scale") continue;
      const std::vector<double> v = numbers(e);
      if (tag == "matrix" && v.size() == 16) {
        Eigen::Affine3d M;
        M.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(v.data());
        X = X * M;
      } else if (tag == "translate" && v.size() == 3) {
        X.translate(Eigen::Vector3d(v[0], v[1], v[2]));
      } else if (tag == "scale" && v.size() == 3) {
        X.scale(Eigen::Vector3d(v[0], v[1], v[2]));
      } else if (tag == "rotate" && v.size() == 4) {
        const Eigen::Vector3d axis(v[0], v[1], v[2]);
        if (axis.norm() > 0) X.rotate(Eigen::AngleAxisd(v[3] * kDegree, axis.normalized()));
      }
    }
    return X;
  }

  void add(const std::vector<double>& corners, const Eigen::Affine3d& X) {
    for (std::size_t i = 0; i + 2 < corners.size() && points_.size() < bounds::kMeshPoints;
         i += 3) {
      const Eigen::Vector3d point = X * Eigen::Vector3d(corners[i], corners[i + 1], corners[i + 2]);
      if (point.allFinite()) points_.push_back(point);
    }
  }

  std::vector<Eigen::Vector3d>& points_;
  std::map<std::string, std::vector<double>> geometries_;
  double unit_ = 1;  // m
};

}  // namespace

void read_collada(const std::string& text, std::vector<Eigen::Vector3d>* points) {
  if (find_excess(text)) return;
  TiXmlDocument document;
  document.Parse(text.c_str());
  if (!document.Error() && document.RootElement() != nullptr) {
    Reader(points).read(*document.RootElement());
  }
}

}  // namespace gaitd::dynamics
