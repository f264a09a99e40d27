#!/bin/sh
# A sweep over the machines of a list by GNU parallel (https://www.gnu.org/software/parallel/); the folder is on a file
# system that all of them see, and `bankshot` is on each.
#
#   configs/cluster/parallel.sh SWEEP.toml /shared/OUT 64 machines.txt
#
# machines.txt has one machine a line (`8/node1` for eight at a time). A shard that failed is tried three times.
set -eu
sweep=$1 out=$2 shards=$3 machines=$4
seq "$shards" | parallel --sshloginfile "$machines" --workdir . --retries 3 --joblog "$out.log" \
  bankshot sweep "$sweep" --out "$out" --shard "{}/$shards" --threads 1 --quiet
bankshot merge "$out" --shards "$shards"
