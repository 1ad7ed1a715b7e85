"""MDAnalysis: the potential on the surface of every frame against a reference.

    >>> import MDAnalysis as mda
    >>> from espdiff.mda import SurfacePotential
    >>> u = mda.Universe("topology.psf", "trajectory.dcd")
    >>> run = SurfacePotential(u.select_atoms("protein"), reference=0, potential="pb").run(step=10)
    >>> run.results.metrics["mean_abs_difference"]
"""

import numpy as np
from MDAnalysis.analysis.base import AnalysisBase

from ._core import InputError, metrics as list_metrics
from ._functions import Series
from ._inputs import state_of

try:
    from MDAnalysis.analysis.results import ResultsGroup
except ImportError:  # before MDAnalysis 2.8 analyses run in one process
    ResultsGroup = None


class SurfacePotential(AnalysisBase):
    """Compares the surface of an AtomGroup in every frame with that of a reference.

    atomgroup: what has the surface; its universe may hold water, whose charges count for pme in a periodic cell.
    reference: a frame's number, a path, a State, or another AtomGroup.
    residues: keep the residues' mean absolute differences of every frame, too.
    threads: of each process; with several workers 1 is usual.
    options: those of espdiff.compare().

    Every mapping starts from the reference, so that a frame's numbers depend on nothing but that frame, and several
    workers give the same bits as one.

    results.metrics: {name: (frames) float64}. results.trustworthy: (frames) bool. results.reasons: [frame] list.
    results.residues: (frames, residues) float64, with `residues`. results.frames, results.times.
    """

    _analysis_algorithm_is_parallelizable = True

    @classmethod
    def get_supported_backends(cls):
        return ("serial", "multiprocessing", "dask")

    def __init__(self, atomgroup, reference=0, *, residues=False, threads=0, verbose=False, **options):
        if len(atomgroup) == 0:
            raise InputError("atomgroup: it is empty")
        if "start" in options:
            raise InputError("start: every frame starts from the reference here; espdiff.Series has small steps")
        super().__init__(atomgroup.universe.trajectory, verbose=verbose)
        self._atoms = atomgroup.atoms
        self._reference = reference
        self._keeps_residues = residues
        self._options = {"threads": threads, **options}
        self._series = None

    def _reference_state(self):
        if not isinstance(self._reference, (int, np.integer)):
            return state_of(self._reference, "reference")
        trajectory = self._atoms.universe.trajectory
        if not -len(trajectory) <= self._reference < len(trajectory):
            raise InputError(f"reference: there is no frame {self._reference}; the trajectory has {len(trajectory)}")
        here = trajectory.frame
        trajectory[int(self._reference)]
        state = state_of(self._atoms, "reference")
        trajectory[here]
        return state

    def _prepare(self):
        # Workers get the analysis by pickle, and make their own series.
        self._series = None
        self.results.table = []

    def _single_frame(self):
        if self._series is None:
            self._series = Series(self._reference_state(), start="source", **self._options)
        comparison = self._series.step(state_of(self._atoms, f"frame {self._ts.frame}"))
        row = {"metrics": dict(comparison.metrics), "trustworthy": comparison.trustworthy,
               "reasons": comparison.certificate.reasons}
        if self._keeps_residues:
            row["residues"] = np.array(comparison.residue_columns()["mean_abs_difference"])
        self.results.table.append(row)

    def _get_aggregator(self):
        return ResultsGroup(lookup={"table": lambda parts: [row for part in parts for row in part]})

    def _conclude(self):
        table = self.results.table
        names = [row["name"] for row in list_metrics()]
        self.results.metrics = {
            name: np.array([row["metrics"][name] for row in table]) for name in names if table and name in table[0]["metrics"]
        }
        self.results.trustworthy = np.array([row["trustworthy"] for row in table], dtype=bool)
        self.results.reasons = [row["reasons"] for row in table]
        if self._keeps_residues:
            self.results.residues = np.array([row["residues"] for row in table])
        self.results.frames = self.frames
        self.results.times = self.times
        self._series = None

    def __getstate__(self):
        state = self.__dict__.copy()
        state["_series"] = None
        return state


__all__ = ["SurfacePotential"]
