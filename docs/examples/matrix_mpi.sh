#!/bin/sh
# matrix_mpi.sh: a matrix by the ranks of an MPI job: each computes one part, and the parts are merged at the end.
#
# Usage: matrix_mpi.sh RANKS OUT VARIANT...      (options of mpirun in $MPIRUN_OPTIONS, of espdiff in $OPTIONS)
# espdiff needs no MPI itself: it is told its rank by what Open MPI (or MPICH, or Slurm) sets in the environment.
set -eu
ranks="$1" out="$2"
shift 2
export out
mpirun -n "$ranks" ${MPIRUN_OPTIONS:-} sh -c '
    rank="${OMPI_COMM_WORLD_RANK:-${PMI_RANK:-${SLURM_PROCID}}}"
    size="${OMPI_COMM_WORLD_SIZE:-${PMI_SIZE:-${SLURM_NTASKS}}}"
    exec espdiff matrix "$@" ${OPTIONS:-} --threads 1 --shard "$((rank + 1))/$size" --resume -q -o "$out"' sh "$@"
espdiff merge "$out".shard-*-of-"$ranks".state -o "$out"
rm "$out".shard-*-of-"$ranks".state
