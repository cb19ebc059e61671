# `gaitctl watch`: in place on a terminal that it leaves as it found it, lines elsewhere.
source "$(dirname "$0")/common.sh"
enter=$'\e[?1049h' leave=$'\e[?1049l' show_cursor=$'\e[?25h'

expect 3 gaitctl watch
expect 3 gaitctl watch --once
start_daemon --log "$scratch/log.mcap"
wait_for state standing 20

# No terminal: lines, that a pipe may end.
gaitctl watch --interval 0.02 | head -n 3 >"$scratch/lines"
(($(wc -l <"$scratch/lines") == 3)) || fail "no three lines: $(cat "$scratch/lines")"
grep -q 'standing.*ICP error' "$scratch/lines" || fail "the lines do not say much"
if grep -q $'\e' "$scratch/lines"; then fail "escape sequences in a file"; fi
gaitctl watch --once >"$scratch/once"
(($(wc -l <"$scratch/once") == 1)) || fail "--once printed $(wc -l <"$scratch/once") lines"
gaitctl --json watch --interval 0.02 | head -n 2 >"$scratch/json"
(($(grep -c '^{.*"state":"standing".*}$' "$scratch/json") == 2)) || fail "not one object per line"
expect 2 gaitctl watch --interval 0 2>/dev/null

# start_watch NAME ARGUMENTS...: on a terminal $term of $rows x $columns, its output in $scratch/NAME, until it shows
# $awaited.
term=xterm rows=12 columns=60 awaited='ICP error'
start_watch() {
  local name=$1
  shift
  rm -f "$scratch/$name.code" "$scratch/pid"
  {
    code=0
    script -qefc "stty rows $rows cols $columns; echo \$\$ >$scratch/pid; \
      exec env TERM=$term gaitctl watch --interval 0.02 $*" "$scratch/$name" </dev/null >/dev/null || code=$?
    echo "$code" >"$scratch/$name.code"
  } &
  wait_until grep -qsaF "$awaited" "$scratch/$name" || fail "watch shows nothing on a terminal: $(cat "$scratch/$name" 2>/dev/null)"
}
# exits NAME CODE: the program has ended so.
exits() {
  wait_until test -s "$scratch/$1.code" || fail "$1 does not end"
  [[ $(cat "$scratch/$1.code") == "$2" ]] ||
    fail "$1: exit code $(cat "$scratch/$1.code"), expected $2"
}
# ends NAME CODE: likewise, and left the terminal.
ends() {
  exits "$@"
  grep -qF "$enter" "$scratch/$1" || fail "$1: no alternate screen"
  [[ $(tail -c 400 "$scratch/$1") == *"$show_cursor$leave"* ]] ||
    fail "$1: the terminal is not restored"
}

# A terminal that knows no escape codes: lines too.
term=dumb start_watch dumb
kill -INT "$(cat "$scratch/pid")"
exits dumb 0
grep -q ' standing ' "$scratch/dumb" || fail "no lines on a dumb terminal: $(cat "$scratch/dumb")"
if grep -q $'\e' "$scratch/dumb"; then fail "escape sequences on a dumb terminal"; fi

for signal in INT TERM; do
  start_watch "$signal"
  kill -"$signal" "$(cat "$scratch/pid")"
  ends "$signal" 0
done
# Ctrl-Z where no shell could let it go on: it goes on by itself.
start_watch orphan
kill -TSTP "$(cat "$scratch/pid")"
wait_until grep -qaF "$leave" "$scratch/orphan" || fail "Ctrl-Z does not leave the terminal"
shown=$(wc -c <"$scratch/orphan")
goes_on() { (($(wc -c <"$scratch/orphan") > shown + 1000)); }
wait_until goes_on || fail "Ctrl-Z stops it for ever"
kill -INT "$(cat "$scratch/pid")"
ends orphan 0
# Redrawn in place: cleared once, then only overwritten; no line is longer than the window.
(($(grep -aoF $'\e[2J' "$scratch/INT" | wc -l) == 1)) || fail "the screen is cleared again and again"
widest=$(sed 's/\x1b\[[0-9;]*H/\n/g; s/\x1b\[[?0-9;]*[a-zA-Z]//g' "$scratch/INT" | tr -d '\r' |
  grep -v '^Script ' | LC_ALL=C.UTF-8 wc -L)
((widest <= 60)) || fail "a line is longer than the window"

# What it shows, as long as the window has room for it: state, mode, steps, ICP error, the times of each
# layer, and faults once there are some.
rows=40 columns=100
expect 0 gaitctl walk --steps 2 --length 0.2
start_watch contents
wait_for state walking 5
wait_for state standing 30
expect 0 gaitctl estop
wait_for_text() {
  wait_until grep -qaE "$2" "$scratch/$1" || fail "watch does not show '$2': $(sed 's/\x1b\[[0-9;?]*[a-zA-Z]/\n/g' "$scratch/$1" | tail -n 40)"
}
for text in 'state +walking' 'state +standing' 'state +fault' 'faults +none' 'faults +estop' \
  'gait +walk-[a-z]+, swing, support (left|right)' 'step +2, ' 'ICP error +[0-9.]+ mm' \
  'whole tick +[0-9.]+ +[0-9.]+'; do
  wait_for_text contents "$text"
done
for layer in state_estimator icp_planner step_adjuster toe_off whole_body_controller task_source; do
  wait_for_text contents "$layer +[a-z_]+ +[0-9]+\\.[0-9] +[0-9]+\\.[0-9]"
done
kill -INT "$(cat "$scratch/pid")"
ends contents 0
stop_daemon
start_daemon --log "$scratch/log.mcap"
wait_for state standing 20
rows=12 columns=60

# A gaitd that hangs is said to, and does not keep anybody from ending it.
start_watch silent --reconnect
kill -STOP "$daemon"
wait_until grep -qa 'has not answered for [1-9]' "$scratch/silent" || fail "old figures look like new ones"
kill -INT "$(cat "$scratch/pid")"
ends silent 0
# Nor does one that has never answered.
awaited='has not answered for' start_watch mute --reconnect
wait_until grep -qaF 'q or Ctrl-C ends it' "$scratch/mute" || fail "it does not say how to end it"
if grep -qaF 'stands below' "$scratch/mute"; then fail "it speaks of a status that never came"; fi
kill -INT "$(cat "$scratch/pid")"
ends mute 0
kill -CONT "$daemon"

# When gaitd ends.
start_watch gone
start_watch reconnect --reconnect
reconnecting=$(cat "$scratch/pid")
stop_daemon
ends gone 3
grep -q 'gaitd has ended' "$scratch/gone" || fail "it does not say that gaitd has ended"
wait_until grep -q 'waiting for gaitd' "$scratch/reconnect" || fail "it does not say that it waits"
shown=$(wc -c <"$scratch/reconnect")
start_daemon --log "$scratch/log.mcap"
shows_again() { tail -c +"$shown" "$scratch/reconnect" | grep -q 'ICP error'; }
wait_until shows_again || fail "it does not connect again"
kill -INT "$reconnecting"
ends reconnect 0
stop_daemon
