// SPDX-License-Identifier: Apache-2.0
#include "cli/man_text.h"

namespace gaitd::cli {

usage::ManText man_text() {
  return {
      .name = "gaitctl",
      .section = "1",
      .version = GAITD_VERSION,
      .summary = "command the walking daemon gaitd",
      .description =
          "gaitctl sends commands to a running gaitd over its Unix socket and shows what "
          "it answers. It also plays scenarios on a gaitd of its own (run, campaign) and reads "
          "logs (log); these need no daemon.\n\n"
          "Commands return when the daemon has taken them, not when the robot is done. "
          "A status that is asked for afterwards shows their effect.\n",
      .sections = {
          {"EXIT STATUS",
           "0\tDone.\n"
           "1\tThe daemon refused, an expectation of a scenario does not hold, or a file cannot "
           "be read.\n"
           "2\tThe command line is wrong; nothing was sent.\n"
           "3\tNo daemon can be reached, or it went away before it answered.\n"
           "4\tDone, but a log that was read is damaged; what is missing is on standard error.\n"
           "130\tA run was interrupted.\n"},
          {"OUTPUT AS JSON",
           "With --json, standard output holds one JSON document: the result, or "
           "{\"error\": {command, exit_code, kind, message, code, data}}, where kind is usage, "
           "refused, failed or no_daemon, and code and data are those of JSON-RPC or null. "
           "watch prints one document per line instead.\n"},
          {"FILES",
           "/run/gaitd/gaitd.sock\tSocket of an installed daemon.\n"
           "$XDG_RUNTIME_DIR/gaitd.sock\tSocket of a daemon of this user.\n"
           "/tmp/gaitd-<uid>/gaitd.sock\tThe same, without a runtime directory.\n"
           "$XDG_STATE_HOME/gaitd/logs\tLogs of run; ~/.local/state/gaitd/logs if unset.\n"},
          {"ENVIRONMENT",
           "GAITD_PATH\tFolders, separated by colons, with robots, scenarios and plugins of one's "
           "own.\n"},
          {"EXAMPLES",
           "    gaitctl status\n"
           "    gaitctl walk --steps 6 --length 0.3\n"
           "    gaitctl watch\n"
           "    gaitctl run flat-0.35 --set seed=2 --log flat.mcap\n"
           "    gaitctl log export flat.mcap --signals 'time,com/*,icp/*' -o flat.csv\n"},
          {"SEE ALSO", "gaitd(8)\n"}}};
}

}  // namespace gaitd::cli
