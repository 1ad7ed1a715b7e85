#!/bin/sh
# matrix_slurm.sh: a matrix by the tasks of a Slurm array.
#
# Submit the parts, and the merge behind them:
#     parts=$(sbatch --parsable --array=1-16 matrix_slurm.sh part variants.csv matrix)
#     sbatch --dependency="afterok:$parts" matrix_slurm.sh merge variants.csv matrix
# variants.csv is a list of `espdiff matrix --list`. A task that was preempted or ran out of time continues where it stopped
# when it is submitted again.
#SBATCH --cpus-per-task=4
#SBATCH --time=01:00:00
#SBATCH --requeue
set -eu
step="$1" list="$2" out="$3"
case "$step" in
    part)
        espdiff matrix --list "$list" ${OPTIONS:-} --threads "${SLURM_CPUS_PER_TASK:-1}" --resume -q -o "$out" \
            --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT"
        ;;
    merge) espdiff merge "$out".shard-*.state -o "$out" ;;
    *) echo "matrix_slurm.sh: '$step' is not part or merge" >&2; exit 2 ;;
esac
