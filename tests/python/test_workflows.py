"""The workflows of docs/examples on this machine's workers: the bytes of one process. matrix_dask.py: test_dask.py."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "docs" / "examples"
OPTIONS = "--potential none --grid-spacing 2.5"
PARTS = 3


@pytest.fixture
def folder(tmp_path, program, data):
    """Variants, their list, the matrix of one process, and an environment with the program on PATH."""
    lines = ["structure"]
    for i in (1, 2, 3):
        (tmp_path / f"m{i}.pqr").symlink_to(data / "series19_ubq_2k39" / f"m0{i}.pqr")
        lines.append(f"m{i}.pqr")
    (tmp_path / "variants.csv").write_text("\n".join(lines) + "\n")
    # Results name their inputs as the list is named.
    for name, written in (("variants.csv", "one"), (tmp_path / "variants.csv", "full")):
        words = [program, "matrix", "--list", name, *OPTIONS.split(), "-q", "-o", tmp_path / written]
        subprocess.run(words, check=True, cwd=tmp_path)
    return tmp_path


@pytest.fixture
def environment(program):
    return {**os.environ, "PATH": f"{pathlib.Path(program).parent}:{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"}


def check_same(prefix, expected):
    for ending in (".csv", ".json"):
        assert pathlib.Path(f"{prefix}{ending}").read_bytes() == pathlib.Path(f"{expected}{ending}").read_bytes()


def test_snakemake(folder, environment):
    if not shutil.which("snakemake", path=environment["PATH"]):
        pytest.skip("SKIPPED: no snakemake; pip install snakemake")
    words = ["snakemake", "-s", EXAMPLES / "Snakefile", "--cores", "2", "--config", "list=variants.csv", "output=many",
             f"parts={PARTS}", f"options={OPTIONS}"]
    run = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stderr
    check_same(folder / "many", folder / "one")
    assert not list(folder.glob("many.shard-*"))


def commands(process):
    """The shell lines of a process in matrix.nf."""
    text = (EXAMPLES / "matrix.nf").read_text()
    body = text.split(f"process {process} {{")[1].split("\n}\n")[0]
    return re.search(r'"""\n(.*?)"""', body, re.DOTALL).group(1)


def test_nextflow(folder, environment):
    if not shutil.which("nextflow", path=environment["PATH"]):
        pytest.skip("SKIPPED: no nextflow, whose program is downloaded from nextflow.io; its commands are run by the next test")
    words = ["nextflow", "run", EXAMPLES / "matrix.nf", "--list", "variants.csv", "--output", "results", "--parts", str(PARTS),
             "--options", OPTIONS]
    run = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, timeout=600)
    assert run.returncode == 0, run.stdout + run.stderr
    check_same(folder / "results" / "matrix", folder / "full")


def test_commands_of_nextflow(folder, environment):
    """What the processes would run, with Nextflow's variables put in by hand, each in a folder of its own."""
    values = {"list": str(folder / "variants.csv"), "params.options": OPTIONS, "task.cpus": "1", "params.parts": str(PARTS)}

    def run(process, where, **more):
        where.mkdir()
        lines = re.sub(r"\$\{([\w.]+)\}", lambda found: {**values, **more}[found.group(1)], commands(process))
        subprocess.run(["bash", "-euc", lines], cwd=where, env=environment, check=True)

    for number in range(1, PARTS + 1):
        run("part", folder / f"work{number}", number=str(number))
    states = " ".join(str(path) for path in sorted(folder.glob("work*/matrix.shard-*.state")))
    run("merge", folder / "merge", states=states)
    check_same(folder / "merge" / "matrix", folder / "full")


def test_syntax_of_nextflow(tmp_path):
    """Nextflow's scripts are Groovy: its compiler reads the file."""
    if not shutil.which("groovyc"):
        pytest.skip("SKIPPED: no groovyc; apt-get install groovy")
    # As Nextflow does, a name before a block is a call: process part { } is process(part({ })).
    shutil.copy(EXAMPLES / "matrix.nf", tmp_path / "matrix.groovy")
    run = subprocess.run(["groovyc", "-d", tmp_path, tmp_path / "matrix.groovy"], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr + run.stdout
    broken = (EXAMPLES / "matrix.nf").read_text().replace("script:\n    \"\"\"", "script:\n    \"\"", 1)
    (tmp_path / "broken.groovy").write_text(broken)
    assert subprocess.run(["groovyc", "-d", tmp_path, tmp_path / "broken.groovy"], capture_output=True).returncode != 0


def test_nextflow_s_words(tmp_path):
    """As RefTrace, a linter of Nextflow's, reads the file: its processes with their directives, and its parameters."""
    reftrace = pytest.importorskip("reftrace", reason="SKIPPED: no reftrace; pip install reftrace")
    module = reftrace.Module.from_file(str(EXAMPLES / "matrix.nf"))
    text = str(module)
    assert [process.name for process in module.processes] == ["part", "merge"]
    assert text.count("workflows {") == 1 and re.search(r'publish_dir {\s+params: "output"\s+mode: "copy"', text)
    assert re.findall(r'params {\s+line: \d+\s+name: "(\w+)"', text) == ["list", "output", "parts", "options"]
    changed = tmp_path / "changed.nf"
    changed.write_text((EXAMPLES / "matrix.nf").read_text().replace("process merge {", "procedure merge {"))
    assert [process.name for process in reftrace.Module.from_file(str(changed)).processes] == ["part"]
