"""Fields of arrays: one for all states or one for each, in pairs, matrices, series and other processes."""

import json
import pickle

import numpy as np
import pytest

import espdiff
from conftest import QUICK

SHAPES = {**QUICK, "potential": "none"}


def metric(result, name):
    return result.fields[name]


def test_constants_differ_by_their_difference_and_one_array_serves_both(made):
    n = len(made[0])
    result = espdiff.compare(*made, **SHAPES, fields={
        "both": np.linspace(-1, 1, n), "own": (np.full(n, 2.0), np.full(n, 5.0)), "charge": "charge"})
    assert metric(result, "own")["mean_signed_difference"] == pytest.approx(3, rel=1e-6)
    assert metric(result, "own")["kind"] == "given:own"
    assert metric(result, "both")["correlation"] > 0.9
    assert metric(result, "charge")["unit"] == "e"
    same = espdiff.compare(made[0], made[0], **SHAPES, fields={"both": np.linspace(-1, 1, n)})
    assert metric(same, "both")["mean_abs_difference"] < 1e-5


def test_missing_values_are_left_out_and_counted(made):
    values = np.ones(len(made[0]))
    values[: len(values) // 2] = np.nan
    result = espdiff.compare(*made, **SHAPES, fields={"half": values})
    assert metric(result, "half")["n_vertices_without_value"]["source"] > 0
    assert metric(result, "half")["mean_abs_difference"] == 0


def test_a_matrix_and_a_series_have_the_numbers_of_the_pair(made, tmp_path):
    n = len(made[0])
    arrays = [np.linspace(0, 1, n), np.linspace(0, 2, n)]
    pair = espdiff.compare(*made, **SHAPES, fields={"x": tuple(arrays)})
    matrix = espdiff.matrix(made, ["a", "b"], output=tmp_path / "m", **SHAPES, fields={"x": arrays})
    expected = metric(pair, "x")["rms_difference"]
    assert matrix["x_rms_difference"][0, 1] == expected
    series = espdiff.Series(made[0], **SHAPES, fields={"x": arrays[0]})
    assert metric(series.step(made[1], fields={"x": arrays[1]}), "x")["rms_difference"] == expected
    assert metric(series.step(made[1]), "x")["rms_difference"] < expected
    with pytest.raises(espdiff.InputError, match="the series has no field of arrays 'y'"):
        series.step(made[1], fields={"y": arrays[1]})


def test_other_arrays_are_another_input(made, tmp_path):
    n = len(made[0])
    options = {**SHAPES, "output": tmp_path / "m"}
    espdiff.matrix(made, ["a", "b"], **options, shard="1/2", fields={"x": np.zeros(n)})
    with pytest.raises(espdiff.InputError, match="the array of a has changed"):
        espdiff.matrix(made, ["a", "b"], **options, shard="1/2", resume=True, fields={"x": np.ones(n)})


def test_states_with_values_go_to_other_processes(made):
    state = made[0]._with_values("x", [float(i) for i in range(len(made[0]))])
    again = pickle.loads(pickle.dumps(state))
    expected = espdiff.compare(state, made[1]._with_values("x", [0.0] * len(made[1])), **SHAPES, fields={"x": "given:x"})
    found = espdiff.compare(again, made[1]._with_values("x", [0.0] * len(made[1])), **SHAPES, fields={"x": "given:x"})
    assert metric(found, "x") == metric(expected, "x")


def test_a_file_takes_an_array_of_its_atoms(data):
    path = data / "series19_ubq_2k39" / "m01.pqr"
    n = len(espdiff.state(path))
    result = espdiff.compare(path, data / "series19_ubq_2k39" / "m02.pqr", grid_spacing=2, potential="none",
                             fields={"x": np.arange(n) % 7})
    assert metric(result, "x")["mean_abs_difference"] > 0


def test_wrong_arrays_are_refused_with_the_remedy(made):
    n = len(made[0])
    for values, text in ((np.ones(n - 1), f"there are {n - 1} values for the {n} atoms"),
                         ((np.ones(n),) * 3, "there are 3 arrays for 2 states"),
                         (np.ones((n, 2)), "neither a kind, such as 'hydrophobicity', nor an array"),
                         (np.full(n, np.nan), "has no value in 'x' that is finite")):
        with pytest.raises(espdiff.InputError, match=text):
            espdiff.compare(*made, **SHAPES, fields={"x": values})
    with pytest.raises(espdiff.InputError, match="comes without values"):
        espdiff.compare(*made, **SHAPES, fields=["given:x"])


def test_atomgroups_take_arrays_of_their_length():
    mda = pytest.importorskip("MDAnalysis", reason="SKIPPED: no MDAnalysis")
    from conftest import made_arrays
    universes = []
    for bend in (0.0, 0.02):
        arrays = made_arrays(bend)
        n = len(arrays["positions"])
        made = mda.Universe.empty(n, n_residues=12, atom_resindex=np.arange(n) // 10, trajectory=True)
        for name in ("names", "radii", "charges", "elements"):
            made.add_TopologyAttr(name, arrays[name])
        made.add_TopologyAttr("resnames", ["TYR"] * 12)
        made.add_TopologyAttr("resids", range(1, 13))
        made.load_new(np.array([arrays["positions"]], np.float32))
        universes.append(made.atoms[: n // 2])
    n = len(universes[0])
    result = espdiff.compare(*universes, **SHAPES, fields={"x": (np.zeros(n), np.full(n, 4.0))})
    assert metric(result, "x")["mean_signed_difference"] == pytest.approx(4, rel=1e-6)
    with pytest.raises(espdiff.InputError, match="there are 3 values for the"):
        espdiff.compare(*universes, **SHAPES, fields={"x": np.zeros(3)})


def test_fields_of_a_result_are_those_of_its_file(made, tmp_path):
    result = espdiff.compare(*made, **SHAPES, fields=["charge"])
    assert list(result.fields) == ["charge"]
    result.save(tmp_path / "out")
    assert json.loads((tmp_path / "out.json").read_text())["fields"] == result.fields
    assert result.interface is None
    assert espdiff.compare(*made, **SHAPES).fields == {}
