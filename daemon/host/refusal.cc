// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/refusal.h"

namespace gaitd::daemon {

std::string Refusal::text() const {
  std::string out = file + ": refused";
  for (const Reason& reason : reasons) {
    out += "\n  " + reason.what + ": has " + reason.has + ", needs " + reason.needed + "; " +
           reason.remedy;
  }
  return out;
}

}  // namespace gaitd::daemon
