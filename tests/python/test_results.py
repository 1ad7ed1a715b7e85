"""Results in hand: signatures, wrong calls, load, pickle, tables, HTML, meshes, schemas."""

import filecmp
import importlib.machinery
import importlib.util
import inspect
import json
import pathlib
import pickle
import subprocess

import numpy as np
import pytest

import espdiff
from conftest import QUICK

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
ENSEMBLES = REPOSITORY / "tests" / "data" / "ensembles"
ARRAYS = ("positions", "source_positions", "normals", "source_normals", "triangles", "source_potential", "target_potential",
          "difference", "displacement", "slip", "path_length", "residue_index", "corrupt", "area")


@pytest.fixture(scope="module")
def result():
    made = [str(ENSEMBLES / f"trpcage_{name}.pqr") for name in ("wild", "mutant")]
    return espdiff.compare(*made, region="//A/5-8", patches={"site": "//A/8"}, causes=["region"], grid_spacing=1.2)


def test_signatures_name_every_option():
    options = {row["name"] for row in espdiff.help_options()}
    for function in (espdiff.compare, espdiff.surface, espdiff.potential, espdiff.matrix, espdiff.ensemble, espdiff.Series):
        parameters = inspect.signature(function).parameters
        own = {"potential", "map"} | ({"pme_cell"} if function is espdiff.potential else set())
        assert options <= set(parameters) | own, function
        assert not any(p.kind is p.VAR_KEYWORD for p in parameters.values())
    spacing = inspect.signature(espdiff.compare).parameters["grid_spacing"]
    assert spacing.default == 1 and spacing.annotation is float
    assert "ph" in inspect.signature(espdiff.prepare).parameters
    assert "grid_spacing" not in inspect.signature(espdiff.prepare).parameters
    assert "alpha" in inspect.signature(espdiff.ensemble).parameters


def test_numbers_of_numpy_are_numbers():
    from espdiff._signatures import as_text

    assert [as_text(value) for value in (0.1, np.float64(0.1), np.float32(0.5), np.int64(3), True)] == ["0.1", "0.1", "0.5", "3", "1"]


def test_typed_options_follow_the_table():
    from espdiff import _signatures

    kept = (REPOSITORY / "python" / "espdiff" / "_options.py").read_text()
    assert kept == _signatures.typed_options(), "run `python -m espdiff._signatures` and copy _options.py"


@pytest.mark.parametrize("call, text", [
    (lambda: espdiff.ensemble(["a", "b"]), r"groups: a list has no names; give \{\"wild\""),
    (lambda: espdiff.ensemble({"a": 3}), r"groups\['a'\]: a int is no list of replicates"),
    (lambda: espdiff.ensemble({"a": ["b"]}, alpha="x"), "`alpha`: 'x' is not a number from 1e-06 to 0.5"),
    (lambda: espdiff.ensemble({"a": ["b"]}, resume="yes", output="c"), "resume: 'yes' is not True or False"),
    (lambda: espdiff.compare("a", "b", threads=True), "threads: True is not a whole number from 0 to 1024"),
    (lambda: espdiff.potential("a", pme_cell="own"), "potential: there is no option pme_cell"),
    (lambda: espdiff.compare("a", "b", progress=3), "progress: 3 is neither True nor a function"),
    (lambda: espdiff.compare("a", "b", grid_spcing=1), "compare: there is no option grid_spcing; did you mean grid_spacing?"),
    (lambda: espdiff.compare(3, "b"), "source: a int is no molecule; give a path, an espdiff.State, a Universe or AtomGroup"),
    (lambda: espdiff.matrix("a.pdb"), "states: a str is no list of states"),
    (lambda: espdiff.matrix(["a", "b"], labels="ab"), "labels: a str is no list of texts"),
    (lambda: espdiff.matrix(["a", "b"], labels=[1, 2]), "labels: 1 is not a text"),
    (lambda: espdiff.merge("a.h5", "b"), "parts: a str is no list of paths"),
    (lambda: espdiff.frames("a.psf", 3), "files: a int is not a path"),
    (lambda: espdiff.load(3), "path: a int is not a path"),
    (lambda: espdiff.surface("a", regularize="x"), "regularize: 'x' is not True or False"),
])
def test_a_wrong_call_is_one_error_of_ours(call, text):
    with pytest.raises(espdiff.InputError, match=text):
        call()


