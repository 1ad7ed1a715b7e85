"""One table of cases through the command line, Tcl and Python: a study gives the same bytes, whoever asked for it."""

import inspect
import json
import os
import pathlib
import re
import shutil
import subprocess

import pytest

import espdiff
from conftest import made_arrays
from espdiff import _signatures

QUICK = {"grid-spacing": "1.5", "threads": "1"}


def words(options, dash):
    return [word for name, value in options.items() for word in (dash + name, value)]


def as_python(options):
    """Named parts and fields as dicts, from their texts."""
    made = {name.replace("-", "_"): int(value) if name == "threads" else value for name, value in options.items()}
    if "patch" in made:
        made["patches"] = dict([made.pop("patch").split("=")])
    if "field" in made:
        made["fields"] = [made.pop("field")]
    return made


class CommandLine:
    def __init__(self, program):
        self.program = program

    def run(self, *arguments):
        done = subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True)
        assert done.returncode in (0, 3), done.stderr

    def compare(self, pair, potential, options, out):
        self.run("compare", *pair, "--potential", potential, *words(options, "--"), "-q", "-o", out)

    def matrix(self, files, potential, options, out):
        self.run("matrix", *files, "--potential", potential, *words(options, "--"), "-q", "-o", out)

    def trajectory(self, source, frames, potential, options, out):
        self.run("trajectory", source, frames, "--potential", potential, *words(options, "--"), "-q", "-o", out)


class Tcl:
    def __init__(self, program):
        self.vmd = pathlib.Path(program).resolve().parents[1] / "vmd"
        if not shutil.which("tclsh") or not (self.vmd / "molfile" / "espdiffplugin.so").exists():
            pytest.skip("SKIPPED: no tclsh, or no module beside ESPDIFF_PROGRAM")

    def run(self, script):
        done = subprocess.run(["tclsh"], input=f"lappend auto_path {{{self.vmd / 'tcl'}}}\npackage require espdiff\n{script}\n",
                              capture_output=True, text=True)
        assert done.returncode == 0 and not done.stderr, done.stderr
        return done.stdout

    def state(self, path, potential):
        return "{file {%s}%s}" % (path, "" if potential == "auto" else f" map {potential}")

    def options(self, options):
        named = {name: value.replace("=", " ") if name == "patch" else value for name, value in options.items()}
        return " ".join("{%s}" % word for word in words(named, "-"))

    def compare(self, pair, potential, options, out):
        states = " ".join(self.state(path, potential) for path in pair)
        self.run(f"espdiff export [espdiff compare {states} {self.options(options)}] {{{out}}}")

    def matrix(self, files, potential, options, out):
        states = " ".join(self.state(path, potential) for path in files)
        self.run(f"espdiff matrix {{{states}}} -output {{{out}}} {self.options(options)}")

    def trajectory(self, source, frames, potential, options, out):
        options = dict(options)
        reference = options.pop("reference", f"{{file {source}}}")
        self.run(f"espdiff trajectory -file {{{frames}}} -reference {reference} -map {potential} -csv {{{out}}} "
                 + self.options(options))


class Python:
    def compare(self, pair, potential, options, out):
        espdiff.compare(*pair, potential=potential, **as_python(options)).save(out)

    def matrix(self, files, potential, options, out):
        espdiff.matrix(files, potential=potential, output=out, **as_python(options))

    def trajectory(self, source, frames, potential, options, out):
        return espdiff.trajectory(source, frames, out, potential=potential, **as_python(options))


