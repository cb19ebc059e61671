# A disk that stands still under the log, by fsfreeze of a file system of its own: the robot walks on,
# the status is answered, the watchdog is fed, and SIGTERM switches the motors off before anything
# waits for the disk.
source "$(dirname "$0")/uml.sh"
uml_start_or_skip
truncate -s 256M "$scratch/disk.img"
mkfs.ext4 -q "$scratch/disk.img" || skip "no mkfs.ext4: install e2fsprogs"
mkdir "$scratch/disk"
cp "$here/frozen_disk.py" "$scratch/"
uml_arguments=("ubda=$scratch/disk.img")
uml_run frozen_disk_inside.sh 900
