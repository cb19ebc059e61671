#!/usr/bin/env bash
# A robot that lives: it walks, is pushed, has its layers exchanged, is asked by ten clients, and its log
# goes on over a small disk that others fill and empty. Every minute its memory, descriptors, maps,
# overruns and dropouts are looked at. Growth is judged by its slope after the first five minutes.
#   tests/soak.sh HOURS [FOLDER]     e.g. 0.7; FOLDER takes gaitd's log and figures, default: a temporary one
# The build is that of GAITD_BUILD, build/release if unset.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
[[ ${1:-} =~ ^[0-9.]+$ ]] || {
  echo "usage: tests/soak.sh HOURS [FOLDER]" >&2
  exit 2
}
export GAITD_BUILD=${GAITD_BUILD:-$here/../build/release}
folder=${2:-$(mktemp -d)}
mkdir -p "$folder/disk"
# A disk of its own, where that can be had.
if [[ $EUID == 0 ]] && mount -t tmpfs -o size=160M soak "$folder/disk" 2>/dev/null; then
  trap 'umount -l "$folder/disk"' EXIT
fi
python3 "$here/hostile/soak.py" "$1" "$folder"