@pytest.fixture(scope="module")
def front_ends(program):
    return {"command line": CommandLine(program), "tcl": Tcl(program), "python": Python()}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """a, b and c are one molecule bent more and more; `wide` is b with radii of another force field, `bare` a without
    charges and radii, `frames` all three as models."""
    folder = tmp_path_factory.mktemp("states")
    paths = {}
    for name, bend, scale in (("a", 0.0, 1), ("b", 0.02, 1), ("c", 0.03, 1), ("wide", 0.02, 1.1)):
        arrays = made_arrays(bend)
        arrays["radii"] = arrays["radii"] * scale
        paths[name] = str(folder / f"{name}.pqr")
        espdiff.State.from_arrays(**arrays, name=name).save(paths[name])
        # Water and salt in a cell, for which a continuum stands.
        lines = pathlib.Path(paths[name]).read_text().splitlines()[:-1]
        for i, (x, y) in enumerate((x, y) for x in range(-18, 19, 4) for y in range(-18, 19, 4)):
            atoms = [("NA", "NA", 0, 1.0)] if i % 20 == 0 else [
                ("OW", "HOH", 0, -0.834), ("HW1", "HOH", 0.9, 0.417), ("HW2", "HOH", -0.9, 0.417)]
            lines += [f"ATOM {1000 + 3 * i} {atom} {residue} W {100 + i} {x + d:.3f} {y:.3f} 16.000 {q:.4f} 1.400"
                      for atom, residue, d, q in atoms]
        paths["wet-" + name] = str(folder / f"wet-{name}.pqr")
        cell = "CRYST1   40.000   40.000   40.000  90.00  90.00  90.00 P 1           1\n"
        pathlib.Path(paths["wet-" + name]).write_text(cell + "\n".join(lines) + "\nEND\n")
    text = "".join(f"MODEL {i}\n{pathlib.Path(paths[name]).read_text().replace('END', '')}ENDMDL\n"
                   for i, name in enumerate("abc", 1))
    paths["frames"] = str(folder / "frames.pqr")
    pathlib.Path(paths["frames"]).write_text(text)
    return paths


PAIRS = {
    "charges": ("a b", "auto", {}),
    "vacuum": ("a b", "coulomb", {}),
    "shapes": ("a b", "none", {}),
    "two force fields": ("a wide", "coulomb", {}),
    "element radii": ("a b", "coulomb", {"radii": "element"}),
    "selection": ("a b", "coulomb", {"select": "1-9"}),
    "region and patch": ("a b", "coulomb", {"region": "1-4", "patch": "end=10-12"}),
    "explicit water": ("wet-a wet-b", "auto", {}),
    "pme in water": ("wet-a wet-b", "pme", {}),
    "a field": ("a b", "coulomb", {"field": "hydrophobicity"}),
}


def output(folder, who):
    """The same name for all, because OUT.json names the structures that are kept beside it."""
    (folder / who).mkdir()
    return str(folder / who / "out")


def record(path):
    """OUT.json without what tells of the call: times, the command, and the spelling of options in texts."""
    content = json.loads(pathlib.Path(path).read_text())
    for key in ("time_ms", "command_line"):
        content.pop(key)
    return content


@pytest.mark.parametrize("case", PAIRS)
def test_a_pair(case, front_ends, files, tmp_path):
    names, potential, options = PAIRS[case]
    made = {}
    for who, front_end in front_ends.items():
        out = output(tmp_path, who)
        front_end.compare([files[name] for name in names.split()], potential, {**QUICK, **options}, out)
        made[who] = [pathlib.Path(out + ending).read_bytes() for ending in (".vtp", ".residues.csv")] + [record(out + ".json")]
    for who in ("tcl", "python"):
        for mine, theirs, ending in zip(made[who], made["command line"], ("vtp", "residues.csv", "json")):
            assert mine == theirs, f"{who}: OUT.{ending}"


@pytest.mark.parametrize("names, options", [("a b c", {}), ("a b wide", {}), ("a b", {"region": "1-4"})])
def test_a_matrix(names, options, front_ends, files, tmp_path):
    made = {}
    for who, front_end in front_ends.items():
        out = output(tmp_path, who)
        front_end.matrix([files[name] for name in names.split()], "coulomb", {**QUICK, **options}, out)
        made[who] = pathlib.Path(out + ".csv").read_bytes()
    assert made["tcl"] == made["command line"]
    assert made["python"] == made["command line"]
    assert (b"Bondi's radii" in made["python"]) == ("wide" in names)


