"""The command line's trajectories in every format, against MDAnalysis' coordinates."""

import csv
import os
import subprocess

import numpy as np
import pytest

import espdiff

mda = pytest.importorskip("MDAnalysis", reason="SKIPPED: no MDAnalysis")

SETTINGS = {"potential": "none", "grid_spacing": 2.5}
OPTIONS = ["--potential", "none", "--grid-spacing", "2.5", "--start", "source", "-q"]


@pytest.fixture(scope="module")
def adk(data):
    files = [data / "traj_adk" / name for name in ("adk.psf", "adk_dims.dcd")]
    return mda.Universe(*map(str, files))


@pytest.fixture
def trajectory(program, tmp_path):
    """Rows of `espdiff trajectory`."""
    doctor = subprocess.run([program, "doctor"], capture_output=True, text=True, check=True).stdout
    if "by VMD's plugins" not in doctor:
        pytest.skip("SKIPPED: VMD's molfile plugins are absent; put `vmd` on PATH, or set VMDDIR")

    def rows(*arguments):
        output = tmp_path / "rows.csv"
        subprocess.run([program, "trajectory", *map(os.fspath, arguments), "-o", output, "--overwrite", *OPTIONS], check=True)
        with open(output) as lines:
            return list(csv.DictReader(line for line in lines if not line.startswith("#")))

    return rows


def write_frames(atoms, path, frames):
    with mda.Writer(str(path), len(atoms)) as writer:
        for frame in frames:
            atoms.universe.trajectory[frame]
            writer.write(atoms)


# How far a format rounds: XTC to 0.01 A; TRR to nm in single precision.
@pytest.mark.parametrize("ending, tolerance", [("dcd", 0), ("trr", 2e-5), ("nc", 0), ("xtc", 1e-2)])
def test_every_format_gives_the_coordinates(adk, trajectory, tmp_path, ending, tolerance):
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
        assert float(rows[1][name]) == pytest.approx(expected[name], rel=1e-12 if tolerance == 0 else 20 * tolerance), name


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
