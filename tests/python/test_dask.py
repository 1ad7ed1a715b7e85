"""Matrices, trajectories and ensembles on Dask's workers: the same bytes with 1, 2 and 4 of them."""

import importlib.util
import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

import espdiff
from conftest import QUICK, made_arrays
from test_groups import CHARGES, GROUPS, OUTPUTS
from test_groups import QUICK as QUICK_GROUPS

distributed = pytest.importorskip("distributed", reason="SKIPPED: no dask.distributed")

import espdiff.dask  # noqa: E402

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
pytestmark = pytest.mark.filterwarnings("ignore:.*replicates")


@pytest.fixture(scope="module")
def cluster():
    with distributed.LocalCluster(n_workers=0, threads_per_worker=1, processes=True, dashboard_address=None) as made:
        yield made


@pytest.fixture(params=[1, 2, 4])
def client(request, cluster):
    cluster.scale(request.param)
    with distributed.Client(cluster) as made:
        made.wait_for_workers(request.param)
        while len(made.scheduler_info(n_workers=-1)["workers"]) > request.param:
            pass
        yield made


@pytest.fixture(scope="module")
def one_process(tmp_path_factory):
    """Matrix and ensemble in this process, as bytes."""
    folder = tmp_path_factory.mktemp("whole")
    espdiff.matrix(states(), ["a", "b", "c"], output=folder / "matrix", **QUICK)
    espdiff.matrix(states(), ["a", "b", "c"], template="medoid", exact_sample=1, output=folder / "through", **QUICK)
    espdiff.ensemble(GROUPS, charges=CHARGES, output=folder / "groups", **QUICK_GROUPS)
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def states():
    return [espdiff.State.from_arrays(**made_arrays(bend), name=name) for bend, name in ((0.0, "a"), (0.02, "b"), (-0.02, "c"))]


def test_matrix(client, one_process, tmp_path):
    made = espdiff.dask.matrix(client, states(), ["a", "b", "c"], output=tmp_path / "matrix", **QUICK)
    assert made["mean_abs_difference"].shape == (3, 3)
    for ending in (".csv", ".json"):
        assert (tmp_path / f"matrix{ending}").read_bytes() == one_process[f"matrix{ending}"]
    assert not list(tmp_path.glob("*.state"))
    with pytest.raises(espdiff.InputError, match="output: .*matrix.csv or .*exists; set overwrite=True"):
        espdiff.dask.matrix(client, states(), ["a", "b", "c"], output=tmp_path / "matrix", **QUICK)


def test_matrix_through_a_template(client, one_process, tmp_path):
    made = espdiff.dask.matrix(client, states(), ["a", "b", "c"], template="medoid", exact_sample=1,
                               output=tmp_path / "through", **QUICK)
    assert len(made.template["exact"]["pairs"]) == 1
    for ending in (".csv", ".json", ".h5"):
        assert (tmp_path / f"through{ending}").read_bytes() == one_process[f"through{ending}"], ending
    assert sorted(path.name for path in tmp_path.iterdir()) == ["through.csv", "through.h5", "through.json"]


def test_ensemble(client, one_process, tmp_path):
    espdiff.dask.ensemble(client, GROUPS, charges=CHARGES, output=tmp_path / "groups", **QUICK_GROUPS)
    for ending in OUTPUTS:
        assert (tmp_path / f"groups{ending}").read_bytes() == one_process[f"groups{ending}"], ending


def test_trajectory(client, data):
    mda = pytest.importorskip("MDAnalysis", reason="SKIPPED: no MDAnalysis")
    from espdiff.mda import SurfacePotential

    if not hasattr(SurfacePotential, "parallelizable"):
        pytest.skip("SKIPPED: MDAnalysis before 2.8 has no workers")

    universe = mda.Universe(str(data / "traj_adk" / "adk.psf"), str(data / "traj_adk" / "adk_dims.dcd"))
    atoms = universe.select_atoms("resid 1:60")
    options = {"potential": "coulomb", "grid_spacing": 2.5, "threads": 1, "residues": True}
    one = SurfacePotential(atoms, **options).run(stop=4).results
    many = SurfacePotential(atoms, **options).run(stop=4, backend=espdiff.dask.Backend(client), unsupported_backend=True).results
    for name, values in one.metrics.items():
        assert values.tobytes() == many.metrics[name].tobytes(), name
    for name, values in one.residue_values.items():
        assert values.tobytes() == many.residue_values[name].tobytes(), name
    assert one.residue_labels == many.residue_labels and one.reasons == many.reasons and one.unit == many.unit == "kT/e in vacuum"


def test_what_cannot_be(tmp_path):
    with pytest.raises(espdiff.InputError, match="client: a int is no dask.distributed.Client"):
        espdiff.dask.matrix(5, states(), output=tmp_path / "m")


