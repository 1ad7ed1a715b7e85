"""What cannot be right is one exception that names the argument and the remedy."""

import numpy as np
import pytest

import espdiff
from conftest import QUICK, made_arrays


def state(**changes):
    return espdiff.State.from_arrays(**{**made_arrays(), **changes})


@pytest.mark.parametrize(
    "changes, text",
    [
        ({"positions": np.zeros((0, 3))}, "positions: there are no atoms"),
        ({"positions": np.zeros((120, 2))}, r"positions: the array has the shape \(120, 2\); \(number of atoms, 3\) is needed"),
        ({"positions": np.full((120, 3), np.nan)}, "positions: atom 0 has a coordinate that is not finite"),
        ({"positions": np.zeros((120, 3), dtype=np.complex64)}, "positions: the array has a type that is not read"),
        ({"charges": np.zeros(7)}, r"charges: the array has the shape \(7\); one value for each of the 120 atoms"),
        ({"charges": np.full(120, np.inf)}, "charges: atom 0 has no finite value"),
        ({"radii": np.full(120, -1.0)}, "radii: atom 0 has a negative radius"),
        ({"names": ["CA"]}, "names: there are 1 for 120 atoms"),
        ({"cell": np.array([1.0, 2.0])}, "cell: 2 numbers; three lengths"),
    ],
)
def test_arrays_that_cannot_be(changes, text):
    with pytest.raises(espdiff.InputError, match=text) as caught:
        state(**changes)
    assert isinstance(caught.value, ValueError) and isinstance(caught.value, espdiff.Error)


def test_without_radii_names_and_elements():
    with pytest.raises(espdiff.InputError, match="radii: none are given"):
        espdiff.State.from_arrays(np.zeros((3, 3)))


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_every_order_and_type_is_read(order, dtype):
    positions = np.array(made_arrays()["positions"], dtype=dtype, order=order)
    assert np.allclose(state(positions=positions).positions, positions)
    assert np.allclose(state(positions=np.repeat(positions, 2, axis=0)[::2]).positions, positions)


def test_files(tmp_path):
    with pytest.raises(espdiff.IoError, match="absent.pqr") as caught:
        espdiff.compare(tmp_path / "absent.pqr", tmp_path / "absent.pqr")
    assert isinstance(caught.value, OSError)
    bad = tmp_path / "bad.pqr"
    bad.write_text("ATOM 1 CA ALA 1 0 0 zero 0.5 2.0\n")
    with pytest.raises(espdiff.FormatError, match="bad.pqr"):
        espdiff.State.read(str(bad))


def test_options(made):
    with pytest.raises(espdiff.InputError, match="grid"):
        espdiff.compare(*made, grid_spcing=1)
    with pytest.raises(espdiff.InputError, match="`grid_spacing`: '-1' is not a number from 0.001 to 20"):
        espdiff.compare(*made, grid_spacing=-1)
    for wrong, message in (({"device": "gpu"}, "device.*'gpu' is not auto, cpu, cuda or cuda:N"), ({"device": 3}, "device.*'3' is not"),
                           ({"threads": "two"}, "threads.*'two' is not a whole number from 0 to 1024"),
                           ({"threads": -1}, "threads.*'-1' is not a whole number from 0 to 1024"),
                           ({"potential": "pbe"}, "potential.*'pbe' is not auto, pb, pme, coulomb or none")):
        with pytest.raises(espdiff.InputError, match=message):
            espdiff.compare(*made, **wrong)
    with pytest.raises(espdiff.InputError, match="source: a int is no molecule; give a path"):
        espdiff.compare(5, made[0])


def test_no_charges(made):
    bare = espdiff.State.from_arrays(**{k: v for k, v in made_arrays().items() if k != "charges"})
    for potential in ("auto", "pb"):  # never a result without a difference, unless that is asked for
        with pytest.raises(espdiff.InputError, match="arrays: has no charges, and PDB2PQR cannot prepare it: .*are missing"):
            espdiff.compare(bare, made[1], potential=potential, **QUICK)
    with pytest.raises(espdiff.InputError, match='`potential="none"` compares shapes alone'):
        espdiff.compare(bare, made[1], **QUICK)
    assert not espdiff.compare(bare, made[1], potential="none", **QUICK).has_potential
    with pytest.raises(espdiff.InputError, match="has no charges"):
        espdiff.matrix([bare, made[1]], **QUICK)
    with pytest.raises(espdiff.InputError, match="has no charges"):
        espdiff.Series(bare, **QUICK).step(made[1])


def test_without_pdb2pqr(made, monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.delenv("ESPDIFF_PDB2PQR", raising=False)
    bare = espdiff.State.from_arrays(**{k: v for k, v in made_arrays().items() if k != "charges"})
    with pytest.raises(espdiff.Error, match='arrays has no charges, and PDB2PQR, which assigns some, is not there; .*; `potential="none"`'):
        espdiff.compare(bare, made[1], **QUICK)


def test_names_of_certificate_and_quantities(made):
    result = espdiff.compare(*made, **QUICK)
    with pytest.raises(AttributeError, match="the certificate has no 'nonsense'"):
        result.certificate.nonsense
    pytest.importorskip("matplotlib", reason="SKIPPED: no matplotlib").use("Agg")
    with pytest.raises(espdiff.InputError, match="there is no 'nonsense'"):
        result.plot("nonsense")


def test_outputs_that_are_inputs_are_refused(tmp_path, data):
    copy = tmp_path / "a.vtp"
    copy.write_bytes((data / "series19_ubq_2k39" / "m01.pqr").read_bytes())
    result = espdiff.compare(copy, copy, grid_spacing=2, potential="none")
    with pytest.raises(espdiff.InputError, match="a.vtp"):
        result.save(tmp_path / "a")
