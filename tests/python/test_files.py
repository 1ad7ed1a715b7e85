"""States in files: read, selected, given charges and cut to regions as the command line does."""

import json
import shutil
import subprocess

import numpy as np
import pytest

import espdiff
from conftest import QUICK

ENDINGS = (".vtp", ".residues.csv")


def content(path):
    """OUT.json without what differs from run to run."""
    values = json.loads(path.read_text())
    for key in ("time_ms", "command_line"):
        values.pop(key)
    for preparation in filter(None, values["preparation"].values()):
        for key in ("from_cache", "seconds"):
            preparation.pop(key)
    return values


def check_same_files(prefix, program, arguments, endings=ENDINGS):
    """PREFIX.* equal what the command line writes."""
    folder = prefix.parent / "cli"
    folder.mkdir()
    subprocess.run([program, "compare", *arguments, "-o", folder / prefix.name, "-q", "--exit-zero"], check=True)
    for ending in endings:
        name = prefix.name + ending
        assert (prefix.parent / name).read_bytes() == (folder / name).read_bytes(), ending
    assert content(prefix.parent / f"{prefix.name}.json") == content(folder / f"{prefix.name}.json")


def test_selections_and_regions(data, tmp_path, program):
    folder = data / "series19_ubq_2k39"
    source, target = folder / "m01.pqr", folder / "m02.pqr"
    chosen = {"potential": "coulomb", "select": "(ARG,LYS,LEU,ILE,VAL)", "region": "(LYS)", "radii": "element", "grid_spacing": 1.5}
    result = espdiff.compare(source, target, **chosen)
    assert set(result.residues["name"]) == {"ARG", "LYS", "LEU", "ILE", "VAL"}
    assert 0 < result.region["area_A2"]["trusted"] < result.metrics["area_A2"]
    written = result.save(tmp_path / "chosen")
    assert [path.rsplit("chosen")[-1] for path in written] == [".json", ".vtp", ".residues.csv", ".source.pqr", ".target.pqr"]
    options = [text for name, value in chosen.items() for text in (f"--{name.replace('_', '-')}", str(value))]
    check_same_files(tmp_path / "chosen", program, [source, target, *options], (*ENDINGS, ".source.pqr", ".target.pqr"))


def test_structures_without_charges_are_prepared(data, tmp_path, program, monkeypatch):
    if not any(shutil.which(name) for name in ("pdb2pqr", "pdb2pqr30")):
        pytest.skip("SKIPPED: PDB2PQR is not there; scripts/install-packages test")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    models = (data / "nmr" / "1l2y.pdb").read_text().split("ENDMDL")
    for name, model in (("a.pdb", 0), ("b.pdb", 3)):
        atoms = [line for line in models[model].splitlines() if line.startswith("ATOM")]
        (tmp_path / name).write_text("\n".join(atoms) + "\nEND\n")
    source, target = tmp_path / "a.pdb", tmp_path / "b.pdb"
    result = espdiff.compare(source, target, potential="pb", ph=4.5, pb_spacing=0.8)
    assert result.has_potential and result.metrics["mean_abs_difference"] > 0.05
    result.save(tmp_path / "prepared")
    check_same_files(
        tmp_path / "prepared", program, [source, target, "--potential", "pb", "--ph", "4.5", "--pb-spacing", "0.8"],
        (*ENDINGS, ".source.pqr", ".target.pqr"))
    shapes = espdiff.compare(source, target, potential="none")
    assert not shapes.has_potential
    # A frame is prepared like its source.
    frame = espdiff.Series(source, potential="pb", ph=4.5, pb_spacing=0.8).step(target)
    assert frame.has_potential


def test_arrays_are_selected_as_files_are(made):
    chosen = espdiff.compare(*made, select="//A/1-8", leave_out="//A/8", **QUICK)
    assert chosen.metrics["area_source_A2"] < espdiff.compare(*made, **QUICK).metrics["area_source_A2"]
    assert len(chosen.residue_columns()["number"]) == 7
    with pytest.raises(espdiff.InputError, match="selects no atom"):
        espdiff.compare(*made, select="//Z", **QUICK)


@pytest.mark.parametrize("option", ["assembly", "topology"])
def test_options_of_files_are_refused_for_arrays(made, option):
    with pytest.raises(espdiff.InputError, match=f"`{option}` is of structures in files, and [ab] is a state of arrays"):
        espdiff.compare(*made, **{option: "1"}, **QUICK)


def test_arrays_have_regions(made):
    result = espdiff.compare(*made, region="//A/3-5", **QUICK)
    assert 0 < result.region["area_A2"]["trusted"] < result.metrics["area_A2"]
    with pytest.raises(espdiff.InputError, match="region"):
        espdiff.compare(*made, region="//Z", **QUICK)


def test_charges_of_another_state(data):
    folder = data / "series19_ubq_2k39"
    first = espdiff.State.read(folder / "m01.pqr")
    bare = espdiff.State.from_arrays(**{**_labels_of(folder / "m02.pqr")})
    whole = espdiff.compare(first, folder / "m02.pqr", potential="coulomb", grid_spacing=1.5)
    taken = espdiff.compare(first, bare, potential="coulomb", grid_spacing=1.5, charges_from=folder / "m01.pqr")
    assert np.array_equal(whole.difference, taken.difference, equal_nan=True)


def _labels_of(path):
    """The atoms of a PQR file as arrays, without charges."""
    rows = [line.split() for line in path.read_text().splitlines() if line.startswith("ATOM")]
    has_chain = len(rows[0]) == 11
    at = 6 if has_chain else 5
    return {
        "positions": np.array([[float(x) for x in row[at:at + 3]] for row in rows]),
        "radii": np.array([float(row[at + 4]) for row in rows]),
        "names": [row[2] for row in rows],
        "residue_names": [row[3] for row in rows],
        "chains": [row[4] if has_chain else "" for row in rows],
        "residue_numbers": [int(row[at - 1]) for row in rows],
    }
