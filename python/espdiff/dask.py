"""Matrices and trajectories on the workers of a dask.distributed Client, on one machine or by a queue such as Slurm.

    >>> from dask.distributed import Client, LocalCluster
    >>> import espdiff.dask
    >>> client = Client(LocalCluster(n_workers=4, threads_per_worker=1))
    >>> m = espdiff.dask.matrix(client, ["a.pqr", "b.pqr", "c.pqr"], output="abc")
    >>> run.run(backend=espdiff.dask.Backend(client), unsupported_backend=True)    # of espdiff.mda

Results have the same bytes with any number of workers. docs/examples/matrix_dask.py is a whole program for Slurm.
"""

import os

from . import _ensembles, _functions
from ._core import InputError
from ._inputs import state_of


def _check(client):
    if not all(hasattr(client, name) for name in ("submit", "gather", "scheduler_info")):
        raise InputError(f"client: a {type(client).__name__} is no dask.distributed.Client")


def _n_workers(client):
    return max(1, len(client.scheduler_info(n_workers=-1)["workers"]))


def _with_threads(options):
    """As many threads as the worker has, unless the user gives a number."""
    if options.get("threads"):
        return options
    from distributed import get_worker

    return {**options, "threads": get_worker().state.nthreads}


def _gather(client, futures):
    """Results in order; what fails, and Ctrl-C, ends all of it."""
    try:
        return client.gather(futures)
    except BaseException:
        client.cancel(futures)
        raise


def _matrix_part(states, labels, options):
    _functions.matrix(states, labels, **_with_threads(options))


def matrix(client, states, labels=None, *, output, parts=None, resume=False, overwrite=False, **options):
    """espdiff.matrix() by the workers of a Client.

    output: prefix of the files, in a folder that all workers see. parts: how many there are, 4 for each worker without
    it. resume: parts that broke off continue. Other arguments as of espdiff.matrix(). Returns a Matrix.
    """
    _check(client)
    states = [os.path.abspath(s) if isinstance(s, (str, os.PathLike)) else state_of(s, f"states[{i}]")
              for i, s in enumerate(states)]
    labels = _functions.labels_of_states(states) if labels is None else list(labels)
    # Through a template a part is some states, and each part makes the template's surface again.
    through = options.get("template") is not None
    usual, most = (_n_workers(client), len(states)) if through else (4 * _n_workers(client), len(states) * (len(states) - 1))
    n_parts = max(2, min(parts or usual, most))  # one part would be a whole matrix
    prefix = os.path.abspath(output)
    done = [prefix + ending for ending in (".csv", ".json", ".h5")[:3 if through else 2]]
    if not overwrite and any(os.path.exists(path) for path in done):
        raise InputError(f"output: {' or '.join(done)} exists; set overwrite=True, or name another prefix")
    options = {**options, "output": prefix, "resume": resume, "overwrite": overwrite}
    futures = [client.submit(_matrix_part, states, labels, {**options, "shard": f"{i + 1}/{n_parts}"}, pure=False)
               for i in range(n_parts)]
    _gather(client, futures)
    files = [f"{prefix}.shard-{i + 1}-of-{n_parts}{ending}" for i in range(n_parts) for ending in (".h5", ".state")]
    files = [path for path in files if os.path.exists(path)]  # through a template, some parts have no exact pair
    made = _functions.merge(files, prefix, overwrite=overwrite)
    for path in files:
        os.remove(path)
    return made


def ensemble(client, groups, *, output, parts=None, **options):
    """espdiff.ensemble() by the workers of a Client; arguments as of it and of matrix(). Returns an Ensemble."""
    _check(client)

    def apply(function, tasks):
        return _gather(client, [client.submit(_ensemble_part, function, task, pure=False) for task in tasks])

    if isinstance(groups, dict):
        groups = {name: _absolute(members) for name, members in groups.items()}
    return _ensembles.ensemble_in_parts(apply, parts or _n_workers(client), groups, output, **options)


def _absolute(members):
    """Paths as other working folders see them."""
    if isinstance(members, dict):
        return {name: _absolute(member) for name, member in members.items()}
    if isinstance(members, (list, tuple)):
        return [_absolute(member) for member in members]
    return os.path.abspath(members) if isinstance(members, (str, os.PathLike)) else members


def _ensemble_part(function, task):
    groups, options = task
    return function((groups, _with_threads(options)))


def Backend(client):
    """A backend of MDAnalysis' analyses (2.8 and newer): frames by the workers of a Client.

    run(backend=espdiff.dask.Backend(client), unsupported_backend=True)
    """
    try:
        from MDAnalysis.analysis.backends import BackendBase
    except ImportError as missing:
        raise InputError("Backend: MDAnalysis 2.8 or newer is needed, whose analyses have workers") from missing

    class ClientBackend(BackendBase):
        def apply(self, func, computations):
            return _gather(client, [client.submit(func, part, pure=False) for part in computations])

    _check(client)
    return ClientBackend(_n_workers(client))


__all__ = ["Backend", "ensemble", "matrix"]