def same(a, b):
    assert a.metrics.keys() == b.metrics.keys()
    for name, value in a.metrics.items():
        assert np.isclose(b.metrics[name], value, rtol=1e-6, equal_nan=True), name
    for name in ARRAYS:
        ours, theirs = np.asarray(getattr(a, name)), np.asarray(getattr(b, name))
        assert ours.dtype == theirs.dtype and ours.shape == theirs.shape, name
        assert np.allclose(ours, theirs, equal_nan=True, rtol=1e-6), name
    assert a.to_dict() == b.to_dict()
    assert (a.unit, a.trustworthy, a.has_potential) == (b.unit, b.trustworthy, b.has_potential)
    ours, theirs = a.residue_columns(), b.residue_columns()
    for name, values in ours.items():
        assert list(values) == list(theirs[name]) or np.allclose(values, theirs[name], rtol=1e-5, equal_nan=True), name


def test_load(result, tmp_path):
    files = result.save(tmp_path / "out")
    assert sorted(pathlib.Path(path).name for path in files) == ["out.causes.csv", "out.json", "out.residues.csv", "out.vtp"]
    for name in ("out", "out.json", "out.vtp"):
        same(result, espdiff.load(tmp_path / name))
    again = espdiff.load(tmp_path / "out")
    assert "mean absolute difference" in again.verdict and again.verdict in str(again)
    assert len(again.source) == len(result.source) and again.region["n_residues"] == 4
    with pytest.raises(ValueError):
        again.difference[0] = 1
    assert [filecmp.cmp(path, path.replace("out.", "copy."), shallow=False) for path in files] == [True] * 4 \
        if again.save(tmp_path / "copy") else None


def test_load_refuses_what_is_no_result(result, tmp_path):
    with pytest.raises(espdiff.IoError, match="nothing.json: cannot be read: No such file"):
        espdiff.load(tmp_path / "nothing")
    (tmp_path / "other.json").write_text('{"a": 1}')
    with pytest.raises(espdiff.FormatError, match="other.json: no result of compare, matrix or ensemble"):
        espdiff.load(tmp_path / "other")
    (tmp_path / "broken.json").write_text("{")
    with pytest.raises(espdiff.FormatError, match="broken.json: no JSON"):
        espdiff.load(tmp_path / "broken")
    record = {**result.to_dict(), "format_version": 99}
    (tmp_path / "newer.json").write_text(json.dumps(record))
    with pytest.raises(espdiff.FormatError, match="has format version 99, and this espdiff .* reads 1; use the version that"):
        espdiff.load(tmp_path / "newer")
    result.save(tmp_path / "part")
    (tmp_path / "part.vtp").unlink()
    with pytest.raises(espdiff.IoError, match="part.vtp: cannot be read"):
        espdiff.load(tmp_path / "part")


def test_pickle(result, made, tmp_path):
    copy = pickle.loads(pickle.dumps(result))
    same(result, copy)
    assert str(copy) == str(result)
    first, second = result.save(tmp_path / "first"), copy.save(tmp_path / "second")
    assert all(filecmp.cmp(a, b, shallow=False) for a, b in zip(first, second))
    same(copy, pickle.loads(pickle.dumps(copy)))
    # States that no file holds travel with the result, under the names that they are saved by.
    prepared = espdiff.compare(str(ENSEMBLES / "trpcage_wild.pqr"), str(ENSEMBLES / "trpcage_mutant.pqr"), select="//A/1-15", **QUICK)
    first = prepared.save(tmp_path / "one")
    second = pickle.loads(pickle.dumps(prepared)).save(tmp_path / "two")
    assert len(first) == 5
    for a, b in zip(sorted(first), sorted(second)):
        assert pathlib.Path(a).read_bytes().replace(b"one.", b"two.") == pathlib.Path(b).read_bytes()


def test_tables(result):
    pandas = pytest.importorskip("pandas", reason="SKIPPED: no pandas")
    frame = result.to_frame()
    assert isinstance(frame, pandas.DataFrame) and list(frame["name"])[7] == "LYS"
    matrix = espdiff.matrix([str(ENSEMBLES / f"trpcage_{name}.pqr") for name in ("wild", "mutant")], **QUICK)
    pairs = matrix.to_frame()
    assert list(pairs["source"]) == ["trpcage_wild", "trpcage_mutant"] and "mean_abs_difference" in pairs
    assert matrix.to_frame("mean_abs_difference").shape == (2, 2)
    with pytest.raises(espdiff.InputError, match="metric: there is no 'nonsense'; there are rmsd_A"):
        matrix["nonsense"]


def test_html(result):
    text = result._repr_html_()
    assert "TRUSTWORTHY ON 58 %: mean absolute difference" in text and "Mean absolute difference" in text
    assert text.count("data:image/png;base64,") == 2 and "kT/e: target minus source" in text
    untrusted = pickle.loads(pickle.dumps(result))
    record = untrusted._core.record
    record["certificate"].update(trustworthy=False, verdict="NOT TRUSTWORTHY", reasons=["<b>slipped</b>"])
    untrusted._json = record
    text = untrusted._repr_html_()
    assert "NOT TRUSTWORTHY: mean" in text and "&lt;b&gt;slipped" in text and "<b>slipped" not in text
    assert "TRUSTWORTHY" in result.certificate._repr_html_()


