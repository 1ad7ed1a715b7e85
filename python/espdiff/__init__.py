"""Electrostatic surface potential differences between states of a molecule whose surfaces have different shapes.

    >>> import espdiff
    >>> r = espdiff.compare("wild.pqr", "mutant.pqr")
    >>> r.metrics["mean_abs_difference"], r.certificate.trustworthy

A state is a file (PQR, PDB, mmCIF), a `State`, an AtomGroup of MDAnalysis or one of ProDy. Options have the names of
the command line with underscores; `help_options()` lists them.
"""

from ._core import (
    Cancelled,
    ConvergenceError,
    DeviceError,
    Error,
    FormatError,
    GeometryError,
    InputError,
    InternalError,
    IoError,
    Map,
    OutOfMemoryError,
    State,
    Surface,
    __version__,
)
from ._functions import Series, compare, help_options, matrix, potential, status, surface
from ._results import Certificate, Comparison, Matrix

__all__ = [
    "Cancelled", "Certificate", "Comparison", "ConvergenceError", "DeviceError", "Error", "FormatError",
    "GeometryError", "InputError", "InternalError", "IoError", "Map", "Matrix", "OutOfMemoryError", "Series", "State",
    "Surface", "__version__", "compare", "help_options", "matrix", "potential", "status", "surface",
]
