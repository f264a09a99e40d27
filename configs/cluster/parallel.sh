#!/bin/sh
# Runs a sweep on a list of machines with GNU parallel (https://www.gnu.org/software/parallel/). All of
# them need the same file system for the folder, and `bankshot`.
#
#   configs/cluster/parallel.sh SWEEP.toml /shared/OUT 64 machines.txt
#
# machines.txt has one machine per line (`8/node1` for eight shards at a time). A shard that fails is tried
# three times.
set -eu
sweep=$1 out=$2 shards=$3 machines=$4
seq "$shards" | parallel --sshloginfile "$machines" --workdir . --retries 3 --joblog "$out.log" \
  bankshot sweep "$sweep" --out "$out" --shard "{}/$shards" --threads 1 --quiet
bankshot merge "$out" --shards "$shards"
