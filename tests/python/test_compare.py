"""compare(): arrays, numbers and files, and the same bytes as the command line's."""

import json
import subprocess

import numpy as np
import pytest

import espdiff
from conftest import QUICK


def test_arrays_are_views_that_keep_their_owner(made):
    result = espdiff.compare(*made, **QUICK)
    positions, potential = result.positions, result.source_potential
    n = len(positions)
    assert positions.shape == (n, 3) and positions.dtype == np.float64
    assert potential.shape == (n,) and potential.dtype == np.float32
    assert result.triangles.max() == n - 1
    for array in (positions, potential, result.triangles, result.displacement):
        assert not array.flags.writeable
        assert not array.flags.owndata
    before = positions.copy()
    del result  # the arrays hold what they view
    espdiff.compare(*made, **QUICK)
    assert np.array_equal(positions, before)


def test_numbers_follow_from_the_arrays(made):
    result = espdiff.compare(*made, **QUICK)
    assert result.unit == "kT/e" and result.has_potential
    valid = np.isfinite(result.difference)
    weighted = (result.area[valid] * np.abs(result.difference[valid])).sum() / result.area[valid].sum()
    assert weighted == pytest.approx(result.metrics["mean_abs_difference"], rel=1e-6)
    assert result.area.sum() == pytest.approx(result.metrics["area_A2"], rel=1e-6)
    assert result.certificate.trustworthy == result.trustworthy
    assert len(result.residues) == 12
    assert "TYR" in set(result.residues["name"])


def test_the_self_comparison_has_no_difference(made):
    result = espdiff.compare(made[0], made[0], **QUICK)
    assert result.metrics["mean_abs_difference"] < 1e-4
    assert result.metrics["mean_displacement_A"] < 1e-3


def test_threads_do_not_change_bits(made):
    one = espdiff.compare(*made, grid_spacing=1.5, threads=1)
    two = espdiff.compare(*made, grid_spacing=1.5, threads=2)
    assert np.array_equal(one.positions, two.positions)
    assert np.array_equal(one.difference, two.difference, equal_nan=True)


def test_files_are_those_of_the_command_line(data, tmp_path, program):
    source, target = data / "series19_ubq_2k39" / "m01.pqr", data / "series19_ubq_2k39" / "m02.pqr"
    espdiff.compare(source, target, ionic_strength=0.1).save(tmp_path / "python")
    subprocess.run([program, "compare", source, target, "-o", tmp_path / "cli", "--ionic-strength", "0.1", "-q", "--exit-zero"],
                   check=True)
    for ending in (".vtp", ".residues.csv"):
        assert (tmp_path / f"python{ending}").read_bytes() == (tmp_path / f"cli{ending}").read_bytes()
    ours, theirs = (json.loads((tmp_path / f"{name}.json").read_text()) for name in ("python", "cli"))
    for content in (ours, theirs):
        for key in ("time_ms", "command_line"):
            assert content.pop(key)
    assert ours == theirs


def test_given_maps(made):
    maps = [espdiff.potential(state, "coulomb", pme_grid=1.0) for state in made]
    assert maps[0].values.ndim == 3 and not maps[0].values.flags.writeable
    given = espdiff.compare(*made, source_map=maps[0], target_map=maps[1], **QUICK)
    direct = espdiff.compare(*made, potential="coulomb", **QUICK)
    assert given.has_potential
    # Interpolated from a lattice of 1 A, against the sum at each vertex: 0.4 % measured.
    assert given.metrics["mean_abs_difference"] == pytest.approx(direct.metrics["mean_abs_difference"], rel=0.02)
    with pytest.raises(espdiff.InputError, match="computed potentials, and maps were given"):
        espdiff.compare(*made, source_map=maps[0], target_map=maps[1], potential="pb")


def test_series_is_compare_frame_by_frame(made):
    series = espdiff.Series(made[0], start="source", **QUICK)
    for target in (made[1], made[0]):
        step, alone = series.step(target), espdiff.compare(made[0], target, **QUICK)
        assert np.array_equal(step.positions, alone.positions)
        assert step.metrics["mean_abs_difference"] == alone.metrics["mean_abs_difference"]


def test_matrix_has_the_numbers_of_compare(made, tmp_path):
    matrix = espdiff.matrix(made, ["a", "b"], output=tmp_path / "m", **QUICK)
    assert (tmp_path / "m.csv").is_file() and matrix.labels == ["a", "b"]
    table = matrix["mean_abs_difference"]
    assert np.isnan(table[0, 0])
    assert table[0, 1] == espdiff.compare(*made, **QUICK).metrics["mean_abs_difference"]
    with pytest.raises(espdiff.InputError, match="exist"):
        espdiff.matrix(made, ["a", "b"], output=tmp_path / "m", **QUICK)


def test_a_matrix_has_the_bytes_of_the_command_line(data, program, tmp_path):
    files = [data / "series19_ubq_2k39" / f"m0{i}.pqr" for i in (1, 2)]
    espdiff.matrix(files, output=tmp_path / "python", potential="coulomb", **QUICK)
    words = ["--potential", "coulomb", "--grid-spacing", "1.5"]
    subprocess.run([program, "matrix", *files, *words, "-q", "-o", tmp_path / "cli"], check=True)
    for ending in (".csv", ".json"):
        assert (tmp_path / f"python{ending}").read_bytes() == (tmp_path / f"cli{ending}").read_bytes()


