# What the programs say about their own command lines: manual pages, completion, help.
source "$(dirname "$0")/common.sh"

# Manual pages: no warnings of roff, and every command and option is in them.
pages=(gaitctl.1 gaitd.8)
[[ ! -x $GAITD_BUILD/bin/gaitd-ros2 ]] || pages+=(gaitd-ros2.8)
for page in "${pages[@]}"; do
  file=$GAITD_BUILD/share/man/man${page##*.}/$page
  [[ -s $file ]] || fail "the build made no $file"
  warnings=$(LC_ALL=C.UTF-8 groff -man -Tutf8 -ww -z "$file" 2>&1)
  [[ -z $warnings ]] || fail "$page: $warnings"
  LC_ALL=C.UTF-8 MANWIDTH=200 groff -man -Tutf8 -rLL=200n -P-c -P-b -P-o -P-u "$file" >"$scratch/$page.txt"
  grep -q '^NAME' "$scratch/$page.txt" || fail "$page has no NAME"
done

# in_page PAGE WORD: as a whole word.
in_page() { grep -qE -- "(^|[^a-z-])$2([^a-z-]|$)" "$scratch/$1.txt" || fail "$1 does not have $2"; }

# The commands of `gaitctl COMMAND... --help`, with theirs, and the options of each.
walk_commands() {
  local help command
  help=$(gaitctl "$@" --help)
  while read -r option; do in_page gaitctl.1 "$option"; done \
    < <(grep -oE -- '--[a-z][a-z-]+' <<<"$help" | sort -u)
  while read -r command; do
    in_page gaitctl.1 "${*:+$* }$command"
    count=$((count + 1))
    walk_commands "$@" "$command"
  done < <(awk '/^[A-Z][A-Za-z ]*:$/ { on = !/^(Positionals|Options|Example):/; next } /^[^ ]/ { on = 0 }
    on && /^  [a-z]/ { print $1 }' \
    <<<"$help")
}
count=0
walk_commands
((count >= 20)) || fail "only $count commands found in gaitctl --help"
while read -r option; do in_page gaitd.8 "$option"; done \
  < <(gaitd --help | grep -oE -- '--[a-z][a-z-]+' | sort -u)
if [[ -x $GAITD_BUILD/bin/gaitd-ros2 ]]; then
  while read -r option; do in_page gaitd-ros2.8 "$option"; done \
    < <(gaitd-ros2 --help | grep -oE -- '--[a-z][a-z0-9-]+' | sort -u)
fi

# complete WORD...: what bash offers for the last word.
complete_words() {
  COMP_WORDS=("$@")
  COMP_CWORD=$(($# - 1))
  COMPREPLY=()
  _gaitctl 2>/dev/null
  printf '%s\n' "${COMPREPLY[@]}"
}
source <(gaitctl completion bash)
offers() {
  local wanted=$1
  shift
  complete_words "$@" | grep -xF -- "$wanted" >/dev/null || fail "'$*' does not offer $wanted"
}
offers walk gaitctl w
offers --steps gaitctl walk --
offers --json gaitctl walk --
offers left gaitctl walk --first ''
offers left gaitctl walk --first = ''
offers walk-bent gaitctl mode walk-
offers --gamepad gaitctl teleop --
offers flat-0.35 gaitctl run f
offers never gaitctl plugin swap toe_off n
complete_words gaitctl plugin swap toe_off '' >/dev/null || true
grep -qx single_cmp <<<"$(printf '%s\n' "${COMPREPLY[@]}")" && fail "a variant of another layer is offered"
offers utorso gaitctl sim push --link u
offers l_leg_kny gaitctl joint test l_leg_k
offers gait.swing_height= gaitctl run stand --set gait.sw
offers toe_off.variant=never gaitctl run stand --set toe_off.v
offers never gaitctl run stand --set toe_off.variant = n
offers never gaitctl run stand --set toe_off.variant =
offers simbody gaitctl run stand --backend ''
complete_words gaitctl run stand --backend '' >/dev/null || true
for backend in socketcan mock; do
  grep -qx "$backend" <<<"$(printf '%s\n' "${COMPREPLY[@]}")" && fail "run offers $backend, which does not simulate"
done
offers info gaitctl log ''
offers realtime gaitd --clock ''
offers atlas gaitd --robot a
touch "$scratch/some.mcap"
cd "$scratch"
offers some.mcap gaitctl log info so
for shell in zsh fish; do
  gaitctl completion "$shell" >"$scratch/script.$shell"
  if command -v "$shell" >/dev/null; then
    "$shell" -n "$scratch/script.$shell" || fail "the script for $shell is wrong"
  else
    echo "no $shell here: its script is not parsed"
  fi
done
expect 2 gaitctl completion tcsh 2>/dev/null

# Errors as JSON: one document on standard output, whatever happens.
for arguments in fly 'walk --steps 0' 'log info /none.mcap' 'steps /none.yaml' status \
  'log export x.mcap' 'plugin'; do
  read -ra words <<<"$arguments"
  code=0
  gaitctl --json "${words[@]}" >"$scratch/out" 2>"$scratch/err" || code=$?
  [[ $(grep -c '"error"' "$scratch/out") == 1 && -s $scratch/err ]] ||
    fail "gaitctl --json $arguments: no error in JSON: $(cat "$scratch/out")"
  grep -q "\"exit_code\": $code" "$scratch/out" || fail "$arguments: exit_code is not $code"
done
gaitctl fly 2>"$scratch/err" && fail "gaitctl fly succeeded"
grep -q "no command 'fly'" "$scratch/err" || fail "gaitctl fly: $(cat "$scratch/err")"
gaitctl wlak 2>"$scratch/err" || grep -q "'walk'" "$scratch/err" || fail "no near command is named"
echo "manual pages, completion and errors are right for $count commands"
