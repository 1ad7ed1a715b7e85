"""Trajectories and topologies as the command line reads them, against MDAnalysis' coordinates and a real VMD's."""

import os
import shutil
import subprocess

import numpy as np
import pytest

import espdiff

mda = pytest.importorskip("MDAnalysis", reason="SKIPPED: no MDAnalysis")
pytestmark = pytest.mark.filterwarnings("ignore")

# Every trajectory among the real inputs, with its topology.
PAIRS = {
    "adk": ("traj_adk/adk.psf", "traj_adk/adk_dims.dcd"),
    "dhfr": ("box_dhfr_jac/JAC.prmtop", "box_dhfr_jac/JAC_from_ncrst.dcd"),
    "tz2": ("box_tz2/tz2.truncoct.parm7", "box_tz2/tz2.truncoct_from_nc.dcd"),
    "2k39": ("nmr/2k39_insty_first.pdb", "nmr/2k39_insty.dcd"),
}
ENDINGS = ["dcd", "xtc", "trr", "nc"]


@pytest.fixture(scope="module")
def plugins(tmp_path_factory):
    empty = tmp_path_factory.mktemp("plugins") / "empty.xtc"
    empty.touch()
    try:
        espdiff.frames("absent.gro", empty)
    except espdiff.DeviceError:
        pytest.skip("SKIPPED: VMD's molfile plugins are absent; put `vmd` on PATH, or set VMDDIR")
    except espdiff.Error:
        pass


@pytest.fixture(params=list(PAIRS))
def pair(request, data):
    files = [data / name for name in PAIRS[request.param]]
    if not all(path.is_file() for path in files):
        pytest.skip(f"SKIPPED: {files[0].name} or {files[1].name} is not among the real inputs")
    return files


def chosen(n):
    """First, second, middle and last, in an order that goes back."""
    return sorted({0, min(1, n - 1), n // 2, n - 1}, reverse=True)


def converted(universe, ending, folder):
    """The frames of chosen() in another format."""
    path = folder / f"frames.{ending}"
    with mda.Writer(str(path), len(universe.atoms)) as writer:
        for frame in sorted(chosen(len(universe.trajectory))):
            universe.trajectory[frame]
            writer.write(universe.atoms)
    return path


def test_pairs_are_all_there_are(data):
    there = {str(path.relative_to(data)) for ending in (*ENDINGS, "ncdf", "mdcrd") for path in data.rglob(f"*.{ending}")}
    assert there <= {trajectory for _, trajectory in PAIRS.values()}


def test_trajectories_have_mdanalysis_coordinates(pair):
    topology, trajectory = map(str, pair)
    universe = mda.Universe(topology, trajectory)
    frames = espdiff.frames(topology, trajectory)
    assert len(frames) == len(universe.trajectory)
    for number in chosen(len(frames)):
        universe.trajectory[number]
        assert np.array_equal(frames[number].positions.astype(np.float32), universe.atoms.positions), number
    with pytest.raises(IndexError, match=f"there is no frame {len(frames)}; there are {len(frames)}"):
        frames[len(frames)]


@pytest.mark.parametrize("ending", ENDINGS)
def test_formats_have_mdanalysis_coordinates(pair, ending, tmp_path, request):
    if ending in ("xtc", "trr"):
        request.getfixturevalue("plugins")
    universe = mda.Universe(*map(str, pair))
    path = converted(universe, ending, tmp_path)
    again = mda.Universe(str(pair[0]), str(path))
    frames = espdiff.frames(pair[0], path)
    assert len(frames) == len(again.trajectory)
    for number in range(len(frames)):
        again.trajectory[number]
        # XTC and TRR are in nm: two libraries may round the product with 10 differently.
        tolerance = 0 if ending in ("dcd", "nc") else 2e-5 * 1.01
        assert np.abs(frames[number].positions - again.atoms.positions).max() <= tolerance


def test_topologies_have_mdanalysis_atoms(pair):
    universe = mda.Universe(*map(str, pair))
    state = espdiff.frames(*pair)[0]
    arrays = state._parts()["arrays"]
    assert [name.strip() for name in arrays["names"]] == list(universe.atoms.names)
    assert arrays["residue_numbers"] == list(universe.atoms.resids)
    if hasattr(universe.atoms, "charges"):
        assert np.allclose(state.charges, universe.atoms.charges, atol=2e-6)
    if universe.dimensions is not None:
        assert np.allclose(arrays["cell"], universe.dimensions, atol=1e-3)


SCRIPT = """
foreach {topology trajectory output} [lrange $argv 0 end] {
    mol new $topology waitfor all
    animate delete all
    mol addfile $trajectory waitfor all
    set channel [open $output wb]
    set all [atomselect top all]
    for {set frame 0} {$frame < [molinfo top get numframes]} {incr frame} {
        $all frame $frame
        foreach position [$all get {x y z}] { puts -nonewline $channel [binary format f* $position] }
    }
    close $channel
    mol delete top
}
quit
"""


@pytest.mark.skipif(not shutil.which(os.environ.get("VMD", "vmd")), reason="SKIPPED: no vmd on PATH, and $VMD is not set")
def test_formats_have_vmd_s_coordinates(plugins, pair, tmp_path):
    """To the bit: `atomselect get {x y z}` of a real VMD that loaded the same files."""
    universe = mda.Universe(*map(str, pair))
    paths = [converted(universe, ending, tmp_path) for ending in ENDINGS]
    (tmp_path / "read.tcl").write_text(SCRIPT)
    words = [str(word) for path in paths for word in (pair[0], path, f"{path}.floats")]
    environment = {name: value for name, value in os.environ.items() if name != "TMPDIR"}
    subprocess.run([os.environ.get("VMD", "vmd"), "-dispdev", "text", "-e", tmp_path / "read.tcl", "-args", *words], check=True,
                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, env=environment, timeout=200)
    for path in paths:
        frames = espdiff.frames(pair[0], path)
        seen = np.fromfile(f"{path}.floats", np.float32).reshape(len(frames), -1, 3)
        for number in range(len(frames)):
            assert np.array_equal(frames[number].positions.astype(np.float32), seen[number]), path
