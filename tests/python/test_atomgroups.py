"""AtomGroups that cannot be compared are one exception that names the argument and the remedy; memory of large ones."""

import gzip
import pathlib
import pickle
import shutil
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
    text = "universe: has no charges, and PDB2PQR cannot prepare it"
    refused(text, bare, universe(0.02).atoms, potential="pb")
    refused(text + '.*; `potential="none"` compares shapes alone', universe(0.02).atoms, bare)
    with pytest.raises(espdiff.InputError, match=text):
        espdiff.matrix([universe().atoms, bare], potential="pb")
    assert not espdiff.compare(bare, universe(0.02).atoms, potential="none", **QUICK).has_potential


TRPCAGE = pathlib.Path(__file__).resolve().parents[1] / "data" / "ensembles"
WATER = "HETATM  999  O   HOH B 301      40.000  40.000  40.000  1.00  0.00           O\n"


@pytest.fixture
def pair(tmp_path):
    """Two structures without charges, with a water and an alternate location."""
    if not shutil.which("pdb2pqr"):
        pytest.skip("SKIPPED: PDB2PQR is not there; scripts/install-packages runtime")
    paths = []
    for name in ("wild", "mutant"):
        lines = gzip.decompress((TRPCAGE / f"trpcage_{name}_1.pdb.gz").read_bytes()).decode().splitlines(keepends=True)
        end = next(i for i, line in enumerate(lines) if line.startswith(("ENDMDL", "END")))
        atoms = [line for line in lines[:end] if line.startswith("ATOM")]
        at = next(i for i, line in enumerate(atoms) if line[12:16].strip() == "CG" and line[17:20] == "LEU")
        worse = atoms[at][:16] + "B" + atoms[at][17:30] + "  99.000" + atoms[at][38:54] + "  0.30" + atoms[at][60:]
        atoms[at:at + 1] = [worse, atoms[at][:16] + "A" + atoms[at][17:54] + "  0.70" + atoms[at][60:]]
        path = tmp_path / f"{name}.pdb"
        path.write_text("".join([*atoms, WATER, "END\n"]))
        paths.append(path)
    return paths


def test_universes_are_prepared_as_their_files(pair):
    """By path, as a Universe, as ProDy's atoms: the same bits, and never an answer without a difference."""
    options = {"grid_spacing": 1.2, "threads": 1}
    by_path = espdiff.compare(*pair, **options)
    assert by_path.has_potential and by_path.unit == "kT/e"
    universes = [mda.Universe(str(path)) for path in pair]
    same = espdiff.compare(*universes, **options)
    assert np.array_equal(same.difference, by_path.difference, equal_nan=True) and same.unit == "kT/e"
    assert same.to_dict()["preparation"]["source"]["n_hydrogens_added"] == by_path.to_dict()["preparation"]["source"]["n_hydrogens_added"]
    groups = espdiff.compare(*[u.select_atoms("protein") for u in universes], **options)
    assert np.array_equal(groups.difference, by_path.difference, equal_nan=True)
    states = espdiff.compare(*[espdiff.state(u) for u in universes], **options)
    assert np.array_equal(states.difference, by_path.difference, equal_nan=True)
    step = espdiff.Series(universes[0], start="source", **options).step(universes[1])
    file_step = espdiff.Series(pair[0], start="source", **options).step(pair[1])
    assert np.array_equal(step.difference, file_step.difference, equal_nan=True) and step.to_dict()["preparation"]["source"] is not None
    assert np.array_equal(espdiff.matrix(universes, **options)["mean_abs_difference"],
                          espdiff.matrix(pair, **options)["mean_abs_difference"], equal_nan=True)
    prody = pytest.importorskip("prody", reason="SKIPPED: no ProDy")
    prody.confProDy(verbosity="none")
    atoms = [prody.parsePDB(str(path), altloc="A") for path in pair]
    assert np.array_equal(espdiff.compare(*atoms, **options).difference, by_path.difference, equal_nan=True)


def test_a_universe_has_its_water_around_it():
    wet = universe(n_frames=1)
    wet.dimensions = [60, 60, 60, 90, 90, 90]
    wet.residues[-1].resname = "HOH"
    assert len(espdiff.state(wet)) == 110 and len(espdiff.state(wet.atoms)) == 120


def test_prepare(pair, tmp_path):
    made = espdiff.prepare(mda.Universe(str(pair[0])), ph=7)
    assert made.charges.sum() == pytest.approx(1, abs=1e-3) and made.preparation["force_field"] == "parse"
    made.save(tmp_path / "wild.pqr")
    assert np.allclose(espdiff.State.read(tmp_path / "wild.pqr").charges, made.charges)
    copy = pickle.loads(pickle.dumps(made))
    assert copy.preparation == made.preparation and copy.sha256 == made.sha256
    charged = espdiff.prepare(tmp_path / "wild.pqr")
    assert charged.preparation is None and np.array_equal(charged.charges, made.charges)
    assert len(espdiff.prepare(tmp_path / "wild.pqr", select="//A/1-10")) < len(made)
    with pytest.raises(espdiff.InputError, match="the state lacks them; espdiff.prepare"):
        espdiff.state(mda.Universe(str(pair[0]))).save(tmp_path / "none.pqr")


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
