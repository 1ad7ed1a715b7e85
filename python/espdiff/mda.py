"""MDAnalysis: the potential on the surface of every frame against a reference.

    >>> import MDAnalysis as mda
    >>> from espdiff.mda import SurfacePotential
    >>> u = mda.Universe("topology.psf", "trajectory.dcd")
    >>> run = SurfacePotential(u.select_atoms("protein"), reference=0, potential="pb").run(step=10)
    >>> run.results.metrics["mean_abs_difference"]
"""

import os
import tempfile

import MDAnalysis
import numpy as np
from MDAnalysis.analysis.base import AnalysisBase, Results

from ._core import Error, InputError, IoError, metrics as list_metrics
from ._ensembles import ensemble, ensemble_in_parts
from ._functions import Series
from ._inputs import is_atomgroup, state_of

try:
    from MDAnalysis.analysis.results import ResultsGroup
except ImportError:  # before MDAnalysis 2.8 analyses run in one process
    ResultsGroup = None


def _refuse_workers(backend):
    raise InputError(f"backend: {backend!r} needs MDAnalysis 2.8 or newer, and this is {MDAnalysis.__version__}; leave it out")


def _joined(parts):
    """The columns of all workers' frames, in their order."""
    return {name: [value for part in parts for value in part[name]] for name in parts[0]}


class SurfacePotential(AnalysisBase):
    """Compares the surface of an AtomGroup in every frame with that of a reference.

    atomgroup: what has the surface; its universe may hold water, whose charges count for pme in a periodic cell.
    reference: a frame's number, a path, a State, or an AtomGroup of another universe.
    residues: keep the residues' values of every frame, too.
    threads: of each process; with several workers 1 is usual.
    options: those of espdiff.compare().

    Every mapping starts from the reference, so that a frame's numbers depend on nothing but that frame, and several
    workers give the same bits as one.

    results.metrics: {name: (frames) float64}; NaN where there is no value. results.unit: of potentials.
    results.trustworthy: (frames) bool. results.reasons, results.warnings: [frame] list of texts.
    With `residues`: results.residue_values: {name: (frames, residues) float64}; results.residues: those of
    mean_abs_difference, of shapes alone mean_displacement_A; results.residue_labels: (residues), such as A:LYS33.
    results.frames, results.times.
    """

    _analysis_algorithm_is_parallelizable = True

    @classmethod
    def get_supported_backends(cls):
        return ("serial", "multiprocessing", "dask")

    def run(self, start=None, stop=None, step=None, frames=None, verbose=None, *, backend=None, n_workers=None, **options):
        """As AnalysisBase.run(); a trajectory that cannot be read is an espdiff.IoError."""
        if ResultsGroup is not None:
            options.update(backend=backend, n_workers=n_workers)
        elif backend not in (None, "serial") or n_workers not in (None, 1):
            _refuse_workers(backend)
        try:
            return super().run(start, stop, step, frames, verbose, **options)
        except (EOFError, OSError, RuntimeError) as error:
            if isinstance(error, Error):
                raise
            said = str(error).splitlines()[0] if str(error) else type(error).__name__
            # What is said of a DCD that was cut off.
            if said == "generator raised StopIteration":
                said = "it ends too early"
            raise IoError(f"{self._trajectory.filename}: MDAnalysis cannot read all of its frames ({said}); copy or write the "
                          "file again, or name the frames that are whole, run(frames=[...])") from error

    def __init__(self, atomgroup, reference=0, *, residues=False, threads=0, verbose=False, **options):
        if not is_atomgroup(atomgroup):
            raise InputError(f"atomgroup: a {type(atomgroup).__name__} is no AtomGroup; give universe.select_atoms(...)")
        if len(atomgroup) == 0:
            raise InputError("atomgroup: it is empty")
        if "start" in options:
            raise InputError("start: every frame starts from the reference here; espdiff.Series has small steps")
        super().__init__(atomgroup.universe.trajectory, verbose=verbose)
        self._atoms = atomgroup.atoms
        self._reference = self._checked(reference)
        self._keeps_residues = residues
        self._options = {"threads": threads, **options}
        self._series = None

    def _checked(self, reference):
        """A frame's number, or a State, which stays when universes move on."""
        trajectory = self._atoms.universe.trajectory
        if isinstance(reference, (int, np.integer)):
            if not -len(trajectory) <= reference < len(trajectory):
                raise InputError(f"reference: there is no frame {reference}; the trajectory has {len(trajectory)}")
            return int(reference)
        if is_atomgroup(reference) and reference.universe is self._atoms.universe:
            raise InputError(
                "reference: the AtomGroup is of the universe whose frames are compared, and moves with them; give the "
                "frame's number, or keep that frame, espdiff.state(atoms)")
        return state_of(reference, "reference")

    def _reference_state(self):
        if not isinstance(self._reference, int):
            return self._reference
        trajectory = self._atoms.universe.trajectory
        here = trajectory.frame
        trajectory[self._reference]
        state = state_of(self._atoms, "reference")
        trajectory[here]
        return state

    def _prepare(self):
        # Workers get the analysis by pickle, and make their own series.
        self._series = None
        self.results.columns = {"metrics": [], "trustworthy": [], "reasons": [], "warnings": [], "unit": [],
                                "residue_labels": [], "residue_values": []}

    def _single_frame(self):
        if self._series is None:
            self._series = Series(self._reference_state(), start="source", **self._options)
        comparison = self._series.step(state_of(self._atoms, f"frame {self._ts.frame}"))
        record = comparison.to_dict()
        row = {"metrics": dict(comparison.metrics), "trustworthy": comparison.trustworthy,
               "reasons": record["certificate"]["reasons"],
               "warnings": [warning["text"] for warning in record["warnings"]],
               "unit": comparison.unit if comparison.has_potential else ""}
        if self._keeps_residues:
            columns = comparison.residue_columns()
            row["residue_labels"] = [
                f"{chain}{':' if chain else ''}{name}{number}{code}" for chain, name, number, code in zip(
                    columns["chain"], columns["name"], columns["number"], columns["insertion_code"])]
            row["residue_values"] = {
                name: np.array(values) for name, values in columns.items() if isinstance(values, np.ndarray)}
        for name, value in row.items():
            self.results.columns[name].append(value)

    def _get_aggregator(self):
        return ResultsGroup(lookup={"columns": _joined})

    def _conclude(self):
        columns = self.results.columns
        del self.results["columns"]
        names = [row["name"] for row in list_metrics()]
        self.results.metrics = {
            name: np.array([row[name] for row in columns["metrics"]])
            for name in names if columns["metrics"] and name in columns["metrics"][0]}
        self.results.trustworthy = np.array(columns["trustworthy"], dtype=bool)
        self.results.reasons = columns["reasons"]
        self.results.warnings = columns["warnings"]
        self.results.unit = columns["unit"][0] if columns["unit"] else ""
        if self._keeps_residues and columns["residue_values"]:
            self.results.residue_labels = columns["residue_labels"][0]
            self.results.residue_values = {
                name: np.array([row[name] for row in columns["residue_values"]]) for name in columns["residue_values"][0]}
            main = "mean_abs_difference" if self.results.unit else "mean_displacement_A"
            self.results.residues = self.results.residue_values[main]
        self.results.frames = self.frames
        self.results.times = self.times
        self._series = None

    def __getstate__(self):
        state = self.__dict__.copy()
        state["_series"] = None
        return state


