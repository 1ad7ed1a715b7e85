"""AtomGroups that cannot be compared are one exception that names the argument and the remedy; memory of large ones."""

import pickle
import subprocess
import sys
import tracemalloc

import numpy as np
import pytest

import espdiff
from conftest import QUICK, made_arrays

mda = pytest.importorskip("MDAnalysis", reason="SKIPPED: no MDAnalysis")

from espdiff.mda import SurfacePotential  # noqa: E402

ATTRIBUTES = {"names": "names", "radii": "radii", "charges": "charges", "elements": "elements"}


def universe(bend=0.0, without=(), n_frames=1):
    """The made protein as a universe; frames that bend more and more."""
    arrays = made_arrays(bend)
    n = len(arrays["positions"])
    made = mda.Universe.empty(n, n_residues=12, atom_resindex=np.arange(n) // 10, trajectory=True)
    for attribute, key in ATTRIBUTES.items():
        if attribute not in without:
            made.add_TopologyAttr(attribute, arrays[key])
    made.add_TopologyAttr("resnames", ["TYR"] * 12)
    made.add_TopologyAttr("resids", range(1, 13))
    frames = np.array([made_arrays(bend + 0.01 * frame)["positions"] for frame in range(n_frames)], np.float32)
    made.load_new(frames)
    return made


def refused(text, *arguments, **options):
    with pytest.raises(espdiff.InputError, match=text) as caught:
        espdiff.compare(*arguments, **{**QUICK, **options})
    assert isinstance(caught.value, ValueError)


def test_without_charges():
    bare = universe(without=["charges"]).atoms
    text = r"the AtomGroup has no charges, which potential='pb' needs; load a topology that has them \(PSF, TPR, prmtop\), add"
    refused("source: " + text, bare, universe(0.02).atoms, potential="pb")
    refused("target: " + text, universe(0.02).atoms, bare, potential="pb")
    with pytest.raises(espdiff.InputError, match=r"states\[1\]: " + text):
        espdiff.matrix([universe().atoms, bare], potential="pb")
    assert not espdiff.compare(bare, universe(0.02).atoms, **QUICK).has_potential


def test_without_radii():
    nothing = universe(without=["radii", "names", "elements"]).atoms
    refused(r"source: radii: the topology has none, and neither names nor elements.*add_TopologyAttr\('radii', values\)",
            nothing, universe(0.02).atoms)
    guessed = espdiff.state(universe(without=["radii"]).atoms)  # by element
    assert len(guessed) == 120 and guessed.radii.min() > 1


def test_empty():
    refused("target: the AtomGroup is empty", universe().atoms, universe().select_atoms("resid 99"))
    with pytest.raises(espdiff.InputError, match="atomgroup: it is empty"):
        SurfacePotential(universe().select_atoms("resid 99"))
    with pytest.raises(espdiff.InputError, match="atomgroup: a str is no AtomGroup; give universe.select_atoms"):
        SurfacePotential("protein")


def test_differing_universes():
    other = universe()
    other.add_TopologyAttr("resnames", ["XYZ"] * 12)
    other.add_TopologyAttr("names", [f"Q{i}" for i in range(120)])
    other.add_TopologyAttr("resids", range(101, 113))
    refused("only 0 atoms of the two molecules pair, at least 3 are needed; source universe: 120 atoms.*give two states of one molecule",
            universe().atoms, other.atoms)
    with pytest.raises(ValueError):  # MDAnalysis' own
        universe().atoms + other.atoms


def test_positions_that_are_not_finite():
    broken = universe()
    broken.trajectory.ts.positions[7, 1] = np.nan
    refused("target: positions: atom 7 has a coordinate that is not finite", universe().atoms, broken.atoms)


def test_a_universe_that_moved_on():
    moving = universe(n_frames=4)
    first = moving.atoms  # not a copy: it moves with the universe
    kept = espdiff.state(first)
    moving.trajectory[3]
    refused(r"target: the AtomGroup has the source's own atoms, and their universe shows frame 3 alone; keep a frame "
            r"before the universe moves on, first = espdiff.state\(atoms\)", first, moving.atoms)
    result = espdiff.compare(kept, moving.atoms, **QUICK)
    assert result.metrics["rmsd_A"] > 0.1
    assert np.allclose(kept.positions, made_arrays()["positions"], atol=1e-4)
    with pytest.raises(espdiff.InputError, match="reference: the AtomGroup is of the universe whose frames are compared"):
        SurfacePotential(moving.atoms, reference=moving.atoms)
    assert SurfacePotential(moving.atoms, reference=kept, **QUICK).run(stop=1).results.metrics["mean_displacement_A"][0] < 0.01


def test_no_trajectory():
    made = mda.Universe.empty(3)
    made.add_TopologyAttr("names", ["C", "C", "C"])
    with pytest.raises(espdiff.InputError, match="source: the universe has no coordinates; load a trajectory or a structure"):
        espdiff.compare(made.atoms, made.atoms[:2])


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("order", ["C", "F"])
def test_coordinates_of_any_type_and_order(dtype, order):
    made = universe()
    made.trajectory.ts._pos = np.array(made.trajectory.ts.positions, dtype=dtype, order=order)
    assert np.allclose(espdiff.state(made.atoms[5:80:3]).positions, made_arrays()["positions"][5:80:3], atol=1e-4)


def test_rows():
    positions = made_arrays()["positions"]
    with pytest.raises(espdiff.InputError, match="rows: positions has no row 120; there are 120"):
        espdiff.State.from_arrays(positions, np.ones(1), rows=np.array([120]))
    with pytest.raises(espdiff.InputError, match="rows: .*one whole number for each atom is needed"):
        espdiff.State.from_arrays(positions, np.ones(1), rows=np.array([0.5]))


def test_states_travel_to_other_processes(made, data, tmp_path):
    groups = universe()
    groups.dimensions = [40, 40, 40, 90, 90, 90]
    part = groups.select_atoms("resid 1:8")
    given = [made[0], espdiff.state(part), espdiff.State.read(str(data / "ubq" / "ubq.pqr"))]
    given.append(made[1].with_map(np.ones((9, 9, 9), np.float32) * 0.5, [-20, -20, -20], [5, 5, 5], "kT/e"))
    for state in given:
        copy = pickle.loads(pickle.dumps(state))
        assert copy.sha256 == state.sha256 and copy.name == state.name
        assert np.array_equal(copy.positions, state.positions) and np.array_equal(copy.radii, state.radii)
    own = espdiff.compare(given[3], made[0].with_map(np.ones((9, 9, 9)), [-20, -20, -20], [5, 5, 5]), **QUICK)
    again = espdiff.compare(pickle.loads(pickle.dumps(given[3])),
                            made[0].with_map(np.ones((9, 9, 9)), [-20, -20, -20], [5, 5, 5]), **QUICK)
    assert np.array_equal(own.difference, again.difference)
    changed = tmp_path / "a.pqr"
    changed.write_bytes((data / "ubq" / "ubq.pqr").read_bytes())
    kept = pickle.dumps(espdiff.State.read(str(changed)))
    changed.write_bytes((data / "series19_ubq_2k39" / "m01.pqr").read_bytes())
    with pytest.raises(espdiff.InputError, match="a.pqr: it has changed since the State was made of it"):
        pickle.loads(kept)


def test_positions_are_copied_once():
    """100,000 atoms: NumPy copies nothing, and the engine keeps one copy, without a second one on the way."""
    n = 100_000
    large = mda.Universe.empty(n, trajectory=True)
    large.add_TopologyAttr("radii", np.full(n, 1.5))
    large.load_new(np.random.default_rng(1).uniform(0, 200, (1, n, 3)).astype(np.float32))
    atoms = large.atoms
    asked = []
    frame = large.trajectory.ts
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    radii = atoms.radii
    radii_bytes = tracemalloc.get_traced_memory()[0] - before
    del radii
    tracemalloc.reset_peak()
    before = tracemalloc.get_traced_memory()[0]
    state = espdiff.state(atoms)
    asked = tracemalloc.get_traced_memory()[1] - before
    tracemalloc.stop()
    assert len(state) == n
    assert asked < radii_bytes + frame.positions.nbytes / 10, f"{asked} bytes, of which {radii_bytes} are the radii's"


GROWTH = """
import re
import numpy as np
import espdiff
n = 1_000_000
positions, radii = np.random.default_rng(1).uniform(0, 500, (n, 3)).astype(np.float32), np.full(n, 1.5, np.float32)
espdiff.State.from_arrays(positions[:1000], radii[:1000])
def kilobytes(key):
    return int(re.search(key + r":\\s+(\\d+)", open("/proc/self/status").read()).group(1))
open("/proc/self/clear_refs", "w").write("5")
before = kilobytes("VmRSS")
state = espdiff.State.from_arrays(positions, radii)
print((kilobytes("VmHWM") - before) * 1024 / n)
"""


def test_the_engine_makes_no_second_copy():
    """The peak of memory by atom: 24 bytes of positions, 4 of radius, 88 of names, residue and what the file knows of the place,
    16 of a list on the way (132 measured); a second copy of the positions would be 24 more."""
    run = subprocess.run([sys.executable, "-c", GROWTH], capture_output=True, text=True)
    if "clear_refs" in run.stderr:
        pytest.skip("SKIPPED: the kernel does not let a process reset its peak of memory")
    assert run.returncode == 0, run.stderr
    assert 116 < float(run.stdout) < 146
