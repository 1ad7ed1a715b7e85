"""The lines of docs/python.md run as they stand."""

import pathlib
import re
import shutil

import pytest

TEXT = (pathlib.Path(__file__).resolve().parents[2] / "docs" / "python.md").read_text()
BLOCKS = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)


def test_a_pair(data, tmp_path, monkeypatch, capsys):
    models = data / "series19_ubq_2k39"
    (tmp_path / "demo-output").mkdir()
    for model, name in (("m01.pqr", "1d7h-min.pqr"), ("m02.pqr", "1d7i-min.pqr")):
        shutil.copy(models / model, tmp_path / "demo-output" / name)
    monkeypatch.chdir(tmp_path)
    exec(compile(BLOCKS[0], "docs/python.md", "exec"), {})
    assert "Mean absolute difference" in capsys.readouterr().out
    assert sorted(path.name for path in tmp_path.glob("fkbp*")) == ["fkbp.json", "fkbp.residues.csv", "fkbp.vtp"]


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
