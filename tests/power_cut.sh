#!/usr/bin/env bash
# Simulates power cuts during a sweep. An ext4 file system in a file is shut down at random moments, mounted
# again, and the sweep continues. No job that was reported as done may be missing. Needs root, loop devices
# and xfs_io (package xfsprogs). Takes about a minute.
#   cargo build --release && tests/power_cut.sh [CUTS]
set -euo pipefail
project=$(cd "$(dirname "$0")/.." && pwd)
bankshot=${BANKSHOT:-$project/target/release/bankshot}
cuts=${1:-30}
work=$(mktemp -d /tmp/bankshot-power.XXXXXX)
disk=$work/disk mount=$work/mount
mkdir "$mount"
trap 'umount -l "$mount" 2>/dev/null || true; rm -rf "$work"' EXIT
truncate -s 64M "$disk"
mkfs.ext4 -q "$disk"
"$bankshot" sweep "$project/tests/small_sweep.toml" --out "$work/alone" --quiet >/dev/null
mount -o loop "$disk" "$mount"
out=$mount/out complete=0 lost=0
# Prints the jobs in the stores of a folder. It runs just before the cut and commits nothing, so these are the
# jobs that the program believes to be on disk.
saved_jobs() { python3 - "$1" <<'PY'
import glob, sqlite3, sys
done = set()
for path in glob.glob(sys.argv[1] + "/store/*.sqlite"):
    try:
        done |= {row[0] for row in sqlite3.connect(path, timeout=10).execute("SELECT job FROM results")}
    except sqlite3.Error:
        pass
print(*sorted(done))
PY
}
for cut in $(seq "$cuts"); do
  "$bankshot" sweep "$project/tests/small_sweep.toml" --out "$out" --quiet >/dev/null 2>&1 &
  sleep "0.$((RANDOM % 9))$((RANDOM % 10))"
  before=$(saved_jobs "$out")
  # This shutdown does not flush, so data that was not synced is lost.
  xfs_io -x -c 'shutdown' "$mount"
  wait || true
  umount -l "$mount"
  mount -o loop "$disk" "$mount"
  after=" $(saved_jobs "$out") "
  for job in $before; do
    [[ $after == *" $job "* ]] || { echo "cut $cut: job $job was on disk and is lost"; lost=$((lost + 1)); }
  done
  # A cut may fall between the two tables. What is there is whole.
  for table in best_shots.csv best_shots.parquet; do
    [ ! -e "$out/$table" ] || cmp "$work/alone/$table" "$out/$table"
  done
  if [ -e "$out/best_shots.csv" ] && [ -e "$out/best_shots.parquet" ]; then
    complete=$((complete + 1))
    rm -rf "$out"
    sync
  fi
done
"$bankshot" sweep "$project/tests/small_sweep.toml" --out "$out" --quiet >/dev/null
for table in best_shots.csv best_shots.parquet provenance.json; do cmp "$work/alone/$table" "$out/$table"; done
[ "$lost" = 0 ]
echo "$cuts power cuts, $complete complete sweeps, no finished job lost, the same bytes at the end"
