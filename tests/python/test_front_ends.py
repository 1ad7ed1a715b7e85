"""One table of cases through the command line, Tcl and Python: a study gives the same bytes, whoever asked for it."""

import json
import os
import pathlib
import shutil
import subprocess

import pytest

import espdiff
from conftest import made_arrays

QUICK = {"grid-spacing": "1.5", "threads": "1"}


def words(options, dash):
    return [word for name, value in options.items() for word in (dash + name, value)]


def as_python(options):
    return {name.replace("-", "_"): int(value) if name == "threads" else value for name, value in options.items()}


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
        self.run(f"espdiff trajectory -file {{{frames}}} -reference {{file {source}}} -map {potential} -csv {{{out}}} "
                 + self.options(options))


class Python:
    def compare(self, pair, potential, options, out):
        espdiff.compare(*pair, potential=potential, **as_python(options)).save(out)

    def matrix(self, files, potential, options, out):
        espdiff.matrix(files, potential=potential, output=out, **as_python(options))


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


@pytest.mark.parametrize("potential", ["coulomb", "pb", "none"])
def test_a_trajectory(potential, front_ends, files, tmp_path):
    """Python's Series has no file of its own: its residues are those of the frames."""
    made = {}
    for who in ("command line", "tcl"):
        out = output(tmp_path, who) + ".csv"
        front_ends[who].trajectory(files["a"], files["frames"], potential, QUICK, out)
        made[who] = pathlib.Path(out).read_bytes()
    assert made["tcl"] == made["command line"]
    rows = [line.split(",") for line in made["tcl"].decode().splitlines() if not line.startswith("#")]
    column = rows[0].index("mean_displacement_A")
    series = espdiff.Series(files["a"], potential=potential, **as_python(QUICK))
    for model, row in enumerate(rows[1:], 1):
        step = series.step(espdiff.State.read(files["frames"], model=model))
        assert f"{step.metrics['mean_displacement_A']:.6g}" == f"{float(row[column]):.6g}"


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