def test_a_picture_is_the_surface_in_its_colours(result):
    from espdiff import _picture

    surface = result._core.surface_arrays()
    red = np.tile([255.0, 0, 0], (len(surface["positions"]), 1))
    drawn = _picture.draw(surface["positions"], surface["points"]["normal"], surface["triangles"], red, 200)
    background = (drawn == 255).all(axis=2)
    assert drawn.shape[1] == 200 and background[0].all() and 0.2 < background.mean() < 0.6
    assert (drawn[~background][:, 1:] == 0).all()  # nothing but red, and no holes
    inside = ~background[drawn.shape[0] // 2 - 3:drawn.shape[0] // 2 + 3, 95:105]
    assert inside.all()
    image = pytest.importorskip("PIL.Image", reason="SKIPPED: no Pillow")
    import io

    assert np.array_equal(np.asarray(image.open(io.BytesIO(_picture.png(drawn)))), drawn)


def test_report(result, tmp_path):
    if "libjs-three" in str(_page_error(result)):
        pytest.skip("SKIPPED: built without libjs-three")
    page = result.report(title="A <title>")
    assert page.startswith("<!") and "A &lt;title&gt;" in page or "A <title>" not in page.split("<script")[0]
    assert result.report(tmp_path / "r.html") == str(tmp_path / "r.html") and (tmp_path / "r.html").stat().st_size > 100000


def _page_error(result):
    try:
        result.report()
    except espdiff.DeviceError as error:
        return error
    return None


def test_a_mesh_has_the_arrays_of_the_file(result, tmp_path):
    pyvista = pytest.importorskip("pyvista", reason="SKIPPED: no pyvista")
    result.save(tmp_path / "out")
    file, mesh = pyvista.read(tmp_path / "out.vtp"), result.to_pyvista()
    assert sorted(mesh.point_data.keys()) == sorted(file.point_data.keys())
    assert sorted(mesh.cell_data.keys()) == sorted(file.cell_data.keys())
    for name in file.point_data.keys():
        assert np.array_equal(mesh.point_data[name], file.point_data[name], equal_nan=True), name
    assert list(mesh.field_data["potential_unit"]) == ["kT/e"]
    loaded = espdiff.load(tmp_path / "out").to_pyvista()
    assert sorted(loaded.point_data.keys()) == sorted(file.point_data.keys())


def schemas():
    loader = importlib.machinery.SourceFileLoader("update_schemas", str(REPOSITORY / "scripts" / "update-schemas"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("update_schemas", loader))
    loader.exec_module(module)
    return module


def test_schemas_follow_the_tables():
    module = schemas()
    for name, text in module.texts().items():
        assert (module.FOLDER / name).read_text() == text, "run scripts/update-schemas"


def test_results_follow_their_schemas(result, tmp_path):
    jsonschema = pytest.importorskip("jsonschema", reason="SKIPPED: no jsonschema")

    def validator(name):
        return jsonschema.Draft202012Validator(json.loads((REPOSITORY / "docs" / "schemas" / f"{name}.schema.json").read_text()))

    validator("comparison").validate(result.to_dict())
    shapes = espdiff.compare(str(ENSEMBLES / "trpcage_wild.pqr"), str(ENSEMBLES / "trpcage_mutant.pqr"), potential="none", **QUICK)
    validator("comparison").validate(shapes.to_dict())
    matrix = espdiff.matrix([str(ENSEMBLES / f"trpcage_{name}.pqr") for name in ("wild", "mutant")], **QUICK)
    validator("matrix").validate(matrix.to_dict())
    groups = {name: [str(ENSEMBLES / f"trpcage_{name}_{i}.pdb.gz") for i in (1, 2)] for name in ("wild", "mutant")}
    charges = {name: str(ENSEMBLES / f"trpcage_{name}.pqr") for name in groups}
    with pytest.warns(UserWarning):
        e = espdiff.ensemble(groups, charges=charges, frames="0:50:99", output=tmp_path / "e", **QUICK)
    validator("ensemble").validate(e.to_dict())
    again = espdiff.load(tmp_path / "e")
    assert np.array_equal(again.difference, e.difference, equal_nan=True) and "<table>" in e._repr_html_()
    for broken in ({"format_version": 2}, {"certificate": None}, {"threads": -1}):
        with pytest.raises(jsonschema.ValidationError):
            validator("comparison").validate({**result.to_dict(), **broken})
    incomplete = result.to_dict().copy()
    del incomplete["inputs"]
    with pytest.raises(jsonschema.ValidationError, match="'inputs' is a required property"):
        validator("comparison").validate(incomplete)


def test_pages_of_a_matrix_and_of_files(result, tmp_path):
    if "libjs-three" in str(_page_error(result)):
        pytest.skip("SKIPPED: built without libjs-three")
    prefix = tmp_path / "pair"
    result.save(prefix)
    page = espdiff.report(prefix, title="From files")
    assert "From files" in page and page == espdiff.report(f"{prefix}.json", title="From files")
    assert espdiff.report(f"{prefix}.vtp", tmp_path / "p.html", range_of=[prefix]) == str(tmp_path / "p.html")
    with pytest.raises(espdiff.InputError, match="result: a Comparison is no path of a result"):
        espdiff.report(result)
    with pytest.raises(espdiff.IoError, match="none.json: cannot be read"):
        espdiff.report(tmp_path / "none")
    with pytest.raises(espdiff.IoError, match="no/p.html"):
        espdiff.report(prefix, tmp_path / "no" / "p.html")
    made = espdiff.matrix(_three_rows(tmp_path), potential="coulomb")
    again = espdiff.load(_saved_matrix(tmp_path))
    for matrix in (made, again):
        page = matrix.report()
        assert "3 states" in page and "m1" in page
    (tmp_path / "m.csv").unlink()
    with pytest.raises(espdiff.InputError, match="the page needs OUT.csv"):
        espdiff.load(tmp_path / "m.json").report()


def _three_rows(folder):
    for k in range(3):
        atoms = [f"ATOM  {i + 1:5d}  CA  ALA A{i + 1:4d}    {3 * i + 0.1 * k:8.3f}{0.7 * (i % 3):8.3f}{0.4 * (i % 2):8.3f} "
                 f"{0.5:7.4f} {2.0:6.4f}\n" for i in range(8)]
        (folder / f"m{k}.pqr").write_text("".join(atoms))
    return [folder / f"m{k}.pqr" for k in range(3)]


def _saved_matrix(folder):
    espdiff.matrix(_three_rows(folder), potential="coulomb", output=folder / "m")
    return folder / "m.json"


def test_page_of_a_trajectory(program, page_record, tmp_path):
    states = _three_rows(tmp_path)
    models = "".join(f"MODEL     {k + 1}\n{state.read_text()}ENDMDL\n" for k, state in enumerate(states))
    (tmp_path / "frames.pqr").write_text(models)
    subprocess.run([program, "trajectory", states[0], tmp_path / "frames.pqr", "-o", tmp_path / "t.csv", "-q", "--potential", "coulomb"],
                   check=True)
    rows = [line for line in (tmp_path / "t.csv").read_text().splitlines() if not line.startswith("#")]
    for given in ("t", "t.csv"):
        record = page_record(tmp_path / given)
        assert record["kind"] == "trajectory" and record["states"].startswith("3 frames, each compared with one structure")
        assert record["labels"] == ["0", "1", "2"] == [row.split(",")[0] for row in rows[1:]]
        assert "mean_abs_difference" in json.dumps(record["metrics"])
    (tmp_path / "t.csv").write_text("frame\n0\n")
    with pytest.raises(espdiff.FormatError, match="t.csv: no column holds a metric of this version of espdiff"):
        espdiff.report(tmp_path / "t.csv")


@pytest.mark.parametrize("prefix", ["/", "", "folder/"])
def test_a_prefix_names_a_file(result, prefix):
    with pytest.raises(espdiff.InputError, match="prefix: .* names no file; give a name, such as"):
        result.save(prefix)


@pytest.mark.parametrize("given, error", [
    ({"charges": [1e30, 0]}, r"charges: atom 0 has 1e\+30 e; between -1e\+06 and 1e\+06 is taken"),
    ({"radii": [1, 5000]}, r"radii: atom 1 has 5000 A; between 0 and 1000 is taken"),
    ({"positions": "abc"}, "positions: a str is no array of numbers; give numpy.asarray"),
    ({"positions": [[0, 0, 0]] * 2}, "positions: a list is no array of numbers; give numpy.asarray"),
    ({"positions": None}, "positions: none are given"),
    ({"names": [1, 2]}, "names: a list is no list of texts, one for each atom"),
    ({"residue_numbers": ["a", "b"]}, "residue_numbers: a list is no list of whole numbers"),
    ({"name": 7}, "name: a int is no text")])
def test_arrays_of_a_state_are_checked(given, error):
    arrays = {"positions": np.zeros((2, 3)) + [[0, 0, 0], [3, 0, 0]], "radii": np.array([2.0, 2]), "charges": np.array([0.5, 0.5])}
    for name, value in given.items():
        arrays[name] = np.asarray(value, float) if name in ("radii", "charges") else value
    with pytest.raises(espdiff.InputError, match=error):
        espdiff.State.from_arrays(arrays.pop("positions"), **arrays)