class Ensemble:
    """Compares two groups of simulations on one template surface: espdiff.ensemble() in the form of an analysis.

    groups: {name: [AtomGroup, ...]}, each AtomGroup a replicate; {name: {replicate: AtomGroup}} names them.
    output: prefix of OUT.h5 and the results; without it nothing stays but the result.
    options: those of espdiff.ensemble().

    run() maps the same frames of every universe. results.ensemble is the espdiff.Ensemble; results.difference, means, low,
    high, p, p_family_wise, tested: its arrays by vertex; results.residues: the table; results.patches.
    """

    def __init__(self, groups, *, output=None, **options):
        for name, members in groups.items():
            for atoms in members.values() if isinstance(members, dict) else members:
                if not is_atomgroup(atoms):
                    raise InputError(f"groups[{name!r}]: a {type(atoms).__name__} is no AtomGroup; espdiff.ensemble() takes files")
        if "frames" in options:
            raise InputError("frames: run(start, stop, step) chooses them")
        self._groups = groups
        self._output = output
        self._options = options
        self.results = Results()

    @classmethod
    def get_supported_backends(cls):
        return ("serial", "multiprocessing", "dask")

    def run(self, start=None, stop=None, step=None, *, frames=None, backend="serial", n_workers=1, n_parts=None,
            unsupported_backend=False, verbose=False):
        """Maps the frames, and computes the statistics. Returns the analysis.

        backend: serial, multiprocessing, dask, or an object of MDAnalysis' BackendBase, such as espdiff.dask.Backend.
        n_parts: how many parts the frames are shared out in; as many as workers without it. The bytes are the same.
        """
        chosen = slice(start, stop, step) if frames is None else list(frames)
        apply, n_workers = self._backend(backend, n_workers)
        options = {**self._options, "frames": chosen, "progress": verbose or None}
        n_parts = n_parts or n_workers
        if n_parts == 1:
            made = ensemble(self._groups, output=self._output, **options)
        else:
            with tempfile.TemporaryDirectory(prefix="espdiff-") as scratch:
                prefix = self._output if self._output is not None else os.path.join(scratch, "ensemble")
                made = ensemble_in_parts(apply, n_parts, self._groups, prefix, **options)
        self.results.ensemble = made
        for name in ("difference", "means", "low", "high", "p", "p_family_wise", "tested", "residues", "patches", "n_frames"):
            self.results[name] = getattr(made, name)
        return self

    @staticmethod
    def _backend(backend, n_workers):
        """What runs the parts, apply(function, tasks), and how many workers there are."""
        if backend == "serial":
            return (lambda function, tasks: [function(task) for task in tasks]), 1
        if ResultsGroup is None:
            _refuse_workers(backend)
        from MDAnalysis.analysis import backends

        known = {"multiprocessing": backends.BackendMultiprocessing, "dask": backends.BackendDask}
        if isinstance(backend, str):
            if backend not in known:
                raise InputError(f"backend: {backend!r} is not serial, multiprocessing or dask")
            return known[backend](n_workers=n_workers).apply, n_workers
        return backend.apply, backend.n_workers


__all__ = ["Ensemble", "SurfacePotential"]
