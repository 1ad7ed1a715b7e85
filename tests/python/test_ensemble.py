"""test_ensemble.py: the statistics of `espdiff ensemble` against those of scipy, pymbar and MNE, on the same columns.

The columns are written by the program for real simulations (tests/data/ensembles) and read here by h5py.
"""

import csv
import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

h5py = pytest.importorskip("h5py")
stats = pytest.importorskip("scipy.stats")

DATA = Path(__file__).parents[1] / "data" / "ensembles"
PROGRAM = os.environ.get("ESPDIFF_PROGRAM", "espdiff")


def vtp_arrays(path):
    """Point arrays of a .vtp file with raw appended data, by name."""
    import xml.etree.ElementTree as tree

    content = path.read_bytes()
    start = content.index(b'<AppendedData encoding="raw">')
    data = content[content.index(b"_", start) + 1 :]
    head = tree.fromstring(content[:start].decode() + "</VTKFile>")
    types = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "UInt8": "u1", "Int64": "<i8"}
    arrays = {}
    for array in head.iter("DataArray"):
        at = int(array.get("offset", -1))
        if at < 0 or array.get("type") not in types:
            continue
        size = int(np.frombuffer(data, "<u8", 1, at)[0])
        values = np.frombuffer(data[at + 8 : at + 8 + size], types[array.get("type")])
        n = int(array.get("NumberOfComponents", 1))
        arrays[array.get("Name")] = values.reshape(-1, n) if n > 1 else values
    return arrays


@pytest.fixture(scope="module")
def ensemble(tmp_path_factory):
    """Trp-cage and its mutant K8Q, four replicates of ten frames each, on a coarse grid."""
    folder = tmp_path_factory.mktemp("ensemble")
    command = [PROGRAM, "ensemble", "-o", "out", "-q", "--frames", "0:10:99", "--grid-spacing", "1.6",
               "--potential", "coulomb"]
    for group in ("wild", "mutant"):
        command += ["--group", group, *[str(DATA / f"trpcage_{group}_{k}.pdb.gz") for k in range(1, 5)]]
        command += ["--charges", f"{group}={DATA / f'trpcage_{group}.pqr'}"]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    with h5py.File(folder / "out.h5") as file:
        points = file["VTKHDF/Points"][:]
        polygons = file["VTKHDF/Polygons/Connectivity"][:].reshape(-1, 3)
        n = len(points)
        values = trusted_values(file)
        potential = file["VTKHDF/PointData/potential"][:].reshape(-1, n)
    return {
        "folder": folder,
        "points": points,
        "triangles": polygons,
        "values": values.reshape(8, 10, n),  # [replicate][frame][vertex]; the first four are wild
        "potential": potential,  # [frame][vertex] trusted or not
        "vtp": vtp_arrays(folder / "out.vtp"),
        "json": json.loads((folder / "out.json").read_text()),
    }


def trusted_values(file):
    """[frame][vertex] of an open OUT.h5; NaN where a frame's mapping is not trusted."""
    n = len(file["VTKHDF/Points"])
    values, trusted = (file[f"VTKHDF/PointData/{name}"][:].reshape(-1, n) for name in ("potential", "trusted"))
    return np.where(trusted == 1, values, np.float32(np.nan))


def is_tested(values):
    """[vertex] whether at least 90 % of each group's frames trust it."""
    return np.isfinite(values).reshape(2, -1, values.shape[2]).mean(1).min(0) >= 0.9 - 1e-9


def vertex_areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    sums = np.zeros(len(points))
    for k in range(3):
        np.add.at(sums, triangles[:, k], area / 3)
    return sums


