"""Numbers have a decimal point in whichever locale the program around us has chosen, such as a notebook with windows."""

import json
import os
import pathlib
import subprocess
import sys

import pytest

PROGRAM = """
import locale, sys
if sys.argv[1] == "comma":
    locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
    assert locale.localeconv()["decimal_point"] == ","
sys.path.insert(0, sys.argv[3])
import conftest, espdiff
states = [espdiff.State.from_arrays(**conftest.made_arrays(bend), name=name) for bend, name in ((0.0, "a"), (0.02, "b"))]
result = espdiff.compare(*states, potential="pb", grid_spacing=1.2, threads=1)
result.save(sys.argv[2] + "/out")
print(result)
try:
    espdiff.compare(*states, grid_spacing=-1.5)
except espdiff.Error as error:
    print(error)
"""


def locale_with_comma(folder):
    """The environment in which de_DE.UTF-8 exists, made in `folder` if need be; None where it cannot be made."""
    made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", folder / "de_DE.UTF-8"], capture_output=True)
    return {**os.environ, "LOCPATH": str(folder)} if made.returncode == 0 else None


def test_a_decimal_comma_changes_no_byte(tmp_path):
    environment = locale_with_comma(tmp_path)
    if environment is None:
        pytest.skip("SKIPPED: localedef cannot make a locale (Debian: locales)")
    outputs, files = [], []
    for kind in ("point", "comma"):
        folder = tmp_path / kind
        folder.mkdir()
        run = subprocess.run(
            [sys.executable, "-c", PROGRAM, kind, str(folder), str(pathlib.Path(__file__).parent)],
            env=environment, capture_output=True, text=True, check=False)
        assert run.returncode == 0, run.stderr
        outputs.append(run.stdout)
        files.append({path.name: path.read_bytes() for path in sorted(folder.iterdir())})
    assert outputs[0] == outputs[1]
    assert "-1.5" in outputs[0]
    assert files[0].keys() == files[1].keys() and len(files[0]) >= 3
    for name in files[0]:
        if name.endswith(".json"):
            first, second = (json.loads(each[name]) for each in files)
            assert first.pop("time_ms") and second.pop("time_ms")
            assert first == second
        else:
            assert files[0][name] == files[1][name], name
