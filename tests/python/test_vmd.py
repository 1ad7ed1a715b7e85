"""espdiff.vmd over a real tclsh with the Tcl package: the same numbers, and Python's values both ways.

tests/vmd/python.tcl runs it in a VMD that has Python."""

import csv
import glob
import os
import pathlib
import shutil
import subprocess

import numpy as np
import pytest

import espdiff
import espdiff.vmd as in_vmd
from conftest import DATA
from espdiff._tcl import Interpreter, split_dict, split_list, word

SERVER = r"""
fconfigure stdin -translation binary; fconfigure stdout -translation binary
while {[gets stdin n] >= 0} {
    set script [encoding convertfrom utf-8 [read stdin $n]]
    set status [catch {uplevel #0 $script} answer]
    set bytes [encoding convertto utf-8 $answer]
    puts stdout "$status [string length $bytes]"; puts -nonewline stdout $bytes; flush stdout
}
"""


class Tclsh:
    """VMD's `evaltcl`, by a tclsh on the other end of a pipe."""

    def __init__(self, folder):
        script = folder / "server.tcl"
        script.write_text(SERVER)
        self.process = subprocess.Popen(["tclsh", script], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def __call__(self, text):
        content = text.encode()
        self.process.stdin.write(b"%d\n%s" % (len(content), content))
        self.process.stdin.flush()
        status, length = map(int, self.process.stdout.readline().split())
        answer = self.process.stdout.read(length).decode()
        if status != 0:
            raise ValueError(answer)
        return answer

    def close(self):
        self.process.stdin.close()
        self.process.wait(timeout=60)


@pytest.fixture(scope="module")
def evaltcl(tmp_path_factory):
    if not shutil.which("tclsh"):
        pytest.skip("SKIPPED: no tclsh; scripts/install-packages build")
    server = Tclsh(tmp_path_factory.mktemp("tclsh"))
    yield server
    server.close()


@pytest.fixture(scope="module")
def package(evaltcl):
    """espdiff.vmd with the package of this build."""
    program = os.environ.get("ESPDIFF_PROGRAM", "")
    folder = pathlib.Path(program).resolve().parents[1] / "vmd"
    if not program or not glob.glob(str(folder / "molfile" / "espdiffplugin.so")):
        pytest.skip("SKIPPED: the module for VMD is not built beside ESPDIFF_PROGRAM")
    evaltcl("set env(ESPDIFF_PDB2PQR) /no/such/program")
    in_vmd.load(folder, evaltcl)
    return in_vmd


@pytest.fixture
def pair(data):
    return [data / "series19_ubq_2k39" / f"m0{i}.pqr" for i in (1, 2)]


WORDS = ["", "plain", "two words", "{", "}", "a{b}c", '"quoted"', "$x [y] \\z", "line\nbreak\ttab", ";#", "é→", "\\", "-3"]


def test_words_go_through_tcl_unchanged(evaltcl):
    tcl = Interpreter(evaltcl)
    for text in WORDS:
        assert tcl.call("return", "-level", 0, text) == text
    assert split_list(tcl.call("list", *WORDS)) == WORDS
    assert split_list(tcl.call("return", "-level", 0, WORDS)) == WORDS
    nested = {"a b": ["x", ["y z", ""]], "flag": True, "number": 0.1}
    found = split_dict(tcl.call("dict", "merge", nested))
    assert split_list(split_list(found["a b"])[1]) == ["y z", ""]
    assert found["flag"] == "1" and float(found["number"]) == 0.1
    with pytest.raises(espdiff.InputError, match="no zero characters"):
        word("a\0b")
    with pytest.raises(espdiff.Error, match="mine"):
        tcl.eval("error mine")
    with pytest.raises(espdiff.GeometryError, match="flat"):
        tcl.eval("error flat {} {ESPDIFF GEOMETRY}")


def test_a_comparison_is_the_engine_s(package, pair, tmp_path):
    made = package.compare(
        {"file": pair[0], "map": "coulomb"}, {"file": pair[1], "map": "coulomb"}, grid_spacing=1.5)
    alone = espdiff.compare(*pair, potential="coulomb", grid_spacing=1.5)
    for name in ("positions", "source_positions", "normals", "triangles", "difference", "source_potential",
                 "target_potential", "displacement", "slip", "path_length", "residue_index", "corrupt"):
        ours, theirs = getattr(made, name), getattr(alone, name)
        assert ours.dtype == theirs.dtype and np.array_equal(ours, theirs, equal_nan=ours.dtype.kind == "f"), name
        assert not ours.flags.writeable
    for name in ("mean_abs_difference", "area_A2", "rmsd_A"):
        assert made.metrics.get(name, made.result.get(name)) is not None
    assert made.metrics["mean_abs_difference"] == alone.metrics["mean_abs_difference"]
    assert made.certificate["trustworthy"] is alone.trustworthy
    rows = made.residues
    assert [row["number"] for row in rows] == list(alone.residues["number"])
    assert np.array_equal([row["mean_abs_difference"] for row in rows], alone.residues["mean_abs_difference"], equal_nan=True)
    assert "Mean absolute difference" in str(made)
    written = made.save(tmp_path / "tcl files")
    alone.save(tmp_path / "python")
    assert (tmp_path / "tcl files.vtp").read_bytes() == (tmp_path / "python.vtp").read_bytes()
    assert written[0] == str(tmp_path / "tcl files.json")
    made.delete()
    assert "deleted" in repr(made)


def test_surfaces_and_matrices(package, pair, tmp_path):
    surface = package.surface(pair[0], grid_spacing=1.5)
    alone = espdiff.surface(pair[0], grid_spacing=1.5, potential="none")
    assert np.array_equal(surface.positions, alone.positions)
    assert surface.result["area_A2"] == alone.area
    states = [{"file": path, "map": "none", "label": name} for path, name in zip(pair, "ab")]
    matrix = package.matrix(states, tmp_path / "m", grid_spacing=2)
    assert matrix.labels == ["a", "b"]
    same = espdiff.matrix(pair, ["a", "b"], potential="none", grid_spacing=2)
    assert np.array_equal(matrix["mean_displacement_A"], same["mean_displacement_A"], equal_nan=True)


@pytest.mark.filterwarnings("ignore:.*replicates")
def test_ensembles(package, tmp_path):
    from test_groups import CHARGES, GROUPS, OUTPUTS, QUICK

    chosen = {name: value for name, value in QUICK.items() if name != "potential"}
    made = package.ensemble(GROUPS, tmp_path / "tcl", charges=CHARGES, map="coulomb", **chosen)
    alone = espdiff.ensemble(GROUPS, charges=CHARGES, output=tmp_path / "python", **QUICK)
    for ending in OUTPUTS:
        assert (tmp_path / f"tcl{ending}").read_bytes() == (tmp_path / f"python{ending}").read_bytes(), ending
    for name in ("positions", "triangles", "difference", "p_family_wise"):
        assert np.array_equal(getattr(made, name), getattr(alone, name), equal_nan=True), name
    assert len(made.patches) == len(alone.patches) and "template" in str(made)


def test_trajectories(package, data, tmp_path):
    frames = data / "nmr" / "1l2y.pdb"
    run = package.trajectory(file=frames, csv=tmp_path / "rows.csv", frames="0:2", map="none", grid_spacing=2, reference=0)
    assert run.result["rows"] == 3 and run.result["skipped"] == 0
    assert list(run.columns["frame"]) == [0, 1, 2]
    with open(tmp_path / "rows.csv") as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    assert [float(row["mean_displacement_A"]) for row in rows] == list(run.columns["mean_displacement_A"])
    assert run.columns["start"] == ["source"] * 3
    with pytest.raises(espdiff.InputError, match="csv: name the file"):
        package.trajectory(file=frames)


def test_progress_and_cancelling(package, pair):
    told = []
    package.compare(*pair, grid_spacing=1, progress=lambda stage, fraction: told.append((stage, fraction)))
    assert told and all(0 <= fraction <= 1 for _, fraction in told)

    def interrupt(stage, fraction):
        raise KeyboardInterrupt

    before = package.call("handles")
    with pytest.raises(KeyboardInterrupt):
        package.compare(*pair, grid_spacing=0.5, progress=interrupt)
    assert package.call("handles") == before


def test_what_cannot_be(package, pair):
    with pytest.raises(espdiff.InputError, match="source: a float is no molecule; give the id of a molecule in VMD"):
        package.compare(0.5, pair[1])
    with pytest.raises(espdiff.InputError, match="grid"):
        package.compare(*pair, grid_spcing=1)
    with pytest.raises(espdiff.InputError, match="`grid_spacing`: '-1' is not a number from 0.001 to 20"):
        package.compare(*pair, grid_spacing=-1)
    with pytest.raises(espdiff.IoError, match="absent.pqr"):
        package.compare("absent.pqr", pair[1])
    made = package.compare(*pair, grid_spacing=2)
    with pytest.raises(espdiff.InputError, match="draw.* needs VMD|VMD"):
        made.draw()
    with pytest.raises(AttributeError):
        made.nonsense
    assert "cpu" in package.doctor()


def test_without_vmd():
    with pytest.raises(espdiff.InputError, match="works in the Python inside VMD and with vmd-python"):
        in_vmd.load()


def interpreters():
    """Pythons without our extension, of any version that VMD may have."""
    found = glob.glob(os.path.expanduser("~/.pyenv/versions/3.*/bin/python3")) + [shutil.which("python3", path="/usr/bin")]
    return sorted(path for path in found if path)


@pytest.mark.parametrize("python", interpreters())
def test_it_needs_no_extension(python, package, tmp_path):
    """The module is imported and used by a Python that has neither the extension nor, mostly, NumPy."""
    version = subprocess.run([python, "-c", "import sys; print(*sys.version_info[:2])"], capture_output=True, text=True)
    if tuple(map(int, version.stdout.split())) < (3, 7):
        pytest.skip("SKIPPED: VMD's scripts need Python 3.7 or newer for this")
    folder = pathlib.Path(os.environ["ESPDIFF_PROGRAM"]).resolve().parents[1] / "vmd"
    script = tmp_path / "script.py"
    script.write_text("""
import sys
sys.path[:0] = sys.argv[1:3]
from test_vmd_server import Tclsh
import pathlib, espdiff, espdiff.vmd as e
tcl = Tclsh(pathlib.Path(sys.argv[4]))
tcl("set env(ESPDIFF_PDB2PQR) /no/such/program")
print(e.load(None, tcl))
r = e.surface(sys.argv[3], grid_spacing=3)
print(len(r.positions), r.positions[0][0] if "numpy" in sys.modules else r.positions[0, 0], r.result["n_vertices"])
try:
    espdiff.compare
except ImportError as error:
    print(error)
tcl.close()
""")
    text = pathlib.Path(__file__).read_text()
    server = "import subprocess\n\nSERVER" + text.split("SERVER", 1)[1].split("@pytest.fixture", 1)[0]
    (tmp_path / "test_vmd_server.py").write_text(server)
    pqr = DATA / "ubq" / "ubq.pqr"
    if not pqr.is_file():
        pytest.skip("SKIPPED: real inputs are absent; set ESPDIFF_DATA to their folder")
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    run = subprocess.run([python, script, folder / "python", tmp_path, pqr, tmp_path], capture_output=True, text=True,
                         env=environment)
    assert run.returncode == 0, run.stderr
    lines = run.stdout.splitlines()
    assert lines[0] == espdiff.__version__
    count, _, same = lines[1].split()
    assert count == same and int(count) > 100
    assert "espdiff.compare needs the engine's extension, which this Python does not have" in lines[2]