def test_means_t_p_and_intervals_are_those_of_scipy(ensemble):
    means = np.nanmean(ensemble["values"].astype(float), axis=1)
    vtp = ensemble["vtp"]
    tested = np.isfinite(vtp["t"])
    assert 0.3 < tested.mean() < 0.9
    assert np.array_equal(tested, is_tested(ensemble["values"]))
    assert np.allclose(vtp["potential_source"][tested], means[:4].mean(0)[tested], atol=1e-5)
    result = stats.ttest_ind(means[4:, tested], means[:4, tested], equal_var=False)
    assert np.allclose(vtp["t"][tested], result.statistic, rtol=1e-4, atol=1e-4)
    assert np.allclose(vtp["p"][tested], result.pvalue, rtol=1e-3, atol=1e-6)
    interval = result.confidence_interval(0.95)
    assert np.allclose(vtp["difference_low"][tested], interval.low, rtol=1e-3, atol=1e-3)
    assert np.allclose(vtp["difference_high"][tested], interval.high, rtol=1e-3, atol=1e-3)


def test_residues_and_their_false_discovery_rate_are_those_of_scipy(ensemble):
    with open(ensemble["folder"] / "out.residues.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["p"]]
    p = [float(row["p"]) for row in rows]
    adjusted = [float(row["p_false_discovery"]) for row in rows]
    assert np.allclose(adjusted, stats.false_discovery_control(p), rtol=1e-4)
    # One residue from the columns.
    with h5py.File(ensemble["folder"] / "out.h5") as file:
        residue = file["espdiff/residue"][:]
    weights = vertex_areas(ensemble["points"], ensemble["triangles"])
    inside = (residue == 7) & np.isfinite(ensemble["vtp"]["t"])
    means = np.nanmean(ensemble["values"].astype(float), axis=1)[:, inside] @ weights[inside] / weights[inside].sum()
    expected = stats.ttest_ind(means[4:], means[:4], equal_var=False)
    row = next(row for row in rows if row["residue"].split()[1] == "8")
    assert float(row["t"]) == pytest.approx(expected.statistic, rel=1e-4)


def test_statistical_inefficiency_is_that_of_pymbar():
    """On long series both estimate the same; they truncate the autocorrelation differently."""
    timeseries = pytest.importorskip("pymbar.timeseries")
    random = np.random.default_rng(1)
    ours, theirs = [], []
    for _ in range(20):
        noise = random.normal(size=4000)
        x = np.empty(4000)
        x[0] = noise[0]
        for i in range(1, 4000):
            x[i] = 0.8 * x[i - 1] + 0.6 * noise[i]
        ours.append(geyer(x))
        theirs.append(timeseries.statistical_inefficiency(x))
    assert np.mean(ours) == pytest.approx(9, rel=0.1)
    assert np.mean(ours) == pytest.approx(np.mean(theirs), rel=0.1)


def geyer(x):
    """Geyer's initial monotone sequence, as its definition reads."""
    d = x - x.mean()
    n = len(d)
    covariance = [d @ d / n]
    total, before = 0.0, np.inf
    for k in range(0, n - 1, 2):
        for lag in (k, k + 1):
            if lag > 0:
                covariance.append(d[:-lag] @ d[lag:] / n)
        pair = covariance[k] + covariance[k + 1]
        if pair <= 0:
            break
        before = min(before, pair)
        total += before
    return max(1.0, 2 * total / covariance[0] - 1)


@pytest.fixture(scope="module")
def run_of_100(tmp_path_factory):
    """A whole simulation of Trp-cage: values [frame][vertex], and the engine's effective samples [vertex]."""
    folder = tmp_path_factory.mktemp("run")
    subprocess.run([PROGRAM, "ensemble", "--group", "wild", str(DATA / "trpcage_wild_1.pdb.gz"), "--charges",
                    f"wild={DATA / 'trpcage_wild.pqr'}", "--grid-spacing", "1.6", "--potential", "coulomb", "-q", "-o", "out"],
                   cwd=folder, check=True)
    with h5py.File(folder / "out.h5") as file:
        return trusted_values(file).astype(float), vtp_arrays(folder / "out.vtp")


def test_effective_samples_of_a_simulation_are_those_of_pymbar(run_of_100):
    """Column by column. pymbar cuts the autocorrelation off where it first is negative, so single columns scatter."""
    timeseries = pytest.importorskip("pymbar.timeseries")
    values, vtp = run_of_100
    ours = next(vtp[name] for name in vtp if name.startswith("effective_samples"))
    chosen = np.flatnonzero(np.isfinite(values).all(axis=0) & np.isfinite(ours))[::3]
    theirs = np.array([len(values) / timeseries.statistical_inefficiency(values[:, v]) for v in chosen])
    assert len(chosen) > 300
    assert np.median(theirs / ours[chosen]) == pytest.approx(1, rel=0.05)
    assert stats.spearmanr(theirs, ours[chosen]).statistic > 0.95


def test_effective_samples_are_those_of_the_definition(ensemble):
    values, vtp = ensemble["values"].astype(float), ensemble["vtp"]
    complete = np.flatnonzero(np.isfinite(values).all(axis=(0, 1)) & np.isfinite(vtp["t"]))[::50]
    for v in complete:
        expected = sum(10 / geyer(values[r, :, v]) for r in range(4))
        assert vtp["effective_samples_source"][v] == pytest.approx(expected, rel=1e-4)


def test_family_wise_p_are_those_of_mne(ensemble):
    """The largest |t| of every permutation, exactly. MNE's TFCE counts vertices where ours adds their areas, which are
    about equal; the scores must agree up to that."""
    cluster_level = pytest.importorskip("mne.stats.cluster_level")
    sparse = pytest.importorskip("scipy.sparse")
    vtp = ensemble["vtp"]
    tested = np.isfinite(vtp["t"])
    means = np.nanmean(ensemble["values"].astype(float), axis=1)[:, tested]
    n = len(vtp["t"])
    i = np.concatenate([ensemble["triangles"][:, k] for k in (0, 1, 2)])
    j = np.concatenate([ensemble["triangles"][:, k] for k in (1, 2, 0)])
    graph = sparse.coo_matrix((np.ones(len(i)), (i, j)), shape=(n, n)).tocsr()
    graph = ((graph + graph.T) > 0).astype(int)[tested][:, tested]
    areas = vertex_areas(ensemble["points"], ensemble["triangles"])[tested]

    def welch(first, second):
        return stats.ttest_ind(second, first, equal_var=False).statistic

    # Max-t: every permutation, exactly.
    from itertools import combinations

    maxima = [np.abs(welch(means[list(chosen)], means[[r for r in range(8) if r not in chosen]])).max()
              for chosen in combinations(range(8), 4)]
    t = np.abs(welch(means[:4], means[4:]))
    expected = (np.array(maxima)[:, None] >= t[None] * (1 - 1e-7)).mean(0)
    assert np.allclose(vtp["p_max_t"][tested], expected, atol=1e-6)

    # TFCE: MNE's scores on vertices of equal area against ours, whose areas differ little: they must rank alike.
    step = t.max() / 400
    _, scores = cluster_level._find_clusters(welch(means[:4], means[4:]), dict(start=step / 2, step=step), 0,
                                             cluster_level._setup_adjacency(sparse.coo_matrix(graph), len(t), 1))[:2]
    ours = vtp["tfce"][tested]
    assert stats.spearmanr(np.abs(scores), np.abs(ours)).statistic > 0.99
    strong = np.abs(ours) > np.abs(ours).max() / 10
    scale = np.mean(areas[strong]) ** 0.5
    assert np.median(np.abs(scores)[strong] * scale / np.abs(ours)[strong]) == pytest.approx(1, rel=0.1)

    # Its p, of permutations drawn at random, where ours are of all 70: up to the error of 300 draws, 0.03 at most.
    step = t.max() / 60
    drawn = pytest.importorskip("mne.stats").permutation_cluster_test(
        [means[:4], means[4:]], threshold=dict(start=step / 2, step=step), n_permutations=300, tail=0, stat_fun=welch,
        adjacency=sparse.coo_matrix(graph), rng=3, out_type="indices", verbose=False)[2]
    exact = vtp["p_family_wise"][tested]
    assert np.median(np.abs(drawn - exact)) < 0.03
    assert stats.spearmanr(drawn, exact).statistic > 0.95
    assert exact.min() == pytest.approx(2 / 70) and abs(drawn.min() - exact.min()) < 0.03


def test_paraview_layout_has_each_frame(ensemble):
    """vtkHDFReader, where this VTK has one that reads steps of PolyData."""
    vtk = pytest.importorskip("vtk")
    if vtk.vtkVersion().GetVTKMajorVersion() * 100 + vtk.vtkVersion().GetVTKMinorVersion() < 903:
        pytest.skip("VTK is older than 9.3")
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(ensemble["folder"] / "out.h5"))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == 80
    for step in (0, 79):
        reader.SetStep(step)
        reader.Update()
        output = reader.GetOutputDataObject(0)
        got = vtk_to_numpy(output.GetPointData().GetArray("potential"))
        assert np.array_equal(got, ensemble["potential"][step], equal_nan=True)


