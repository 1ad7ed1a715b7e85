#!/usr/bin/env python3
"""matrix_dask.py: a matrix by the workers of Dask, on this machine or in Slurm's queue.

On this machine, with 4 processes:
    python matrix_dask.py --workers 4 -o matrix *.pqr --potential pb
In Slurm's queue, 16 jobs of 4 cores each (dask-jobqueue submits them by sbatch):
    python matrix_dask.py --slurm --workers 16 --cores 4 --memory 8GB --queue short -o matrix *.pqr --potential pb

The files have the bytes of `espdiff matrix`. Was it interrupted? The same line with --resume continues. Options that are
not listed by --help are those of `espdiff matrix`.
"""

import argparse
import inspect
import os

from dask.distributed import Client, LocalCluster

import espdiff.dask

# What `espdiff matrix` reads from tables, or does with files that this program takes as they are.
NOT_TAKEN = ("--cluster-by", "--groups", "--list", "--map-array", "--no-hetero", "--quiet", "--shard", "--water")


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("variants", nargs="+", help="structure files: PQR, PDB, mmCIF, GRO, MOL2")
    parser.add_argument("-o", "--output", required=True, help="prefix of the results, in a folder that all nodes see")
    parser.add_argument("--workers", type=int, default=2, help="processes, or jobs in the queue")
    parser.add_argument("--resume", action="store_true", help="continue what an interrupted run has left")
    parser.add_argument("--slurm", action="store_true", help="submit the workers by sbatch")
    parser.add_argument("--queue", help="partition of Slurm")
    parser.add_argument("--cores", type=int, default=4, help="of each job")
    parser.add_argument("--memory", default="8GB", help="of each job")
    parser.add_argument("--walltime", default="01:00:00", help="of each job")
    return parser.parse_known_args()


def settings(words):
    """--potential=pb or --potential pb as potential="pb", --cavities as cavities=True, --no-project as project=False; --field
    and --patch may be repeated; --on-error skip as skip_errors=True."""
    parameters = inspect.signature(espdiff.matrix).parameters
    kinds = {row["name"]: row["kind"] for row in espdiff.help_options()}
    given, words = {}, list(words)
    while words:
        option, has_value, value = words.pop(0).partition("=")
        name = option[2:].replace("-", "_")
        off = name.startswith("no_") and name[3:] in parameters
        name = name[3:] if off else {"patch": "patches", "field": "fields", "on_error": "skip_errors"}.get(name, name)
        if option in NOT_TAKEN:
            raise SystemExit(f"matrix_dask.py: {option} is an option of `espdiff matrix` alone")
        if not option.startswith("--") or name not in parameters:
            raise SystemExit(f"matrix_dask.py: {option}: espdiff matrix has no such option")
        is_switch = isinstance(parameters[name].default, bool) or kinds.get(name) == "boolean"
        if is_switch and name != "skip_errors":
            given[name] = not off
            continue
        if not has_value:
            if not words:
                raise SystemExit(f"matrix_dask.py: {option} needs a value")
            value = words.pop(0)
        if name == "skip_errors":
            given[name] = value == "skip"
        elif name == "fields":
            given.setdefault(name, []).extend(value.split("|"))
        elif kinds.get(name) == "named":
            given.setdefault(name, {}).update([value.split("=", 1)])
        elif kinds.get(name) == "list":
            given[name] = f"{given[name]},{value}" if name in given else value
        else:
            given[name] = int(value) if isinstance(parameters[name].default, int) and name not in kinds else value
    return given


def make_cluster(arguments):
    if not arguments.slurm:
        return LocalCluster(n_workers=arguments.workers, threads_per_worker=1, dashboard_address=None)
    from dask_jobqueue import SLURMCluster

    cluster = SLURMCluster(
        queue=arguments.queue, cores=arguments.cores, processes=1, memory=arguments.memory, walltime=arguments.walltime,
        scheduler_options={"dashboard_address": None}, local_directory=os.environ.get("TMPDIR", "/tmp"))
    cluster.scale(jobs=arguments.workers)
    return cluster


def main():
    arguments, words = parse()
    with make_cluster(arguments) as cluster, Client(cluster) as client:
        client.wait_for_workers(arguments.workers)
        matrix = espdiff.dask.matrix(client, arguments.variants, output=arguments.output, resume=arguments.resume,
                                     parts=4 * arguments.workers, **settings(words))
    print(matrix)


if __name__ == "__main__":
    main()
