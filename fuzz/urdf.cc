// SPDX-License-Identifier: Apache-2.0
// A robot description: read, made into a model, and computed with when it is taken.
#include <cstdint>
#include <string>

#include "fuzz/require.h"
#include "gaitd/dynamics/model_check.h"
#include "gaitd/dynamics/urdf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaitd;
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const char* root : {"", "pelvis"}) {
    dynamics::UrdfOptions options{.root_link = root};
    if (options.root_link.empty()) {
      options.limits_required = false;
      options.nearest_inertias = true;
      options.p_LB.z() = 0.1;
      options.fixed = {"*hand*"};
    }
    const dynamics::UrdfResult result = dynamics::load_urdf_text(text, "fuzz.urdf", options);
    for (const std::string& error : result.errors) {
      fuzz::require(error.starts_with("fuzz.urdf"), "an error says where");
    }
    if (!result.ok()) continue;
    fuzz::require(dynamics::check_model(result.model).empty(), "the model is physical");
    for (const dynamics::UrdfLink& link : result.links) {
      fuzz::require(result.find_link(link.name) != nullptr, "every link is found");
      fuzz::require(link.p_BL.allFinite() && link.R_BL.coeffs().allFinite(), "links are finite");
    }
  }
  return 0;
}