def test_the_mutant_is_found_at_the_mutant(ensemble):
    patches = ensemble["json"]["patches"]
    assert patches, "no significant patch"
    strongest = max(patches, key=lambda patch: abs(patch["difference"]))
    assert strongest["difference"] < 0  # a positive charge less
    names = [r["residue"] for r in strongest["residues"]]
    assert any(name.split()[1] == "8" for name in names)


def test_regression_is_that_of_scipy(ensemble):
    """Correlations and p of each vertex by scipy; predictions by partial least squares on the vertices themselves."""
    folder = ensemble["folder"]
    values = np.array([0.3, 2.2, 1.1, 4.0, 3.6, 5.9, 2.8, 7.1])
    rows = ["group,replicate,activity"]
    rows += [f"{group},trpcage_{group}_{k},{values[4 * g + k - 1]}"
             for g, group in enumerate(("wild", "mutant")) for k in range(1, 5)]
    (folder / "values.csv").write_text("\n".join(rows) + "\n")
    command = [PROGRAM, "ensemble", "--from", "out.h5", "-o", "regressed", "-q", "--regress", "values.csv:activity",
               "--permutations", "200"]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    vtp = vtp_arrays(folder / "regressed.vtp")
    means = np.nanmean(ensemble["values"].astype(float), axis=1)
    tested = np.flatnonzero(np.isfinite(vtp["regression_t"]))
    assert np.array_equal(tested, np.flatnonzero(is_tested(ensemble["values"])))
    for v in tested[::97]:
        expected = stats.linregress(values, means[:, v])
        assert vtp["regression_correlation"][v] == pytest.approx(expected.rvalue, abs=1e-5)
        assert vtp["regression_slope"][v] == pytest.approx(expected.slope, rel=1e-4, abs=1e-6)
    weights = np.sqrt(vertex_areas(ensemble["points"], ensemble["triangles"])[tested])
    columns = means[:, tested] * weights
    for k, replicate in enumerate(json.loads((folder / "regressed.json").read_text())["regression"]["replicates"]):
        others = np.arange(8) != k
        x, y = columns[others] - columns[others].mean(0), values[others] - values[others].mean()
        direction = x.T @ y
        scores = x @ direction
        predicted = values[others].mean() + (scores @ y) / (scores @ scores) * (
            (columns[k] - columns[others].mean(0)) @ direction)
        assert replicate["predicted"] == pytest.approx(predicted, rel=1e-4)


def test_page(ensemble, page_record):
    """The page of the ensemble: its conclusion, patches, surface and series are those of its files."""
    record, result = page_record(ensemble["folder"] / "out"), ensemble["json"]
    assert record["kind"] == "ensemble" and record["title"] == "mutant against wild"
    assert record["n_vertices"] == len(ensemble["points"])
    assert len(record["patches"]) == len(result["patches"]) > 0
    assert record["verdict"]["text"].startswith("The states, as these simulations sample them, differ on ")
    limit = record["fade"]
    assert limit["name"] == "p_family_wise" and limit["from"] == limit["to"] == 0.05
    assert len(record["series"]["frames"]) == 80
    assert {"potential_source", "potential_target", "potential_difference", "p_family_wise"} <= {q["name"] for q in record["quantities"]}
