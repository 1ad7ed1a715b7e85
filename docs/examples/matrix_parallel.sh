#!/bin/sh
# matrix_parallel.sh: a matrix by several processes on one machine, run by GNU parallel.
#
# Usage: matrix_parallel.sh PROCESSES OUT VARIANT...      (all else: in $OPTIONS, such as "--potential pme")
# Interrupted? The same line again continues where each process stopped.
set -eu
processes="$1" out="$2"
shift 2
threads=$(($(nproc) / processes))
[ "$threads" -ge 1 ] || threads=1

# More parts than processes: a process that has the easier part takes another one.
parts=$((4 * processes))
seq "$parts" | parallel --jobs "$processes" --halt now,fail=1 \
    espdiff matrix "$@" ${OPTIONS:-} --threads "$threads" --shard "{}/$parts" --resume -q -o "$out"
espdiff merge "$out".shard-*-of-"$parts".state -o "$out"
rm "$out".shard-*-of-"$parts".state
