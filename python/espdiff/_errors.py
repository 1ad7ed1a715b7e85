"""The package's exceptions: the engine's, or the same ones where the engine is not built for this Python."""

__all__ = [
    "Cancelled", "ConvergenceError", "DeviceError", "Error", "FormatError", "GeometryError", "InputError",
    "InternalError", "IoError", "OutOfMemoryError",
]

try:
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
        OutOfMemoryError,
    )
except ImportError:

    class Error(Exception):
        """Base of all that espdiff raises."""

    class InputError(Error, ValueError):
        """An argument or a molecule that cannot be right."""

    class FormatError(Error, ValueError):
        """A file's content is wrong; the message names the line."""

    class IoError(Error, OSError):
        """A file cannot be opened, read or written."""

    class GeometryError(Error, ArithmeticError):
        """The shapes cannot be processed."""

    class ConvergenceError(Error, ArithmeticError):
        """An iteration did not converge."""

    class DeviceError(Error, RuntimeError):
        """The back end is missing or failed."""

    class OutOfMemoryError(Error, MemoryError):
        """A grid or mesh does not fit into memory."""

    class Cancelled(Error, RuntimeError):
        """The computation was cancelled."""

    class InternalError(Error, RuntimeError):
        """A mistake of espdiff's own; please report it."""


BY_CLASS = {
    "INPUT": InputError, "FORMAT": FormatError, "IO": IoError, "GEOMETRY": GeometryError,
    "CONVERGENCE": ConvergenceError, "DEVICE": DeviceError, "MEMORY": OutOfMemoryError, "CANCELLED": Cancelled,
    "INTERNAL": InternalError,
}
