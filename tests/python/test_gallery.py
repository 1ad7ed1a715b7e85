"""The examples of docs/gallery.md run as they stand, print what the page says, and draw its pictures.

ESPDIFF_UPDATE_GALLERY=1 writes outputs and pictures into docs/; look at each picture afterwards."""

import contextlib
import io
import os
import pathlib
import re

import numpy as np
import pytest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
PAGE = REPOSITORY / "docs" / "gallery.md"
PATTERN = r"<!-- example: {} -->\n```python\n(.*?)```\n\n```\n(.*?)```"
NAMES = re.findall(r"<!-- example: (\w+) -->", PAGE.read_text())
NEEDS = {"pair": ["matplotlib", "pandas"], "trajectory": ["matplotlib", "MDAnalysis"], "ensemble": ["matplotlib", "pandas"],
         "matrix": ["matplotlib", "MDAnalysis", "pandas"], "figure": ["pyvista"]}
UPDATE = bool(os.environ.get("ESPDIFF_UPDATE_GALLERY"))
pytestmark = pytest.mark.filterwarnings("ignore")


def pixels(path):
    image = pytest.importorskip("PIL.Image", reason="SKIPPED: no Pillow")
    with image.open(path) as opened:
        return np.asarray(opened.convert("RGB"), dtype=float)


def same_numbers(ours, theirs):
    """The texts, whose numbers may differ in the last of their digits: compilers round differently."""
    number = r"-?\d+\.\d+"
    assert re.sub(number, "#", ours).split() == re.sub(number, "#", theirs).split()
    for a, b in zip(re.findall(number, ours), re.findall(number, theirs)):
        assert float(a) == pytest.approx(float(b), abs=0.011), (ours, theirs)


def test_there_are_five():
    assert NAMES == list(NEEDS)


@pytest.mark.parametrize("name", NAMES)
def test_example(name, tmp_path, monkeypatch):
    for module in NEEDS[name]:
        pytest.importorskip(module, reason=f"SKIPPED: no {module}")
    if "matplotlib" in NEEDS[name]:
        import matplotlib

        matplotlib.use("Agg")
    (tmp_path / "tests").symlink_to(REPOSITORY / "tests")
    monkeypatch.chdir(tmp_path)
    code, expected = re.search(PATTERN.format(name), PAGE.read_text(), re.DOTALL).groups()
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, f"docs/gallery.md, {name}", "exec"), {})
    picture = tmp_path / f"gallery_{name}.png"
    kept = REPOSITORY / "docs" / "images" / picture.name
    if UPDATE:
        kept.write_bytes(picture.read_bytes())
        text = PAGE.read_text()
        at = re.search(PATTERN.format(name), text, re.DOTALL)
        PAGE.write_text(text[:at.start(2)] + printed.getvalue() + text[at.end(2):])
        return
    same_numbers(printed.getvalue(), expected)
    ours, theirs = pixels(picture), pixels(kept)
    # Fonts and versions of the libraries move a few pixels.
    assert abs(ours.shape[0] - theirs.shape[0]) < 20 and abs(ours.shape[1] - theirs.shape[1]) < 20
    height, width = (min(ours.shape[axis], theirs.shape[axis]) for axis in (0, 1))
    assert np.abs(ours[:height, :width] - theirs[:height, :width]).mean() < 25
    assert ours.std() > 20  # it is not empty
