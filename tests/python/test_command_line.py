"""The command line's trajectories in every format, against MDAnalysis' coordinates."""

import csv
import json
import os
import subprocess

import numpy as np
import pytest

import espdiff

mda = pytest.importorskip("MDAnalysis", reason="SKIPPED: no MDAnalysis")

SETTINGS = {"potential": "none", "grid_spacing": 2.5}
OPTIONS = ["--potential", "none", "--grid-spacing", "2.5", "--start", "source"]


@pytest.fixture(scope="module")
def adk(data):
    files = [data / "traj_adk" / name for name in ("adk.psf", "adk_dims.dcd")]
    return mda.Universe(*map(str, files))


@pytest.fixture
def trajectory(program, tmp_path):
    """Rows of `espdiff trajectory`."""

    def rows(*arguments, options=OPTIONS):
        output = tmp_path / "rows.csv"
        subprocess.run([program, "trajectory", *map(os.fspath, arguments), "-o", output, "--overwrite", "-q", *options],
                       check=True)
        with open(output) as lines:
            return list(csv.DictReader(line for line in lines if not line.startswith("#")))

    return rows


@pytest.fixture
def plugins(program):
    doctor = subprocess.run([program, "doctor"], capture_output=True, text=True, check=True).stdout
    if "by VMD's plugins" not in doctor:
        pytest.skip("SKIPPED: VMD's molfile plugins are absent; put `vmd` on PATH, or set VMDDIR")


def write_frames(atoms, path, frames):
    with mda.Writer(str(path), len(atoms)) as writer:
        for frame in frames:
            atoms.universe.trajectory[frame]
            writer.write(atoms)


# Relative differences of the numbers: TRR rounds to nm in single precision, XTC to 0.01 A.
@pytest.mark.parametrize("ending, tolerance", [("dcd", 1e-12), ("trr", 2e-3), ("nc", 1e-12), ("xtc", 2e-2)])
def test_every_format_gives_the_coordinates(adk, trajectory, tmp_path, ending, tolerance, request):
    if ending in ("trr", "xtc"):
        request.getfixturevalue("plugins")
    frames = [0, 3]
    path = tmp_path / f"frames.{ending}"
    write_frames(adk.atoms, path, frames)
    rows = trajectory(adk.filename, path)
    assert [row["frame"] for row in rows] == ["0", "1"]
    adk.trajectory[0]
    series = espdiff.Series(adk.atoms, start="source", **SETTINGS)
    adk.trajectory[3]
    expected = series.step(adk.atoms).metrics
    for name in ("rmsd_A", "mean_displacement_A", "area_mapped_A2"):
        assert float(rows[1][name]) == pytest.approx(expected[name], rel=tolerance), name


def test_a_structure_and_a_trajectory(adk, data, trajectory, tmp_path):
    """Atoms, charges and radii of a PQR, coordinates of a DCD."""
    path = tmp_path / "one.dcd"
    write_frames(adk.atoms, path, [97])
    pqr = data / "traj_adk" / "adk_open.pqr"
    row = trajectory(pqr, path)[0]
    positions = adk.trajectory[97].positions
    source = mda.Universe(str(pqr))
    moved = mda.Universe(str(pqr))
    moved.atoms.positions = positions
    expected = espdiff.compare(source.atoms, moved.atoms, **SETTINGS).metrics
    assert float(row["rmsd_A"]) == pytest.approx(expected["rmsd_A"], rel=1e-5)
    assert np.isfinite(float(row["area_mapped_A2"]))


def test_a_prmtop_beside_coordinates(data, program, trajectory, tmp_path):
    """Charges of --topology are those that MDAnalysis reads, in a box with water."""
    box = data / "box_tz2"
    universe = mda.Universe(str(box / "tz2.truncoct.parm7"), str(box / "tz2.truncoct_from_nc.dcd"))
    files, groups = [], []
    for frame in (0, 3):
        universe.trajectory[frame]
        files.append(str(tmp_path / f"{frame}.pdb"))
        universe.atoms.write(files[-1])
        moved = mda.Universe(files[-1])
        moved.add_TopologyAttr("charges", universe.atoms.charges)
        groups.append(moved.select_atoms("not resname WAT"))
    subprocess.run([program, "compare", *files, "--topology", box / "tz2.truncoct.parm7", "--radii", "element", "--potential",
                    "coulomb", "--grid-spacing", "1.5", "-o", tmp_path / "out", "-q"], check=True)
    result = json.loads((tmp_path / "out.json").read_text())
    expected = espdiff.compare(*groups, potential="coulomb", grid_spacing=1.5).metrics
    assert result["mean_abs_difference"] == pytest.approx(expected["mean_abs_difference"], rel=1e-5)
    assert expected["mean_abs_difference"] > 0.1
    # The same topology as the source of a trajectory: DCD has more digits than PDB.
    coulomb = ["--potential", "coulomb", "--radii", "element", "--grid-spacing", "1.5"]
    row = trajectory(box / "tz2.truncoct.parm7", universe.trajectory.filename, "--frames", "3", options=coulomb)[0]
    assert float(row["mean_abs_difference"]) == pytest.approx(expected["mean_abs_difference"], rel=0.01)


def test_amber_restarts_give_the_coordinates(data, trajectory, tmp_path):
    """As text, which MDAnalysis reads, and as its NetCDF; water is left out. The topology is beside both, or the source."""
    box = data / "box_tz2"
    universe = mda.Universe(str(box / "tz2.truncoct.parm7"), str(box / "tz2.truncoct_from_nc.dcd"))
    universe.trajectory[3]
    restart, netcdf = tmp_path / "a.rst7", tmp_path / "b.nc"
    numbers = [f"{x:12.7f}" for x in [*universe.atoms.positions.ravel(), *universe.dimensions]]
    lines = ["".join(numbers[i:i + 6]) for i in range(0, len(numbers), 6)]
    restart.write_text("\n".join([f"tz2\n{len(universe.atoms)}", *lines, ""]))
    written = mda.Universe(universe.filename, str(restart), format="INPCRD").atoms.positions
    assert np.abs(written - universe.atoms.positions).max() < 1e-5
    write_frames(universe.atoms, netcdf, [3])
    for file in (restart, netcdf):
        (tmp_path / f"{file.stem}.parm7").write_bytes((box / "tz2.truncoct.parm7").read_bytes())
        protein = universe.select_atoms("not resname WAT")
        metrics = espdiff.compare(str(file), protein, potential="coulomb", radii="element", grid_spacing=1.5).metrics
        assert metrics["rmsd_A"] < 1e-5
        assert metrics["mean_abs_difference"] < 1e-3
    row = trajectory(tmp_path / "a.parm7", restart, options=OPTIONS)[0]
    assert float(row["rmsd_A"]) < 1e-5