SBATCH = """#!/usr/bin/env bash
# A queue of this machine: starts the job at once.
set -e
echo "$(date +%s) $*" >>"$QUEUE/submitted"
cp "${!#}" "$QUEUE/job-$$.sh"
setsid bash "$QUEUE/job-$$.sh" >"$QUEUE/job-$$.log" 2>&1 </dev/null &
echo $! >"$QUEUE/$!.pid"
echo "Submitted batch job $!"
"""

SCANCEL = """#!/usr/bin/env bash
for job; do kill -- "-$job" 2>/dev/null || true; done
"""


def test_slurm_example(data, tmp_path):
    """docs/examples/matrix_dask.py with a queue that runs its jobs here, in the place of Slurm's."""
    pytest.importorskip("dask_jobqueue", reason="SKIPPED: no dask-jobqueue")
    queue = tmp_path / "queue"
    queue.mkdir()
    for name, text in (("sbatch", SBATCH), ("scancel", SCANCEL)):
        (queue / name).write_text(text)
        (queue / name).chmod(0o755)
    files = []
    for i in (1, 2, 3):
        files.append(tmp_path / f"m{i}.pqr")
        files[-1].symlink_to(data / "series19_ubq_2k39" / f"m0{i}.pqr")
    options = {"potential": "none", "grid_spacing": 2.5}
    espdiff.matrix([str(path) for path in files], output=tmp_path / "one", **options)
    environment = {**os.environ, "PATH": f"{queue}:{os.environ['PATH']}", "QUEUE": str(queue)}
    words = [f"--{name.replace('_', '-')}={value}" for name, value in options.items()]
    run = subprocess.run(
        [sys.executable, REPOSITORY / "docs" / "examples" / "matrix_dask.py", "--slurm", "--workers", "2", "--cores", "1",
         "--memory", "1GB", "-o", tmp_path / "many", *files, *words], capture_output=True, text=True, env=environment, cwd=tmp_path,
        timeout=240)
    assert run.returncode == 0, run.stderr + "".join(path.read_text() for path in queue.glob("*.log"))
    assert len((queue / "submitted").read_text().splitlines()) == 2
    assert any("#SBATCH" in path.read_text() and "--cpus-per-task=1" in path.read_text() for path in queue.glob("job-*.sh"))
    for ending in (".csv", ".json"):
        assert (tmp_path / f"many{ending}").read_bytes() == (tmp_path / f"one{ending}").read_bytes()


def example():
    loader = importlib.util.spec_from_file_location("matrix_dask", REPOSITORY / "docs" / "examples" / "matrix_dask.py")
    module = importlib.util.module_from_spec(loader)
    loader.loader.exec_module(module)
    return module


def test_the_example_takes_each_option_of_the_command_line(program):
    """Or names it as one that it does not take: the two tables of options are compared."""
    printed = subprocess.run([program, "matrix", "--help-all"], capture_output=True, text=True, check=True).stdout
    rows = re.findall(r"^  (?:-\w, )?(--[a-z-]+)( \S+)?", printed.split("Options:")[1], re.MULTILINE)
    own = {"--help", "--help-all", "--output", "--resume"}  # of the example itself
    module = example()
    assert set(module.NOT_TAKEN) <= {option for option, _ in rows}
    assert len(rows) > 60
    for option, value in rows:
        if option not in own | set(module.NOT_TAKEN):
            words = [option] + (["a=charge" if option in ("--field", "--patch") else "1"] if value.strip() else [])
            assert len(module.settings(words)) == 1, option
    assert module.settings("--field hydrophobicity --field e=field-strength --on-error skip".split()) == {
        "fields": ["hydrophobicity", "e=field-strength"], "skip_errors": True}
    with pytest.raises(SystemExit, match="--list is an option of `espdiff matrix` alone"):
        module.settings(["--list", "a.csv"])


def test_options_of_the_example(monkeypatch):
    """Switches, values and repeated options reach the matrix; others end it."""
    module = example()
    words = "--cavities --potential pb --no-project --grid-spacing=1.5 --patch site=//A/8-12 --patch other=//A/3 --threads 2".split()
    assert module.settings(words) == {"cavities": True, "potential": "pb", "project": False, "grid_spacing": "1.5",
                                      "patches": {"site": "//A/8-12", "other": "//A/3"}, "threads": "2"}
    for words, text in ((["--nonsense", "1"], "--nonsense: espdiff matrix has no such option"), (["pb"], "pb: espdiff matrix"),
                        (["--potential"], "--potential needs a value")):
        with pytest.raises(SystemExit, match=text):
            module.settings(words)