def test_a_matrix_through_a_template(made, tmp_path):
    states = [*made, made[0]]
    matrix = espdiff.matrix(states, ["a", "b", "c"], template="a", exact_sample=2, output=tmp_path / "m", **QUICK)
    table = matrix["mean_abs_difference"]
    assert np.array_equal(table, table.T, equal_nan=True) and table[0, 2] == 0 and table[0, 1] > 0
    assert "rmsd_A" not in matrix.metrics and "rmsd_A" in matrix.template["absent"]
    assert [state["label"] for state in matrix.template["states"]] == ["a", "b", "c"]
    assert len(matrix.template["exact"]["pairs"]) == 2
    assert (tmp_path / "m.h5").is_file()
    for shard in ("1/2", "2/2"):
        assert espdiff.matrix(states, ["a", "b", "c"], template="a", exact_sample=2, output=tmp_path / "p", shard=shard,
                              **QUICK) is None
    parts = sorted(tmp_path.glob("p.shard-*"))
    merged = espdiff.merge(parts, tmp_path / "merged")
    assert merged.to_dict() == matrix.to_dict()
    assert espdiff.matrix(made, ["a", "b"], **QUICK).template is None
    with pytest.raises(espdiff.InputError, match="template=.d.. is neither medoid"):
        espdiff.matrix(states, ["a", "b", "c"], template="d", **QUICK)
    with pytest.raises(espdiff.InputError, match="exact_sample.*'-1' is not a whole number of 0 or more"):
        espdiff.matrix(states, ["a", "b", "c"], template="a", exact_sample=-1, **QUICK)


def metrics_of(a, b, areas):
    """The metrics of two potentials, in the field's formulas; a vertex counts where both have a value."""
    counts = np.isfinite(a) & np.isfinite(b)
    a, b, w = a[counts].astype(float), b[counts].astype(float), areas[counts]
    mean = lambda values: (w * values).sum() / w.sum()
    return {
        "mean_abs_difference": mean(np.abs(b - a)),
        "rms_difference": np.sqrt(mean((b - a) ** 2)),
        "mean_signed_difference": mean(b - a),
        "sign_change_area_fraction": mean(a * b < 0),
        "hodgkin_index": 2 * mean(a * b) / (mean(a * a) + mean(b * b)),
        "carbo_index": mean(a * b) / np.sqrt(mean(a * a) * mean(b * b)),
    }


def test_a_matrix_through_a_template_follows_from_its_file(data, tmp_path):
    h5py = pytest.importorskip("h5py")
    files = [data / "series19_ubq_2k39" / f"m0{i}.pqr" for i in (0, 1, 2, 4)]
    labels = ["a", "b", "c", "d"]
    matrix = espdiff.matrix(files, labels, template="b", exact_sample=0, output=tmp_path / "m", potential="coulomb", **QUICK)
    with h5py.File(tmp_path / "m.h5") as file:
        grid = file["VTKHDF"]
        points, corners = grid["Points"][:], grid["Polygons/Connectivity"][:].reshape(-1, 3)
        potentials = grid["PointData/potential"][:].reshape(len(files), -1)
        potentials[grid["PointData/trusted"][:].reshape(len(files), -1) == 0] = np.nan
    sides = points[corners].astype(float)
    triangles = 0.5 * np.linalg.norm(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1)
    areas = np.bincount(corners.ravel(), np.repeat(triangles / 3, 3), minlength=len(points))
    assert 0.6 < np.isfinite(potentials).mean() < 1
    for i in range(len(files)):
        for j in range(len(files)):
            if i == j:
                continue
            for name, expected in metrics_of(potentials[i], potentials[j], areas).items():
                assert matrix[name][i, j] == pytest.approx(expected, rel=1e-6, abs=1e-9), (name, i, j)
            both = np.isfinite(potentials[i]) & np.isfinite(potentials[j])
            assert matrix["trusted_source"][i, j] == pytest.approx(areas[both].sum() / areas.sum(), rel=1e-6)


def test_surface(made):
    surface = espdiff.surface(made[0], **QUICK)
    assert len(surface.positions) == len(surface.potential) == len(surface.residue_index)
    a, b, c = (np.asarray(surface.positions)[surface.triangles[:, corner]] for corner in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    assert areas.sum() == pytest.approx(surface.area, rel=1e-5)


def test_plot_and_pyvista(made, tmp_path):
    matplotlib = pytest.importorskip("matplotlib", reason="SKIPPED: no matplotlib")
    matplotlib.use("Agg")
    result = espdiff.compare(*made, **QUICK)
    axes = result.plot(top=8)
    assert axes.get_ylabel() == "Mean absolute difference (kT/e)"
    axes.figure.savefig(tmp_path / "plot.png")
    pyvista = pytest.importorskip("pyvista", reason="SKIPPED: no pyvista")
    mesh = result.to_pyvista()
    assert isinstance(mesh, pyvista.PolyData) and mesh.n_points == len(result.positions)
    assert mesh.area == pytest.approx(result.area.sum(), rel=1e-3)
    before = result.positions.copy(), result.displacement.copy(), result.source_potential.copy()
    mesh.points[:] = 0
    for name in ("displacement", "potential_source"):
        mesh[name][:] = 7
    for kept, values in zip(before, (result.positions, result.displacement, result.source_potential)):
        assert np.array_equal(kept, values, equal_nan=True)  # the mesh has copies
