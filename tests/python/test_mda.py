"""MDAnalysis: AtomGroups as states, and trajectories."""

import numpy as np
import pytest

import espdiff
from conftest import QUICK

mda = pytest.importorskip("MDAnalysis", reason="SKIPPED: no MDAnalysis")

from espdiff.mda import SurfacePotential  # noqa: E402


@pytest.fixture(scope="module")
def universe(data):
    psf, dcd = sorted((data / "traj_adk").glob("*.psf")), sorted((data / "traj_adk").glob("*.dcd"))
    if not psf or not dcd:
        pytest.skip("SKIPPED: no PSF and DCD among the real inputs")
    return mda.Universe(str(psf[0]), str(dcd[0]))


def test_an_atomgroup_is_a_state(universe, tmp_path):
    atoms = universe.select_atoms("protein")
    result = espdiff.compare(espdiff.state(atoms), atoms, potential="none", grid_spacing=2)
    assert result.metrics["mean_displacement_A"] < 0.01
    assert len(result.source) == len(atoms)
    assert np.allclose(result.source.positions, atoms.positions)
    assert np.allclose(result.source.charges, atoms.charges)


def test_empty_and_missing(universe):
    with pytest.raises(espdiff.InputError, match="source: the AtomGroup is empty"):
        espdiff.compare(universe.select_atoms("resname NONE"), universe.atoms)
    with pytest.raises(espdiff.InputError, match="atomgroup: it is empty"):
        SurfacePotential(universe.select_atoms("resname NONE"))
    with pytest.raises(espdiff.InputError, match="reference: there is no frame 9999"):
        SurfacePotential(universe.atoms, reference=9999, **QUICK).run(stop=1)


@pytest.fixture
def row(tmp_path):
    """Nine carbon atoms in three frames, without charges, and their DCD."""
    def atom(i, frame):
        return (f"ATOM  {i + 1:5d}  CA  ALA A{i + 1:4d}    {1.5 * i:8.3f}{0.6 * (i % 2):8.3f}{0.2 * frame * max(0, i - 4):8.3f}"
                "  1.00  0.00           C\n")
    (tmp_path / "row.pdb").write_text("".join(
        f"MODEL {frame + 1:8d}\n" + "".join(atom(i, frame) for i in range(9)) + "ENDMDL\n" for frame in range(3)) + "END\n")
    made = mda.Universe(str(tmp_path / "row.pdb"))
    with mda.Writer(str(tmp_path / "row.dcd"), 9) as writer:
        for _ in made.trajectory:
            writer.write(made.atoms)
    return mda.Universe(str(tmp_path / "row.pdb"), str(tmp_path / "row.dcd"))


def test_a_universe_without_charges(row):
    for options in ({}, {"potential": "coulomb"}):
        with pytest.raises(espdiff.InputError, match="row.pdb, frame 0: has no charges, and PDB2PQR .*topology=.FILE.") as error:
            SurfacePotential(row.atoms, **options).run()
        assert "\n" not in str(error.value)
    empty = mda.Universe.empty(5, trajectory=True)
    with pytest.raises(espdiff.InputError, match="source: radii: the topology has none, .*add_TopologyAttr"):
        espdiff.compare(empty, row)
    with pytest.raises(espdiff.InputError, match="source: the universe has no coordinates; load a trajectory"):
        espdiff.compare(mda.Universe.empty(5), row)


def test_a_trajectory_that_ends_too_early_or_is_gone(row, tmp_path):
    path = tmp_path / "row.dcd"
    whole = path.read_bytes()
    path.write_bytes(whole[:-40])
    again = r"row\.dcd: MDAnalysis cannot read all of its frames \(it ends too early\); copy or write the file again, or name "
    with pytest.raises(espdiff.IoError, match=again):
        SurfacePotential(row.atoms, potential="none", grid_spacing=2).run()
    run = SurfacePotential(row.atoms, potential="none", grid_spacing=2).run(frames=[0, 1])
    assert list(run.results.frames) == [0, 1]


def test_frames_have_the_numbers_of_compare(universe):
    atoms = universe.select_atoms("protein")
    options = {"potential": "none", "grid_spacing": 2, "threads": 1}
    run = SurfacePotential(atoms, reference=0, residues=True, **options).run(start=0, stop=5, step=2)
    assert list(run.results.frames) == [0, 2, 4]
    universe.trajectory[0]
    reference = espdiff.State.from_arrays(**_arrays(atoms))
    universe.trajectory[4]
    alone = espdiff.compare(reference, espdiff.State.from_arrays(**_arrays(atoms)), **options)
    assert run.results.metrics["mean_displacement_A"][2] == alone.metrics["mean_displacement_A"]
    assert run.results.residues.shape == (3, len(alone.residues))
    assert run.results.trustworthy.dtype == bool


def _arrays(atoms):
    return {
        "positions": atoms.positions.copy(), "charges": atoms.charges, "names": list(atoms.names),
        "residue_names": list(atoms.resnames), "residue_numbers": [int(n) for n in atoms.resids],
        "chains": list(atoms.segids),
    }


@pytest.mark.parametrize("backend", ["multiprocessing", "dask"])
def test_workers_give_the_same_bits(workers, universe, backend):
    if backend == "dask":
        pytest.importorskip("dask", reason="SKIPPED: no dask")
    atoms = universe.select_atoms("protein")
    options = {"potential": "none", "grid_spacing": 2.5, "threads": 1}
    one = SurfacePotential(atoms, **options).run(stop=4)
    two = SurfacePotential(atoms, **options).run(stop=4, backend=backend, n_workers=2)
    for name, values in one.results.metrics.items():
        assert np.array_equal(values, two.results.metrics[name], equal_nan=True), name


def test_an_mdanalysis_without_workers(universe, monkeypatch):
    """2.7 is the last one for Python 3.9."""
    import espdiff.mda

    if hasattr(mda.analysis.base.AnalysisBase, "get_supported_backends"):
        monkeypatch.setattr(espdiff.mda, "ResultsGroup", None)
    else:
        with pytest.raises(espdiff.InputError, match="backend: 'multiprocessing' needs MDAnalysis 2.8 or newer, and this is 2"):
            SurfacePotential(universe.atoms, potential="none").run(stop=1, backend="multiprocessing", n_workers=2)
    with pytest.raises(espdiff.InputError, match="backend: 'dask' needs MDAnalysis 2.8 or newer, and this is 2"):
        espdiff.mda.Ensemble({"one": [universe.atoms]}).run(stop=1, backend="dask", n_workers=2)
