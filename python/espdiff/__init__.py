"""Electrostatic surface potential differences between states of a molecule whose surfaces have different shapes.

    >>> import espdiff
    >>> r = espdiff.compare("wild.pqr", "mutant.pqr")
    >>> r.metrics["mean_abs_difference"], r.certificate.trustworthy

A state is a file (PQR, PDB, mmCIF, GRO, MOL2, Amber restart), a `State`, a Universe or AtomGroup of MDAnalysis, or atoms of ProDy. Options have the names of
the command line with underscores; `help_options()` lists them.
"""

from ._threads import brief_spins

with brief_spins():  # loads the engine
    from . import _errors
from ._errors import *

try:
    from ._core import Map, State, Surface, __version__
except ImportError as _missing:
    # VMD's Python has espdiff.vmd without it.
    _reason = str(_missing)

    def __getattr__(name):
        if name not in __all__:
            raise AttributeError(f"module 'espdiff' has no attribute {name!r}")
        raise ImportError(
            f"espdiff.{name} needs the engine's extension, which this Python does not have ({_reason}); "
            "`pip install .` in a clone builds it, and inside VMD espdiff.vmd does without it")
else:
    from ._ensembles import Ensemble, ensemble
    from ._inputs import state
    from ._functions import (
        Series, compare, frames, help_options, matrix, merge, potential, prepare, status, surface, trajectory)
    from ._reports import report
    from ._results import Certificate, Comparison, Matrix
    from ._saved import load
    from ._tables import Trajectory

__all__ = [
    "Certificate", "Comparison", "Ensemble", "Map", "Matrix", "Series", "State", "Surface", "Trajectory", "__version__", "compare",
    "ensemble", "frames", "help_options", "load", "matrix", "merge", "potential", "prepare", "report", "state", "status", "surface",
    "trajectory",
]
__all__ += _errors.__all__
