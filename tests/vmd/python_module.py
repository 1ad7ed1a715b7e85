"""python_module.py: what tests/vmd/python.tcl runs in VMD's Python."""

import os
import sys
import traceback

sys.path.insert(0, os.path.join(os.environ["VMDPLUGINPATH"], "python"))

import numpy  # noqa: E402
from vmd import atomsel, evaltcl, molecule  # noqa: E402
from espdiff import vmd as esp  # noqa: E402

DATA, SCRATCH = os.environ["ESPDIFF_DATA"], os.environ["SCRATCH"]
tests = []


def test(function):
    tests.append(function)
    return function


def load(name, kind="pqr"):
    return molecule.load(kind, os.path.join(DATA, name))


@test
def the_lines_of_the_documentation_run():
    mols = [load("series19_ubq_2k39/m0%d.pqr" % i) for i in (1, 2)]
    assert mols == [0, 1]
    text = open(os.path.join(os.environ["ESPDIFF_TESTS"], "..", "..", "docs", "python.md")).read()
    lines = text.split("## Inside VMD")[1].split("```python\n")[1].split("```")[0]
    os.chdir(SCRATCH)
    found = {}
    exec(lines.replace("grid_spacing=0.8", "grid_spacing=1.5").replace('csv="out.csv"', 'csv="out.csv", map="none"')
         .replace("mean_abs_difference\"]\n", "mean_displacement_A\"]\n"), found)
    assert len(found["run"].columns["frame"]) == 1 and len(found["r"].residues) == 76
    esp.undraw()
    evaltcl("espdiff delete all")


@test
def a_comparison_of_molecules_has_the_numbers_of_tcl():
    mols = [load("series19_ubq_2k39/m0%d.pqr" % i) for i in (1, 2)]
    r = esp.compare({"mol": mols[0], "map": "coulomb"}, {"mol": mols[1], "map": "coulomb"}, grid_spacing=1.5)
    handle = evaltcl("espdiff compare {mol %d map coulomb} {mol %d map coulomb} -grid-spacing 1.5" % tuple(mols))
    assert r.metrics["mean_abs_difference"] == float(evaltcl("espdiff result %s mean_abs_difference" % handle))
    assert r.metrics["mean_abs_difference"] > 0.1
    assert r.difference.dtype == numpy.float32 and len(r.difference) == len(r.positions)
    assert len(r.residues) == 76 and r.residues[0]["name"] == "MET"
    assert isinstance(r.certificate["trustworthy"], bool)
    selected = atomsel("resid 1 to 40", molid=mols[0])
    part = esp.compare(selected, selected, grid_spacing=2)
    assert len(part.residues) == 40
    evaltcl("espdiff delete all")


@test
def drawings_and_maps():
    mol = load("ubq/ubq.pqr")
    r = esp.compare(mol, mol, grid_spacing=2)
    drawn = r.draw(color="displacement", range=(0, 1))
    assert drawn and all(number in molecule.listall() for number in drawn)
    r.undraw()
    assert not any(number in molecule.listall() for number in drawn)
    volume = r.map(mol=mol, quantity="displacement", spacing=2.0)
    assert volume == 0, volume
    about = r.color_atoms(quantity="mean_displacement_A")
    assert 900 < about["atoms"] <= 1231 and about["max"] < 0.1, about
    values = atomsel("name CA", molid=mol).get("user")
    assert abs(max(values) - about["max"]) < 0.1
    assert r.highlight([3, 5])
    r.highlight([])
    files = r.save(os.path.join(SCRATCH, "from python"))
    assert all(os.path.exists(name) for name in files)
    r.delete()


@test
def a_trajectory_of_a_molecule():
    mol = molecule.load("psf", os.path.join(DATA, "traj_adk/adk.psf"))
    molecule.read(mol, "dcd", os.path.join(DATA, "traj_adk/adk_dims.dcd"), end=2, waitfor=-1)
    told = []
    run = esp.trajectory(mol=mol, sel="protein", map="none", csv=os.path.join(SCRATCH, "rows.csv"), grid_spacing=2.5,
                         progress=lambda stage, fraction: told.append(fraction))
    assert list(run.columns["frame"]) == [0, 1, 2], run.columns["frame"]
    assert run.columns["mean_displacement_A"][0] < 0.1 < run.columns["rmsd_A"][2]
    assert told
    molecule.delete(mol)


@test
def errors_are_exceptions():
    for call, words in ((lambda: esp.compare(99, 99), "99"), (lambda: esp.compare("absent.pqr", "absent.pqr"), "absent.pqr")):
        try:
            call()
        except esp.InputError as error:
            assert words in str(error), error
        except OSError as error:
            assert words in str(error), error
        else:
            raise AssertionError("it was not refused")


with open(os.environ["ESPDIFF_PYTHON_RESULT"], "w") as result:
    for each in tests:
        name = each.__name__.replace("_", " ")
        try:
            each()
        except BaseException:
            result.write("FAILED python: %s: %s\n" % (name, traceback.format_exc().replace("\n", " | ")))
        else:
            result.write("ok python: %s\n" % name)
