// SPDX-License-Identifier: Apache-2.0
// What a shell needs to ask the programs themselves: the scripts know no command, so that they
// never grow old.
#include "daemon/usage/completion.h"

namespace gaitd::usage {
namespace {

constexpr const char* kBash = R"sh(# bash completion of gaitctl and gaitd.
_gaitctl() {
  local line current=${COMP_WORDS[COMP_CWORD]}
  [[ $current == '=' ]] && current=
  COMPREPLY=()
  while IFS= read -r line; do
    if [[ $line == :files ]]; then
      compopt -o filenames 2>/dev/null
      while IFS= read -r line; do COMPREPLY+=("$line"); done < <(compgen -f -- "$current")
    else
      line=${line%%$'\t'*}
      [[ $line == *= ]] && compopt -o nospace 2>/dev/null
      COMPREPLY+=("$line")
    fi
  done < <("${COMP_WORDS[0]}" __complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -F _gaitctl gaitctl gaitd
)sh";

constexpr const char* kZsh = R"sh(#compdef gaitctl gaitd
# zsh completion of gaitctl and gaitd.
_gaitctl() {
  local line files=
  local -a candidates
  for line in "${(@f)$("${(Q)words[1]}" __complete "${(@Q)words[2,CURRENT]}" 2>/dev/null)}"; do
    case $line in
      :files) files=1 ;;
      ?*) candidates+=("${${line%%$'\t'*}//:/\\:}:${line#*$'\t'}") ;;
    esac
  done
  (( $#candidates )) && _describe -V "$words[1]" candidates
  [[ -n $files ]] && _files
}
# Loaded by compinit it is run as the function of this file; sourced, it registers itself.
if [[ $funcstack[1] == _gaitctl ]]; then
  _gaitctl "$@"
else
  compdef _gaitctl gaitctl gaitd
fi
)sh";

constexpr const char* kFish = R"sh(# fish completion of gaitctl and gaitd.
function __gaitctl_complete
  set -l words (commandline -opc)
  set -l current (commandline -ct)
  for line in ($words[1] __complete $words[2..-1] "$current" 2>/dev/null)
    if test "$line" = :files
      __fish_complete_path "$current"
    else
      echo -- $line
    end
  end
end
complete -c gaitctl -f -a '(__gaitctl_complete)'
complete -c gaitd -f -a '(__gaitctl_complete)'
)sh";

}  // namespace

std::string completion_script(std::string_view shell) {
  if (shell == "bash") return kBash;
  if (shell == "zsh") return kZsh;
  if (shell == "fish") return kFish;
  return "";
}

}  // namespace gaitd::usage