TRAJECTORIES = {
    "vacuum": ("a", "coulomb", {}),
    "salt water": ("a", "pb", {}),
    "shapes": ("a", "none", {}),
    "two force fields": ("wide", "coulomb", {"radii": "element"}),
    "region and patch": ("a", "coulomb", {"region": "1-4", "patch": "end=10-12"}),
    "a field": ("a", "coulomb", {"field": "hydrophobicity"}),
    "the frame before": ("a", "coulomb", {"reference": "previous"}),
    "continued mappings": ("a", "coulomb", {"start": "previous", "frames": "1:2"}),
    "by deform": ("a", "none", {"method": "deform"}),
}


def cells_of(content):
    """Of a table's rows, without the head and the checksums that follow from it."""
    return [line.rsplit(",", 1)[0] for line in content.decode().splitlines() if not line.startswith("#")]


@pytest.mark.parametrize("case", TRAJECTORIES)
def test_a_trajectory(case, front_ends, files, tmp_path):
    """Rows and residues; and Python's Series, which has no file: its numbers are those of the rows."""
    name, potential, options = TRAJECTORIES[case]
    made = {}
    for who, front_end in front_ends.items():
        out = output(tmp_path, who)
        front_end.trajectory(files[name], files["frames"], potential, {**QUICK, **options, "residues": out + ".residues.csv"},
                             out + ".csv")
        made[who] = [pathlib.Path(out + ending).read_bytes() for ending in (".csv", ".residues.csv")]
    assert made["python"] == made["command line"]
    if options.get("reference") == "previous":  # in Tcl there is no other molecule, whose file the heads would name
        made = {who: [cells_of(content) for content in contents] for who, contents in made.items()}
    assert made["tcl"] == made["command line"]
    if options.keys() & {"reference", "start"}:
        return
    rows = [line.split(",") for line in made["tcl"][0].decode().splitlines() if not line.startswith("#")]
    series = espdiff.Series(files[name], potential=potential, **as_python({**QUICK, **options}))
    for model, row in enumerate(rows[1:], 1):
        step = series.step(espdiff.State.read(files["frames"], model=model))
        at = rows[0].index("mean_displacement_A")
        assert f"{step.metrics['mean_displacement_A']:.6g}" == f"{float(row[at]):.6g}"


def test_rows_of_a_trajectory_in_python(files, tmp_path):
    out = str(tmp_path / "rows.csv")
    run = espdiff.trajectory(files["a"], [files["frames"]], out, potential="none", frames="0,2", **as_python(QUICK))
    assert {key: run.result[key] for key in ("frames", "rows", "skipped", "resumed")} == {
        "frames": 2, "rows": 2, "skipped": 0, "resumed": 0}
    assert list(run.columns["frame"]) == [0, 2] and run.columns["mean_displacement_A"][1] > 0
    with pytest.raises(espdiff.IoError, match="`resume=True` continues it, `overwrite=True` replaces it"):
        espdiff.trajectory(files["a"], files["frames"], out, potential="none", **as_python(QUICK))
    again = espdiff.trajectory(files["a"], files["frames"], out, potential="none", frames="0,2", resume=True, **as_python(QUICK))
    assert (again.result["rows"], again.result["resumed"]) == (0, 2)
    for wrong, message in (({"reference": "first"}, "reference.*'first' is not source or previous"),
                           ({"start": "sideways"}, "start.*sideways"), ({"frames": "7"}, "frame 7 is not among"),
                           ({"source_model": 0}, "source_model.*'0' is not a whole number of 1 or more"),
                           ({"strat": "source"}, "did you mean start")):
        with pytest.raises(espdiff.InputError, match=message):
            espdiff.trajectory(files["a"], files["frames"], str(tmp_path / "x.csv"), potential="none", **wrong)
    with pytest.raises(espdiff.InputError, match="files: name one trajectory or more"):
        espdiff.trajectory(files["a"], [], str(tmp_path / "x.csv"))
    assert not (tmp_path / "x.csv").exists()


