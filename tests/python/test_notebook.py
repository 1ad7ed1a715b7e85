"""docs/examples/first_hour.ipynb: its cells run, and show the verdict, a picture and tables."""

import ast
import json
import pathlib

import pytest

pytest.importorskip("pandas", reason="SKIPPED: no pandas")
NOTEBOOK = pathlib.Path(__file__).resolve().parents[2] / "docs" / "examples" / "first_hour.ipynb"


def shown(source, names):
    """Runs a cell; what a notebook shows below it."""
    *lines, last = ast.parse(source).body
    if not isinstance(last, ast.Expr):
        exec(compile(source, str(NOTEBOOK), "exec"), names)
        return ""
    exec(compile(ast.Module(lines, []), str(NOTEBOOK), "exec"), names)
    value = eval(compile(ast.Expression(last.value), str(NOTEBOOK), "eval"), names)
    return value._repr_html_() if hasattr(value, "_repr_html_") else repr(value)


def test_the_notebook_runs(monkeypatch, capsys):
    monkeypatch.chdir(NOTEBOOK.parent)
    cells = ["".join(cell["source"]) for cell in json.loads(NOTEBOOK.read_text())["cells"] if cell["cell_type"] == "code"]
    names = {}
    pair, residues, wrong, again, matrix = (shown(cell, names) for cell in cells)
    assert "TRUSTWORTHY ON 58 %: mean absolute difference 0.595" in pair and "data:image/png" in pair
    assert "LYS" in residues and "1.57" in residues
    assert wrong == "" and "there is no option ofset; did you mean offset?" in capsys.readouterr().out
    assert again.startswith("(True, 'TRUSTWORTHY")
    assert "TRUSTWORTHY: all 2 pairs on 5" in matrix
