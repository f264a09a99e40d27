#!/usr/bin/env bash
# Runs a complete Slurm cluster on this machine, for drills: on loopback only, in one private folder.
#   cluster.sh up [NODES]        start munged, slurmctld and NODES times slurmd (installs them on Debian)
#   cluster.sh env               print what to export to use the cluster
#   cluster.sh kill-node nX      a machine dies: kill slurmd and everything that it runs
#   cluster.sh cut-node nX       the network of a node fails: kill slurmd, but not what it runs
#   cluster.sh start-node nX     start a node again
#   cluster.sh kill-controller | start-controller
#   cluster.sh down              stop everything
# Needs root and Debian 12 or newer (slurm-wlm, munge). Needs neither systemd nor cgroups.
set -euo pipefail
root=${BANKSHOT_CLUSTER:-/tmp/bankshot-cluster}
port=${BANKSHOT_CLUSTER_PORT:-27800}
conf=$root/slurm.conf

install() {
  command -v slurmctld >/dev/null && command -v munged >/dev/null && command -v pgrep >/dev/null && return
  # Without this policy the packages start their own services.
  local policy=/usr/sbin/policy-rc.d made=
  [ -e $policy ] || { printf '#!/bin/sh\nexit 101\n' >$policy; chmod 755 $policy; made=yes; }
  apt-get update -qq
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends slurm-wlm munge procps >/dev/null
  [ -z "$made" ] || rm -f $policy
}

configure() {
  local nodes=$1 host
  host=$(hostname -s)
  mkdir -p "$root"/{munge,state,log,pid,spool}
  chmod 755 "$root" "$root/munge"
  if [ ! -s "$root/munge/key" ]; then
    head -c 1024 /dev/urandom >"$root/munge/key"
    chmod 400 "$root/munge/key"
  fi
  # Slurm notices a dead node after 10 s (on a real cluster after 300 s by default).
  cat >"$conf" <<CONF
ClusterName=drill
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$root/munge/socket
CredType=cred/munge
StateSaveLocation=$root/state
SlurmctldPidFile=$root/pid/slurmctld.pid
SlurmctldLogFile=$root/log/slurmctld.log
SlurmdPidFile=$root/pid/slurmd.%n.pid
SlurmdLogFile=$root/log/slurmd.%n.log
SlurmdSpoolDir=$root/spool/%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
MailProg=/bin/true
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
ReturnToService=2
JobRequeue=1
SlurmdTimeout=10
SlurmctldTimeout=10
InactiveLimit=0
KillWait=5
MinJobAge=300
SchedulerParameters=batch_sched_delay=1,sched_interval=5,bf_interval=5
CONF
  # No cgroup is mounted. With the plugin for v1, Slurm does not need one.
  echo 'CgroupPlugin=cgroup/v1' >"$root/cgroup.conf"
  for k in $(seq "$nodes"); do
    echo "NodeName=n$k NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + k)) CPUs=1 RealMemory=512 State=UNKNOWN" >>"$conf"
  done
  echo "PartitionName=all Nodes=n[1-$nodes] Default=YES MaxTime=INFINITE State=UP" >>"$conf"
  echo "$nodes" >"$root/nodes"
}

alive() { [ -s "$1" ] && grep -qs '^State:.[^ZX]' "/proc/$(cat "$1")/status"; }

munge() {
  alive "$root/pid/munged.pid" && return
  rm -f "$root/munge/socket"*
  munged --force --key-file="$root/munge/key" --socket="$root/munge/socket" --pid-file="$root/pid/munged.pid" \
    --log-file="$root/munge/log" --seed-file="$root/munge/seed" --num-threads=2
}
controller() { alive "$root/pid/slurmctld.pid" || slurmctld -f "$conf"; }
node() { alive "$root/pid/slurmd.$1.pid" || { mkdir -p "$root/spool/$1"; slurmd -f "$conf" -N "$1"; }; }

# Prints a process and all its descendants, the descendants first.
family() {
  local child
  for child in $(pgrep -P "$1" || true); do family "$child"; done
  echo "$1"
}

# Prints the step daemons of a node: those with a child that runs on it.
steps() {
  local step child
  for step in $(pgrep -f '^slurmstepd: ' || true); do
    for child in $(pgrep -P "$step" || true); do
      if tr '\0' '\n' <"/proc/$child/environ" 2>/dev/null | grep -qx "SLURMD_NODENAME=$1"; then
        echo "$step"
        break
      fi
    done
  done
}

case "${1:-}" in
  up)
    install
    configure "${2:-3}"
    munge
    controller
    for k in $(seq "$(cat "$root/nodes")"); do node "n$k"; done
    export SLURM_CONF=$conf
    for _ in $(seq 60); do
      idle=$(sinfo -h -t idle,alloc,mix -o %D 2>/dev/null | awk '{ n += $1 } END { print n + 0 }')
      [ "$idle" = "$(cat "$root/nodes")" ] && break
      sleep 0.5
    done
    ;;
  env) echo "export SLURM_CONF=$conf" ;;
  kill-node)
    doomed=$(for step in $(steps "$2"); do family "$step"; done)
    kill -9 "$(cat "$root/pid/slurmd.$2.pid")"
    for process in $doomed; do kill -9 "$process" 2>/dev/null || true; done
    ;;
  cut-node) kill -9 "$(cat "$root/pid/slurmd.$2.pid")" ;;
  start-node) node "$2" ;;
  kill-controller) kill -9 "$(cat "$root/pid/slurmctld.pid")" ;;
  start-controller) controller ;;
  down)
    for file in "$root"/pid/slurmd.*.pid "$root/pid/slurmctld.pid" "$root/pid/munged.pid"; do
      alive "$file" && kill "$(cat "$file")" || true
    done
    ;;
  *)
    sed -n '2,11p' "$0"
    exit 2
    ;;
esac
