"""Threads, signals, forks and memory of a process that computes much."""

import multiprocessing
import os
import resource
import signal
import threading
import time

import numpy as np
import pytest

import espdiff
from conftest import QUICK, made_arrays


def test_control_c_ends_a_computation(data):
    pair = [data / "series19_ubq_2k39" / f"m0{i}.pqr" for i in (1, 2)]
    begun = []

    def interrupt():
        while not begun:
            time.sleep(0.01)
        time.sleep(0.3)
        begun.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    # Python installs no handler where the shell that started it ignores SIGINT, as in the background.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    thread = threading.Thread(target=interrupt)
    thread.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            espdiff.compare(*pair, grid_spacing=0.5, pb_spacing=0.3, progress=lambda stage, fraction: begun.append(stage))
    finally:
        signal.signal(signal.SIGINT, before)
    waited = time.monotonic() - [t for t in begun if isinstance(t, float)][0]
    thread.join()
    assert waited < 2  # of a busy machine; 0.2 s on a quiet one


def test_an_error_of_the_listener_ends_the_computation(made):
    def fail(stage, fraction):
        raise RuntimeError(f"mine, in {stage}")

    with pytest.raises(RuntimeError, match="mine, in"):
        espdiff.compare(*made, progress=fail, threads=1)


def test_progress_reaches_the_end(made):
    told = []
    espdiff.compare(*made, progress=lambda stage, fraction: told.append((stage, fraction)), **QUICK)
    assert told and all(0 <= fraction <= 1 for _, fraction in told)


def test_two_threads_at_once(made):
    expected = espdiff.compare(*made, **QUICK).metrics["mean_abs_difference"]
    found = []
    threads = [threading.Thread(target=lambda: found.append(espdiff.compare(*made, **QUICK).metrics["mean_abs_difference"]))
               for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected, expected]


def _in_child(queue):
    states = [espdiff.State.from_arrays(**made_arrays(bend)) for bend in (0.0, 0.02)]
    queue.put(espdiff.compare(*states, grid_spacing=1.5, threads=2).metrics["mean_abs_difference"])


def test_a_process_that_has_computed_can_fork(made):
    expected = espdiff.compare(*made, grid_spacing=1.5, threads=2).metrics["mean_abs_difference"]
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=_in_child, args=(queue,))
    child.start()
    assert queue.get(timeout=120) == expected
    child.join(timeout=60)
    assert child.exitcode == 0


def test_memory_stays_flat(made):
    def resident():
        with open("/proc/self/statm") as statm:
            return int(statm.read().split()[1]) * resource.getpagesize()

    series = int(os.environ.get("ESPDIFF_COMPARISONS", "40"))
    for _ in range(10):
        espdiff.compare(*made, potential="none", **QUICK)
    before = resident()
    for _ in range(series):
        result = espdiff.compare(*made, potential="none", **QUICK)
        result.positions, result.residues, result.to_dict()
    grown = resident() - before
    assert grown < 5e6, f"{grown / series / 1e3:.1f} kB a comparison"


def test_numpy_copies_no_positions():
    import tracemalloc

    n = 100_000
    positions = np.random.default_rng(1).uniform(0, 200, (n, 3)).astype(np.float32)
    radii = np.full(n, 1.5, np.float32)
    tracemalloc.start()
    state = espdiff.State.from_arrays(positions, radii)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(state) == n
    assert peak < positions.nbytes / 4  # tracemalloc sees NumPy's copies, not the engine's one
