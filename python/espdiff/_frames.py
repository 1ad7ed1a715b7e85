"""Topologies and trajectories for the command line, read by MDAnalysis; the extension calls this."""

import warnings

import numpy as np

from ._inputs import labels_of
from ._core import State


def atoms(path):
    """The atoms of a topology as a State, all at the origin."""
    import MDAnalysis

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            universe = MDAnalysis.Universe(path, to_guess=())
        except TypeError:  # before MDAnalysis 2.8
            universe = MDAnalysis.Universe(path)
    group = universe.atoms
    labels = labels_of(group)
    labels.pop("elements", None)  # by name, as of VMD's readers
    return State.from_arrays(
        np.zeros((len(group), 3), np.float32), getattr(group, "radii", None), getattr(group, "charges", None), name=path,
        **labels)


class Frames:
    """The frames of a trajectory, in any order; one is in memory."""

    def __init__(self, path, n_atoms):
        from MDAnalysis.coordinates.core import get_reader_for

        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self._reader = get_reader_for(path)(path, n_atoms=n_atoms)
        self.n_atoms = self._reader.n_atoms
        self.n_frames = self._reader.n_frames

    def read(self, number):
        """Positions (atoms, 3) float32, A, and the cell: six numbers, or none."""
        step = self._reader[number]
        cell = [] if step.dimensions is None else [float(value) for value in step.dimensions]
        return np.ascontiguousarray(step.positions, np.float32), cell
