# frozen_disk.py looks at gaitd; here are the file system and the robots.
for device in /dev/ubda /dev/ubd0 /dev/ubd/0; do [[ -b $device ]] && break; done
mount -t ext4 "$device" "$scratch/disk" || fail "no file system on $device"
thaw() { fsfreeze -u "$scratch/disk" 2>/dev/null || true; }
trap thaw EXIT
python3 -S "$scratch/frozen_disk.py" walk "$scratch/disk" || fail "the walk over a frozen disk"

can_links 3 16
stall_time=60 start_robot frozen --can can-classic.yaml --period 0.01 \
  --world '{"terrain": {"ground_z": 0.0}, "start": {"z": 10000.0}}'
python3 -S "$scratch/frozen_disk.py" stop "$scratch/disk" "$scratch/frozen.json" "$robot" ||
  fail "SIGTERM over a frozen disk"