def test_why_shapes_alone_were_compared(front_ends, files, tmp_path, monkeypatch):
    """Python refuses the same states, since NaN for every difference would look like an answer."""
    monkeypatch.setenv("ESPDIFF_PDB2PQR", "/no/such/program")
    bare = tmp_path / "bare.pdb"
    made = made_arrays()
    bare.write_text("".join(
        f"ATOM  {i:5d}  {name:<3s} TYR A{number:4d}    {x:8.3f}{y:8.3f}{z:8.3f}  1.00  0.00           {name[0]}\n"
        for i, (name, number, (x, y, z)) in enumerate(zip(made["names"], made["residue_numbers"], made["positions"]), 1)))
    texts = []
    for who in ("command line", "tcl"):
        out = output(tmp_path, who)
        front_ends[who].compare([files["a"], str(bare)], "auto", QUICK, out)
        texts.append(json.loads(pathlib.Path(out + ".json").read_text())["shapes_because"])
    assert texts[0].replace(f"{tmp_path}/", "") == texts[1]
    assert "no charges" in texts[1] and "PDB2PQR" in texts[1]
    with pytest.raises(espdiff.InputError, match="no charges"):
        espdiff.compare(files["a"], str(bare), **as_python(QUICK))


# Options whose values have another form in each front end: paths, maps, dicts and functions of Python's, lists and commands of
# Tcl's. `regularize` is a switch of one command.
OWN_FORMS = {
    "compare": {"progress"},
    "surface": {"map", "progress", "regularize"},
    "prepare": {"progress"},
    "potential": {"dxfile", "progress", "variance"},
    "matrix": {"groups", "output", "progress"},
    "merge": {"output"},
    "trajectory": {"csv", "progress", "source-frames"},
    "ensemble": {"charges", "maps", "output", "progress"},
}


def options_of(program, tcl, command):
    """The names of a command's options by front end, as the command line has them."""
    help_text = subprocess.run([program, command, "--help-all"], capture_output=True, text=True, check=True).stdout
    lines = re.findall(r"^  (?:-\w, )?(--.*)", help_text, re.M)
    tcl_names = tcl.run(f"foreach option [::espdiff::options_of {command}] {{ puts [dict get $option name] }}").split()
    singular = {many: one for one, many in _signatures.PLURALS.items()}
    singular |= {name: option for option, name in _signatures.STUDY_NAMES.items()}
    parameters = inspect.signature(getattr(espdiff, command)).parameters.values()
    return [{name.removeprefix("no-") for line in lines for name in re.findall(r"--([\w-]+)", line.split("  ")[0])},
            {name[1:] for name in tcl_names},
            {singular.get(p.name, p.name).replace("_", "-") for p in parameters if p.kind is p.KEYWORD_ONLY}]


def test_options_of_several_front_ends_are_rows(front_ends, program):
    """An option that stands in two front ends, and in no table that both are made of, is written by hand twice."""
    rows = {row["name"] for row in espdiff._core.settings()}
    rows |= {row["name"] for study in ("matrix", "trajectory", "ensemble") for row in espdiff._core.study_settings(study)}
    rows |= set(front_ends["tcl"].run("""
        foreach row [::espdiff::core::study_settings potential] { puts [dict get $row name] }
        foreach row [::espdiff::core::potential_settings] { puts [dict get $row map_option] }""").split())
    by_hand = {}
    for command in OWN_FORMS:
        names = [name for front_end in options_of(program, front_ends["tcl"], command) for name in front_end - rows]
        for name in {name for name in names if names.count(name) > 1}:
            by_hand.setdefault(command, set()).add(name)
    assert by_hand == OWN_FORMS
