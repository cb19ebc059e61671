# Sourced: a Slurm cluster of two nodes on this machine, with a munge of its own, in a folder of its
# own; nothing of the system's is used or changed.

cluster=
declare -A cluster_pids=()

# Why there can be no cluster here; nothing if there can.
why_no_cluster() {
  local program
  for program in munged slurmctld slurmd sbatch squeue; do
    PATH=$PATH:/usr/sbin:/sbin command -v "$program" >/dev/null && continue
    echo "no $program; Debian: apt-get install slurmctld slurmd slurm-client munge"
    return
  done
  ((EUID == 0)) || echo "a slurmd starts jobs as root only"
}

# start_cluster FOLDER: ready when both nodes wait for work.
start_cluster() {
  local host port user
  cluster=$1 host=$(hostname -s) user=$(id -un)
  port=$((20000 + $$ % 20000))
  PATH=$PATH:/usr/sbin:/sbin
  mkdir -p "$cluster"/{munge,state,n1,n2}
  chmod 700 "$cluster/munge"
  head -c 1024 /dev/urandom >"$cluster/munge/key"
  chmod 600 "$cluster/munge/key"
  cat >"$cluster/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
AuthType=auth/munge
AuthInfo=socket=$cluster/munge/socket
CredType=cred/munge
SlurmUser=$user
SlurmdUser=$user
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/%n
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/%n/pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SlurmdTimeout=6
ReturnToService=2
JobCompType=jobcomp/none
MpiDefault=none
SchedulerParameters=sched_min_interval=100000
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
  export SLURM_CONF=$cluster/slurm.conf
  munged --foreground --force --key-file="$cluster/munge/key" --socket="$cluster/munge/socket" \
    --pid-file="$cluster/munge/pid" --log-file="$cluster/munge/log" \
    --seed-file="$cluster/munge/seed" >"$cluster/munged.txt" 2>&1 &
  cluster_pids[munged]=$!
  for _ in {1..50}; do
    [[ -S $cluster/munge/socket ]] && break
    sleep 0.1
  done
  slurmctld -D -f "$SLURM_CONF" >"$cluster/slurmctld.txt" 2>&1 &
  cluster_pids[slurmctld]=$!
  start_node n1
  start_node n2
  for _ in {1..150}; do
    (($(sinfo --noheader -N -o %T 2>/dev/null | grep -cx idle) == 2)) && return
    sleep 0.2
  done
  tail -n 20 "$cluster"/*.txt
  return 1
}

start_node() {
  slurmd -D -N "$1" -f "$SLURM_CONF" >>"$cluster/$1.txt" 2>&1 &
  cluster_pids[$1]=$!
}

# kill_node NAME: at once, with all that runs there, as if its power were gone.
kill_node() {
  kill -KILL "${cluster_pids[$1]}"
  wait "${cluster_pids[$1]}" 2>/dev/null || true
  unset "cluster_pids[$1]"
  kill_steps "$1"
}

# The processes of jobs on a node, and what Slurm keeps beside them.
kill_steps() {
  local environment pid parent
  for environment in $(grep -lzxF "SLURMD_NODENAME=$1" /proc/[0-9]*/environ 2>/dev/null); do
    grep -qzxF "SLURM_CONF=$SLURM_CONF" "$environment" 2>/dev/null || continue
    pid=${environment//[^0-9]/}
    parent=$(awk '$1 == "PPid:" { print $2 }' "/proc/$pid/status" 2>/dev/null) || continue
    [[ $(cat "/proc/$parent/comm" 2>/dev/null) == slurmstepd ]] && kill -KILL "$parent" 2>/dev/null
    kill -KILL "$pid" 2>/dev/null || true
  done
}

stop_cluster() {
  [[ -n $cluster ]] || return 0
  kill_steps n1
  kill_steps n2
  kill -KILL "${cluster_pids[@]}" 2>/dev/null || true
  wait "${cluster_pids[@]}" 2>/dev/null || true
  cluster=
}
