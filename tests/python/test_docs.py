"""The lines of docs/python.md run as they stand."""

import gzip
import pathlib
import re
import shutil
import subprocess

import pytest

TEXT = (pathlib.Path(__file__).resolve().parents[2] / "docs" / "python.md").read_text()
BLOCKS = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)


def unpack(name, to):
    """A structure of Debian's theseus-examples, as scripts/demo takes it."""
    listed = subprocess.run(["dpkg", "-L", "theseus-examples"], capture_output=True, text=True, check=False).stdout
    for path in map(pathlib.Path, listed.split()):
        if path.name in (f"{name}_A.pdb", f"{name}_A.pdb.gz"):
            to.write_bytes(gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes())
            return
    pytest.skip("SKIPPED: theseus-examples is not there; scripts/install-packages test")


def test_a_pair(tmp_path, monkeypatch, capsys):
    if not shutil.which("pdb2pqr"):
        pytest.skip("SKIPPED: PDB2PQR is not there; scripts/install-packages runtime")
    (tmp_path / "demo-output").mkdir()
    for name in ("1t24", "1t2e"):
        unpack(name, tmp_path / "demo-output" / f"{name}.pdb")
    monkeypatch.chdir(tmp_path)
    variables = {}
    exec(compile(BLOCKS[0], "docs/python.md", "exec"), variables)
    assert "Mean absolute difference" in capsys.readouterr().out
    assert sorted(path.name for path in tmp_path.glob("ldh*")) == [
        "ldh.json", "ldh.residues.csv", "ldh.source.pqr", "ldh.target.pqr", "ldh.vtp"]
    # The figures that the page and README print.
    assert f"{variables['r'].metrics['mean_abs_difference']:.4f}" == "0.3970"
    assert variables["r"].trustworthy and variables["r"].unit == "kT/e"


def test_many_states(data, tmp_path, monkeypatch):
    models = data / "series19_ubq_2k39"
    for model, name in (("m01.pqr", "a.pqr"), ("m02.pqr", "b.pqr"), ("m03.pqr", "c.pqr"), ("m01.pqr", "reference.pqr")):
        shutil.copy(models / model, tmp_path / name)
    monkeypatch.chdir(tmp_path)
    lines = BLOCKS[1].replace('potential="pb"', 'potential="none", grid_spacing=2').replace(
        'output="abc"', 'output="abc", potential="none", grid_spacing=2').replace("mean_abs_difference", "mean_displacement_A")
    variables = {"frames": ["b.pqr"], "espdiff": __import__("espdiff")}
    exec(compile(lines, "docs/python.md", "exec"), variables)
    assert variables["m"]["mean_displacement_A"].shape == (3, 3)


def test_mdanalysis(data, tmp_path, monkeypatch):
    pytest.importorskip("MDAnalysis", reason="SKIPPED: no MDAnalysis")
    for name in ("adk.psf", "adk_dims.dcd"):
        if not (data / "traj_adk" / name).is_file():
            pytest.skip(f"SKIPPED: {name} is not among the real inputs")
        (tmp_path / name).symlink_to(data / "traj_adk" / name)
    monkeypatch.chdir(tmp_path)
    lines = BLOCKS[2].replace("threads=1)", 'threads=1, potential="none", grid_spacing=2.5)').replace("n_workers=4", "n_workers=2").replace(
        "step=10", "stop=2")
    exec(compile(lines, "docs/python.md", "exec"), {})
