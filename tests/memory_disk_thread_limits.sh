#!/usr/bin/env bash
# Runs a sweep under limits: memory, open files, threads, full and read-only disks, and unusual files instead
# of its configuration. Needs root for its mounts. Takes about half a minute.
#   cargo build --release && tests/memory_disk_thread_limits.sh
set -uo pipefail
project=$(cd "$(dirname "$0")/.." && pwd)
bankshot=${BANKSHOT:-$project/target/release/bankshot}
sweep=$project/tests/small_sweep.toml
work=$(mktemp -d /tmp/bankshot-limits.XXXXXX)
trap 'umount "$work/tiny" "$work/readonly" 2>/dev/null; chattr -i "$work/fixed" 2>/dev/null; rm -rf "$work"' EXIT
passed=0 failed=0
# Runs a command and checks its exit code: expect CODE NAME COMMAND...
expect() {
  local want=$1 name=$2 got
  shift 2
  "$@" >"$work/output" 2>&1
  got=$?
  if [ "$got" = "$want" ] && ! grep -q 'panicked' "$work/output"; then
    passed=$((passed + 1))
    echo "ok      $name: $got $(head -c 150 "$work/output" | head -1)"
  else
    failed=$((failed + 1))
    echo "FAILED  $name: exit $got, expected $want: $(head -3 "$work/output")"
  fi
}
run() { "$bankshot" sweep "$sweep" --out "$1" --quiet; }
# After a clean run, the tables of the folder are those of the undisturbed run: same NAME FOLDER
same() {
  expect 0 "$1, then a clean run" run "$2"
  expect 0 "$1, same bytes" cmp "$work/alone/best_shots.parquet" "$2/best_shots.parquet"
}
expect 0 "undisturbed" run "$work/alone"

expect 74 "8 open files" bash -c "ulimit -n 8; exec \"\$@\"" sh "$bankshot" sweep "$sweep" --out "$work/files" --quiet
same "8 open files" "$work/files"
expect 74 "no more threads" prlimit --nproc=1:1 setpriv --reuid 65534 --clear-groups \
  "$bankshot" sweep "$sweep" --out "$work/threads" --quiet
same "no more threads" "$work/threads"
# An allocation that fails aborts the program. The next start continues.
bash -c "ulimit -v 60000; exec \"\$@\"" sh "$bankshot" sweep "$sweep" --out "$work/memory" --quiet >"$work/output" 2>&1
echo "        60 MB of address space: exit $?, $(head -1 "$work/output")"
same "60 MB of address space" "$work/memory"

mkdir "$work/tiny" "$work/readonly"
for kib in 4 16 40; do
  mount -t tmpfs -o size=${kib}k tmpfs "$work/tiny"
  expect 74 "a disk of $kib KiB" run "$work/tiny/out"
  mount -o remount,size=4m "$work/tiny"
  same "a disk of $kib KiB" "$work/tiny/out"
  umount "$work/tiny"
done
mount -t tmpfs -o size=4m tmpfs "$work/tiny"
run "$work/tiny/out" >/dev/null 2>&1
cp "$work/tiny/out/best_shots.csv" "$work/before.csv"
dd if=/dev/zero of="$work/tiny/full" bs=4k 2>/dev/null
expect 74 "merge on a full disk" "$bankshot" merge "$work/tiny/out"
expect 0 "the old tables are unchanged" cmp "$work/before.csv" "$work/tiny/out/best_shots.csv"
umount "$work/tiny"

mount -t tmpfs -o ro tmpfs "$work/readonly"
expect 74 "a read-only disk" run "$work/readonly/out"
umount "$work/readonly"
mkdir "$work/fixed" && chattr +i "$work/fixed" && expect 74 "an immutable folder" run "$work/fixed"
chattr -i "$work/fixed"
ln -s "$work/real" "$work/link" && mkdir "$work/real"
same "a linked folder" "$work/link"
cp -r "$work/alone" "$work/ro_copy" && rm "$work/ro_copy"/best_shots.*
mount --bind "$work/ro_copy" "$work/readonly" && mount -o remount,ro,bind "$work/readonly"
expect 0 "status of a read-only folder" "$bankshot" status "$work/readonly"
expect 74 "merge into a read-only folder" "$bankshot" merge "$work/readonly"
umount "$work/readonly"

config() { "$bankshot" sweep "$1" --out "$work/none" --quiet; }
truncate -s 2G "$work/large.toml"
expect 2 "a TOML of 2 GB" config "$work/large.toml"
printf '\xff\xfe[sweep]' >"$work/bytes.toml"
expect 2 "a TOML that is not UTF-8" config "$work/bytes.toml"
printf '[sweep]\nname = "a\0b"' >"$work/nul.toml"
expect 2 "a TOML with a NUL" config "$work/nul.toml"
mkfifo "$work/fifo.toml"
expect 2 "a FIFO instead of a TOML" config "$work/fifo.toml"
expect 2 "a folder instead of a TOML" config "$work"
expect 2 "a missing TOML" config "$work/missing.toml"
expect 0 "nothing was written" test ! -e "$work/none"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
