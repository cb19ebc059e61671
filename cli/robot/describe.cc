// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/describe.h"

#include "cli/robot/picture.h"
#include "cli/robot/robot_files.h"
#include "cli/robot/robot_init.h"

namespace gaitd::porting {

std::vector<std::pair<std::string, std::string>> describe_robot(const std::string& urdf,
                                                                const std::string& named,
                                                                const std::string& name,
                                                                const Told& told,
                                                                std::string* error) {
  Guess guess;
  if (!guess_robot(urdf, name, told, &guess, error)) return {};
  return {{"robot.yaml", robot_yaml(guess, named)},
          {"stand.yaml", stand_scenario(guess)},
          {"walk.yaml", walk_scenario(guess)},
          {"posture.svg", posture_picture(guess)}};
}

}  // namespace gaitd::porting
