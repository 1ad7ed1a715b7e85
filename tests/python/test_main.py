"""`python -m espdiff`: the command line in this Python, whose trajectories MDAnalysis reads where VMD is absent."""

import json
import os
import signal
import subprocess
import sys
import time

import pytest

import espdiff
from espdiff.__main__ import main


@pytest.fixture
def run(tmp_path):
    """Runs `python -m espdiff ARGUMENTS`, by default where there is no VMD."""

    def run(*arguments, vmd=False, check=True, **environment):
        env = {**os.environ, **environment}
        if not vmd:
            env.pop("VMDDIR", None)
            env["PATH"] = "/usr/bin:/bin"
        done = subprocess.run([sys.executable, "-m", "espdiff", *map(os.fspath, arguments)], capture_output=True, text=True,
                              env=env, cwd=tmp_path)
        assert not check or done.returncode == 0, done.stderr
        return done

    return run


def test_it_is_the_command_line(run, program, data, tmp_path):
    pair = [data / "series19_ubq_2k39" / f"m0{i}.pqr" for i in (1, 2)]
    arguments = [*pair, "--grid-spacing", "1.5", "--potential", "coulomb", "--overwrite", "--exit-zero"]
    ours = run("compare", *arguments, "-o", tmp_path / "same")
    contents = {}
    for writer in ("python", "program"):
        if writer == "program":
            theirs = subprocess.run([program, "compare", *arguments, "-o", tmp_path / "same"], capture_output=True, text=True,
                                    check=True)
        contents[writer] = [(tmp_path / f"same{ending}").read_bytes() for ending in (".vtp", ".residues.csv", ".json")]
        record = json.loads(contents[writer].pop())
        record.pop("time_ms")
        contents[writer].append(record)
    assert contents["python"] == contents["program"]
    steady = [line for line in ours.stdout.splitlines() if " s" not in line and " ms" not in line]
    assert [line for line in theirs.stdout.splitlines() if line in steady] == steady
    for verb in ("compare", "trajectory", "matrix", "surface", "potential", "prepare", "plot", "merge"):
        their_help = subprocess.run([program, verb, "--help"], capture_output=True, text=True, check=True).stdout
        assert run(verb, "--help").stdout == their_help
    assert run("--version").stdout == f"espdiff {espdiff.__version__}\n"


def test_errors_and_status(run):
    missing = run("compare", "absent.pqr", "absent.pqr", "-o", "x", check=False)
    assert missing.returncode == 2 and missing.stderr.startswith("espdiff: ") and "absent.pqr" in missing.stderr
    assert run("compare", check=False).returncode == 2
    picture = run("render", "x.vtp", "-o", "x.png", check=False)
    assert picture.returncode == 2 and "this build has no renderer" in picture.stderr


def test_it_is_a_function(capfd, tmp_path, interrupts):
    before = signal.getsignal(signal.SIGINT)
    assert main(["--version"]) == 0
    assert capfd.readouterr().out == f"espdiff {espdiff.__version__}\n"
    assert main(["surface", "absent.pqr", "-o", str(tmp_path / "x.vtp")]) == 2
    assert "absent.pqr" in capfd.readouterr().err
    assert signal.getsignal(signal.SIGINT) is before
    with pytest.raises(KeyboardInterrupt):  # Python's own handler is there again
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(1)


def test_doctor_says_what_reads_trajectories(run):
    pytest.importorskip("MDAnalysis", reason="SKIPPED: no MDAnalysis")
    import MDAnalysis

    assert f"by MDAnalysis {MDAnalysis.__version__}; VMD's plugins are not found" in run("doctor").stdout


@pytest.fixture(scope="module")
def adk(data):
    mda = pytest.importorskip("MDAnalysis", reason="SKIPPED: no MDAnalysis")
    return mda.Universe(str(data / "traj_adk" / "adk.psf"), str(data / "traj_adk" / "adk_dims.dcd"))


OPTIONS = ["--potential", "none", "--grid-spacing", "2.5", "--start", "source", "-q", "--overwrite"]


def write_frames(atoms, path, frames):
    import MDAnalysis

    with MDAnalysis.Writer(str(path), len(atoms)) as writer:
        for frame in frames:
            atoms.universe.trajectory[frame]
            writer.write(atoms)


@pytest.mark.parametrize("ending", ["dcd", "trr", "xtc", "nc"])
def test_mdanalysis_gives_the_rows_of_vmd_s_readers(run, program, adk, tmp_path, ending):
    path = tmp_path / f"frames.{ending}"
    write_frames(adk.atoms, path, [0, 3])
    arguments = [adk.filename, path, *OPTIONS, "-o", tmp_path / "rows.csv"]
    run("trajectory", *arguments)
    ours = (tmp_path / "rows.csv").read_text()
    assert len([line for line in ours.splitlines() if not line.startswith("#")]) == 3
    if "by VMD's plugins" not in subprocess.run([program, "doctor"], capture_output=True, text=True, check=True).stdout:
        pytest.skip("SKIPPED: VMD's molfile plugins are absent; put `vmd` on PATH, or set VMDDIR")
    subprocess.run([program, "trajectory", *map(os.fspath, arguments)], check=True)
    assert (tmp_path / "rows.csv").read_text() == ours


def test_what_mdanalysis_refuses(run, adk, data, tmp_path):
    broken = tmp_path / "broken.dcd"
    broken.write_bytes((data / "traj_adk" / "adk_dims.dcd").read_bytes()[:300])
    done = run("trajectory", adk.filename, broken, *OPTIONS, "-o", "rows.csv", check=False)
    assert done.returncode == 2 and "broken.dcd" in done.stderr and "MDAnalysis cannot read it" in done.stderr
    write_frames(adk.select_atoms("resid 1:20"), tmp_path / "part.dcd", [0])
    done = run("trajectory", adk.filename, tmp_path / "part.dcd", *OPTIONS, "-o", "rows.csv", check=False)
    assert done.returncode == 2 and "and the structure has 3341; give the structure or topology" in done.stderr
    done = run("trajectory", adk.filename, tmp_path / "absent.dcd", *OPTIONS, "-o", "rows.csv", check=False)
    assert done.returncode == 2 and "No such file or directory" in done.stderr
    assert not (tmp_path / "rows.csv").exists()


def test_control_c_before_it_begins(capfd, monkeypatch):
    def interrupted():
        raise KeyboardInterrupt

    monkeypatch.setattr("espdiff.__main__._reader", interrupted)
    assert main(["compare", "a.pqr", "b.pqr", "-o", "x"]) == 1
    assert capfd.readouterr().err == "espdiff: cancelled; nothing was written\n"


def test_control_c_ends_it(data, tmp_path):
    pair = [data / "series19_ubq_2k39" / f"m0{i}.pqr" for i in (1, 2)]
    words = [sys.executable, "-c", "import signal, sys; signal.signal(signal.SIGINT, signal.default_int_handler); "
             "from espdiff.__main__ import main; print('begun', flush=True); sys.exit(main(sys.argv[1:]))"]
    process = subprocess.Popen([*words, "compare", *pair, "-o", tmp_path / "x", "--grid-spacing", "0.5", "--pb-spacing", "0.3"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begun\n"
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode != 0 and "cancelled" in errors.lower() and "Traceback" not in errors
    assert not list(tmp_path.glob("x*"))
