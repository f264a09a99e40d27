#!/usr/bin/env bash
# Runs a sweep on a real Slurm of three nodes on this machine, while programs, nodes and the controller are
# killed. At the end the tables must have the bytes of one undisturbed run. Takes about 6 minutes on 2 cores.
# Needs root on Debian (installs slurm-wlm and munge).
#   cargo build --release && tests/slurm/kill_nodes_test.sh
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
project=$(cd "$here/../.." && pwd)
export BANKSHOT=${BANKSHOT:-$project/target/release/bankshot}
work=$(mktemp -d /tmp/bankshot-drill.XXXXXX)
shards=6
say() { printf '%s  %s\n' "$(date +%T)" "$*"; }
trap '"$here/cluster.sh" down || true' EXIT

cp "$project/configs/free_throw.toml" "$work"
cat >"$work/sweep.toml" <<'TOML'
[sweep]
name = "drill"
shooter = "free_throw.toml"
region = "half_court"
step = "4 ft"
within = "three_point_line"
[search]
standard_error = 0.002
TOML

say "one undisturbed run"
"$BANKSHOT" sweep "$work/sweep.toml" --out "$work/alone" --quiet

"$here/cluster.sh" up 3
eval "$("$here/cluster.sh" env)"
sinfo -N
cd "$work"
out=$work/out
# All nodes have the same host name here, unlike on a real cluster. So two tasks of one shard would find each
# other's lock.
submit() {
  local tries
  for tries in 1 2 3 4 5; do
    sbatch --parsable --time=10 --mem-per-cpu=100M --array="$1" \
      "$project/configs/cluster/array.sbatch" sweep.toml "$out" "$shards" && return
    sleep 3
  done
  return 1
}
jobs_done() { "$BANKSHOT" status "$out" 2>/dev/null | grep -o '[0-9]* of [0-9]* jobs done' | head -1 || true; }
running() { squeue -h -t running -o '%i %N %K' | sort; }
# Waits until a command succeeds, at most SECONDS: wait_for SECONDS COMMAND...
wait_for() {
  local until=$((SECONDS + $1)); shift
  while ! "$@"; do [ $SECONDS -lt $until ] || { say "waited too long for: $*"; return 1; }; sleep 1; done
}
has_running() { [ "$(running | wc -l)" -ge 3 ]; }
is_empty() { [ -z "$(squeue -h -o %i 2>/dev/null || echo unknown)" ]; }

first=$(submit "1-$shards")
say "submitted array $first"
wait_for 60 has_running
sleep 2
say "running: $(running | tr '\n' ';') $(jobs_done)"

say "the program is killed in one task"
victim=$(pgrep -f "sweep sweep.toml --out $out" | head -1)
kill -9 "$victim"

sleep 1
say "node n2 dies"
"$here/cluster.sh" kill-node n2

sleep 1
task=$(running | grep -v ' n2 ' | tail -1 | awk '{ print $1 }')
say "task $task is cancelled"
[ -z "$task" ] || scancel "$task"

sleep 1
say "the network of n3 fails: its task continues and will be requeued"
"$here/cluster.sh" cut-node n3

say "the controller dies and is started again"
"$here/cluster.sh" kill-controller
sleep 3
"$here/cluster.sh" start-controller
sleep 12
say "the nodes are started again; $(jobs_done)"
"$here/cluster.sh" start-node n2
"$here/cluster.sh" start-node n3

# Slurm may have requeued, lost or given up tasks. Submit what is missing until nothing is missing.
for round in 1 2 3 4 5; do
  wait_for 400 is_empty
  missing=$("$BANKSHOT" missing "$out" --shards "$shards" || true)
  say "queue empty; missing: ${missing:-none}; $(jobs_done)"
  [ -n "$missing" ] || break
  submit "$missing" >/dev/null
  sleep 5
done

"$BANKSHOT" merge "$out" --shards "$shards"
for table in best_shots.csv best_shots.parquet provenance.json; do
  cmp "$work/alone/$table" "$out/$table"
done
say "stores: $(ls "$out/store" | tr '\n' ' ')"
say "the tables have the bytes of the undisturbed run"
cd /
rm -rf "$work"
