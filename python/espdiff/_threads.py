"""How the engine's threads wait, which their library asks the environment while it is loaded."""

import contextlib
import os

BRIEF_SPINS = "5000"  # kBriefSpins in src/engine/compute_thread.h


def is_loaded(library):
    try:
        import ctypes
        ctypes.CDLL(library, mode=os.RTLD_NOLOAD)
    except (ImportError, OSError, AttributeError):  # Python inside another program may have no ctypes
        return False
    return True


@contextlib.contextmanager
def brief_spins():
    """While the extension is loaded: a thread looks briefly for more work before it sleeps. The user's settings are kept; a library
    that another package has loaded no longer asks."""
    if any(name in os.environ for name in ("GOMP_SPINCOUNT", "OMP_WAIT_POLICY")) or is_loaded("libgomp.so.1"):
        yield
        return
    os.environ["GOMP_SPINCOUNT"] = BRIEF_SPINS
    try:
        yield
    finally:
        del os.environ["GOMP_SPINCOUNT"]
