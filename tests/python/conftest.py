"""Inputs of the package's tests: a small made protein, and real ones where they are."""

import json
import os
import pathlib
import re
import signal

import numpy as np
import pytest

DATA = pathlib.Path(os.environ.get("ESPDIFF_DATA") or pathlib.Path(__file__).resolve().parents[3] / "shared" / "data")


@pytest.fixture(scope="session")
def data():
    """The folder of real inputs."""
    if not DATA.is_dir():
        pytest.skip("SKIPPED: real inputs are absent; set ESPDIFF_DATA to their folder")
    return DATA


def made_arrays(bend=0.0):
    """A lopsided ball of 120 atoms in 12 residues, with charges; `bend` deforms it."""
    random = np.random.default_rng(7)
    points = []
    while len(points) < 120:
        p = random.uniform(-7, 7, 3)
        if np.linalg.norm(p) < 7 and all(np.linalg.norm(p - q) > 1.2 for q in points):
            points.append(p)
    at = np.array(points)
    at = at[np.argsort(at[:, 0])] * [1.3, 1.0, 0.9]
    at[:, 2] += bend * at[:, 0] ** 2
    names = ["N", "CA", "C", "O", "CB", "CG", "CD", "CE", "CZ", "OH"]
    return {
        "positions": at,
        "radii": np.full(120, 1.8),
        "charges": np.where(np.arange(120) % 7 == 0, np.linspace(-1, 1, 120), 0.0),
        "names": [names[i % 10] for i in range(120)],
        "elements": [names[i % 10][0] for i in range(120)],
        "residue_names": ["TYR"] * 120,
        "residue_numbers": [i // 10 + 1 for i in range(120)],
        "chains": ["A"] * 120,
    }


@pytest.fixture
def arrays():
    return made_arrays


@pytest.fixture
def made():
    """Two states of the made protein."""
    import espdiff

    return tuple(espdiff.State.from_arrays(**made_arrays(bend), name=name) for bend, name in ((0.0, "a"), (0.02, "b")))


QUICK = {"grid_spacing": 1.5, "threads": 1}


@pytest.fixture(scope="session")
def program():
    """The command line of the same build."""
    path = os.environ.get("ESPDIFF_PROGRAM")
    if not path or not os.access(path, os.X_OK):
        pytest.skip("SKIPPED: no command line; set ESPDIFF_PROGRAM to its path")
    return path


@pytest.fixture
def page_record():
    """What the page of a result's files holds, by the prefix of the result."""
    import espdiff

    def record(prefix):
        try:
            page = espdiff.report(prefix)
        except espdiff.DeviceError as error:
            assert "libjs-three" in str(error)
            pytest.skip("SKIPPED: built without libjs-three")
        return json.loads(re.search(r'<script[^>]*id="record"[^>]*>(.*?)</script>', page, re.DOTALL).group(1))

    return record


@pytest.fixture
def workers():
    """Tests whose analyses run in several processes."""
    base = pytest.importorskip("MDAnalysis.analysis.base", reason="SKIPPED: no MDAnalysis")
    if not hasattr(base.AnalysisBase, "get_supported_backends"):
        pytest.skip("SKIPPED: MDAnalysis before 2.8 has no workers")


@pytest.fixture
def interrupts():
    """Ctrl-C as Python has it at the prompt: the shell may have it ignored, in the background, and packages set handlers of
    their own when they are imported (dask_jobqueue)."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
