"""ensemble() and espdiff.mda.Ensemble: the bytes of the command line, from files, AtomGroups, and in parts."""

import json
import glob
import pathlib
import subprocess

import numpy as np
import pytest

import espdiff

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "data" / "ensembles"
GROUPS = {name: sorted(glob.glob(str(FOLDER / f"trpcage_{name}_?.pdb.gz")))[:3] for name in ("wild", "mutant")}
CHARGES = {name: str(FOLDER / f"trpcage_{name}.pqr") for name in GROUPS}
QUICK = {"potential": "coulomb", "grid_spacing": 1.5, "permutations": 20, "frames": "0:60:99"}
OUTPUTS = (".h5", ".json", ".vtp", ".residues.csv", ".patches.csv", ".patch_series.csv")
pytestmark = pytest.mark.filterwarnings("ignore:.*replicates")


def contents(prefix):
    return {ending: pathlib.Path(f"{prefix}{ending}").read_bytes() for ending in OUTPUTS}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """In one process: the result, and its files."""
    prefix = tmp_path_factory.mktemp("whole") / "out"
    return espdiff.ensemble(GROUPS, charges=CHARGES, output=prefix, patches={"site": "//A/8"}, **QUICK), contents(prefix)


def test_files_are_those_of_the_command_line(whole, program, tmp_path):
    words = [f"--{name.replace('_', '-')}={value}" for name, value in QUICK.items()]
    for name, files in GROUPS.items():
        words += ["--group", name, *files, "--charges", f"{name}={CHARGES[name]}"]
    subprocess.run([program, "ensemble", *words, "--patch", "site=//A/8", "-q", "-o", tmp_path / "out"], check=True)
    assert contents(tmp_path / "out") == whole[1]


def test_arrays_and_tables(whole):
    result, files = whole
    n = len(result.positions)
    assert list(result.means) == ["wild", "mutant"] and result.n_frames == 12
    assert result.difference.shape == result.p_family_wise.shape == (n,)
    tested = result.tested != 0
    assert np.array_equal(np.isfinite(result.difference), tested)
    assert np.allclose(result.difference[tested], (result.means["mutant"] - result.means["wild"])[tested])
    assert ((result.low <= result.difference) & (result.difference <= result.high))[tested].all()
    assert result.potential(0).shape == (n,) and result.potential(0).dtype == np.float32
    with pytest.raises(espdiff.InputError, match="frame: there is no frame 12; there are 12"):
        result.potential(12)
    assert not result.difference.flags.writeable
    table = result.residues
    assert len(table) == 20 and table["residue"][7] == "LYS 8 of chain A" or "8" in table["residue"][7]
    assert list(result.frames["replicate"][:2]) == ["trpcage_wild_1"] * 2
    rows = files[".residues.csv"].decode().splitlines()
    assert len(rows) == 21
    assert result.to_dict()["test"] and len(result.patches) == len(files[".patches.csv"].decode().splitlines()) - 1
    assert "wild" in str(result) and "12 frames" in repr(result)


def test_statistics_of_an_earlier_run(whole, tmp_path):
    (tmp_path / "out.h5").write_bytes(whole[1][".h5"])
    again = espdiff.ensemble(from_file=tmp_path / "out.h5", output=tmp_path / "again", alpha=0.2, permutations=20)
    assert np.array_equal(again.p, whole[0].p, equal_nan=True)
    assert again.to_dict()["options"]["alpha"] == 0.2


def test_fields_are_ensembles_of_their_own(whole, program, tmp_path):
    made = espdiff.ensemble(GROUPS, charges=CHARGES, output=tmp_path / "one", fields=["hydrophobicity"], **QUICK)
    assert list(made.fields) == ["hydrophobicity"] and whole[0].fields == {}
    field = made.fields["hydrophobicity"]
    assert field.to_dict()["field"]["kind"] == "hydrophobicity"
    assert set(field.means) == set(GROUPS) and field.p.shape == made.p.shape
    record = json.loads((tmp_path / "one.hydrophobicity.json").read_text())
    assert record["test"] == field.to_dict()["test"]
    # The scale of Kyte and Doolittle goes from -4.5 to 4.5.
    assert all(np.nanmax(np.abs(mean)) <= 4.5 + 1e-5 for mean in field.means.values())


def test_regression_has_the_bytes_of_the_command_line(whole, program, tmp_path):
    rows = [f"{name},trpcage_{name}_{k},{value}" for name, values in (("wild", (0.2, 1.9, 1.1)), ("mutant", (4.2, 3.1, 5.0)))
            for k, value in enumerate(values, 1)]
    (tmp_path / "values.csv").write_text("\n".join(["group,replicate,activity", *rows]) + "\n")
    (tmp_path / "out.h5").write_bytes(whole[1][".h5"])
    column = f"{tmp_path / 'values.csv'}:activity"
    made = espdiff.ensemble(from_file=tmp_path / "out.h5", output=tmp_path / "one", regress=column, permutations=20)
    assert made.to_dict()["regression"]["replicates"][3]["value"] == 4.2
    subprocess.run([program, "ensemble", "--from", tmp_path / "out.h5", "--regress", column, "--permutations", "20", "-q", "-o",
                    tmp_path / "two"], check=True)
    for ending in (".json", ".vtp", ".regression.csv"):
        assert (tmp_path / f"one{ending}").read_bytes() == (tmp_path / f"two{ending}").read_bytes()
    with pytest.raises(espdiff.FormatError, match="values.csv: there is no column 'other'; there are: group, replicate, activity"):
        espdiff.ensemble(from_file=tmp_path / "out.h5", output=tmp_path / "three", regress=f"{tmp_path / 'values.csv'}:other")


def test_parts_merge_to_the_same_bytes(whole, tmp_path):
    for part in ("1/2", "2/2"):
        assert espdiff.ensemble(GROUPS, charges=CHARGES, output=tmp_path / "out", shard=part, **QUICK) is None
    espdiff.merge(sorted(tmp_path.glob("*.h5")), tmp_path / "out")
    assert (tmp_path / "out.h5").read_bytes() == whole[1][".h5"]


mda = pytest.importorskip("MDAnalysis", reason="SKIPPED: no MDAnalysis")


def atomgroups(names=GROUPS):
    """The replicates as universes, with the charges and radii of the PQR."""
    groups = {}
    for name in names:
        charged = {(atom.resid, atom.name): atom for atom in mda.Universe(CHARGES[name]).atoms}
        groups[name] = []
        for path in GROUPS[name]:
            universe = mda.Universe(path)
            found = [charged[atom.resid, atom.name] for atom in universe.atoms]
            universe.add_TopologyAttr("charges", [atom.charge for atom in found])
            universe.add_TopologyAttr("radii", [atom.radius for atom in found])
            groups[name].append(universe.atoms)
    return groups


def test_atomgroups_have_the_numbers_of_files(whole):
    groups = atomgroups()
    groups["wild"][0].universe.trajectory[5]
    result = espdiff.ensemble(groups, **QUICK)
    assert groups["wild"][0].universe.trajectory.frame == 5  # as it was
    # MDAnalysis rounds coordinates to float32, and trust has limits, which a rounded atom can cross.
    ours, theirs = (np.array([made.potential(frame) for frame in range(12)]) for made in (result, whole[0]))
    trusted = np.isfinite(ours)
    assert (trusted == np.isfinite(theirs)).mean() > 0.9999
    both = trusted & np.isfinite(theirs)
    assert both.mean() > 0.7
    np.testing.assert_allclose(ours[both], theirs[both], rtol=0.01, atol=0.5)
    assert np.abs(ours - theirs)[both].mean() < 0.005  # of values of 50 in vacuum
    same_frames = (trusted == np.isfinite(theirs)).all(axis=0)
    for name in groups:
        assert result.means[name].shape == whole[0].means[name].shape
        ours, theirs = result.means[name][same_frames], whole[0].means[name][same_frames]
        tested = np.isfinite(theirs)
        assert (np.isfinite(ours) == tested).all() and tested.mean() > 0.3
        np.testing.assert_allclose(ours[tested], theirs[tested], rtol=0.01, atol=0.5)
        assert np.abs(ours - theirs)[tested].mean() < 0.005


def test_mda_ensemble_in_processes(whole, request, tmp_path):
    from espdiff.mda import Ensemble

    options = {key: value for key, value in QUICK.items() if key != "frames"}
    one = Ensemble(atomgroups(), output=tmp_path / "one", **options).run(stop=100, step=60)
    assert (one.results.difference == one.results.ensemble.difference)[one.results.tested != 0].all()
    assert one.results.n_frames == 12
    request.getfixturevalue("workers")
    Ensemble(atomgroups(), output=tmp_path / "two", **options).run(stop=100, step=60, backend="multiprocessing", n_workers=2)
    assert contents(tmp_path / "one") == contents(tmp_path / "two")


@pytest.mark.parametrize(
    "groups, options, text",
    [
        (None, {}, "groups: none is given; name one or two"),
        ({"wild": [5]}, {}, r"groups\['wild'\]\[0\]: a int is no replicate; give a path or an AtomGroup"),
        (GROUPS, {"alpha": 0.9}, "alpha.*'0.9' is not a number from 1e-06 to 0.5"),
        (GROUPS, {"control": "no"}, "control.*'no' is not tfce or max-t"),
        (GROUPS, {"shard": "1/2"}, "output: a part of an ensemble, or one to continue, needs files"),
        (GROUPS, {"charges": {"other": CHARGES["wild"]}}, "is not GROUP=FILE with one of the groups, such as wild"),
        (GROUPS, {"grid_spcing": 1}, "grid"),
        ({"wild": GROUPS["wild"][:1] * 2}, {"charges": {"wild": CHARGES["wild"]}}, "two replicates named ensembles/trpcage_wild_1; name them apart"),
    ],
)
def test_what_cannot_be(groups, options, text):
    with pytest.raises(espdiff.InputError, match=text):
        espdiff.ensemble(groups, **{**QUICK, **options})


def test_atomgroups_that_cannot_be():
    groups = atomgroups()
    empty = {"wild": [groups["wild"][0].select_atoms("resid 99")]}
    with pytest.raises(espdiff.InputError, match=r"groups\['wild'\]\[0\]: the AtomGroup is empty"):
        espdiff.ensemble(empty, **QUICK)
    mixed = {"wild": [groups["wild"][0], groups["mutant"][0]]}
    with pytest.raises(espdiff.InputError, match=r"groups\['wild'\]: the AtomGroups are of differing universes, with 299 and 304 atoms"):
        espdiff.ensemble(mixed, **QUICK)
    with pytest.raises(espdiff.InputError, match=r"groups\['wild'\]: files and AtomGroups do not mix"):
        espdiff.ensemble({"wild": [groups["wild"][0], GROUPS["wild"][1]]}, **QUICK)
    bare = {name: [mda.Universe(path).atoms for path in files] for name, files in GROUPS.items()}
    with pytest.raises(espdiff.InputError, match=r"groups\['wild'\]\[0\]: the AtomGroup has no charges; load a topology that has them"):
        espdiff.ensemble(bare, **QUICK)
    charged = espdiff.ensemble(bare, charges=CHARGES, **QUICK)
    assert charged.n_frames == 12


def write_constant_map(path, value):
    """A DX map of one value around the origin, in kT/e."""
    n, spacing = 17, 4.0
    low = -0.5 * spacing * (n - 1)
    path.write_text(
        f"# POTENTIAL (kT/e)\nobject 1 class gridpositions counts {n} {n} {n}\norigin {low} {low} {low}\ndelta {spacing} 0 0\n"
        f"delta 0 {spacing} 0\ndelta 0 0 {spacing}\nobject 2 class gridconnections counts {n} {n} {n}\n"
        f"object 3 class array type double rank 0 items {n**3} data follows\n" + f"{value}\n" * n**3)


def test_maps_of_other_programs(tmp_path):
    names = {"wild": ["trpcage_wild_1", "trpcage_wild_2"], "mutant": ["trpcage_mutant_1", "trpcage_mutant_2"]}
    for group, replicates in names.items():
        for r, replicate in enumerate(replicates):
            for frame in (0, 50):
                write_constant_map(tmp_path / f"{replicate}.{frame}.dx", (3 if group == "mutant" else 1) + 0.1 * r + 0.01 * frame)
    groups = {group: [file for file in GROUPS[group] if any(name in str(file) for name in names[group])] for group in names}
    maps = {group: tmp_path / "{replicate}.%d.dx" for group in names}
    result = espdiff.ensemble(groups, maps=maps, frames="0:50:end", grid_spacing=2, permutations=20)
    tested = result.tested != 0
    assert tested.any() and np.allclose(result.difference[tested], 2, atol=1e-5)
    assert np.allclose(result.means["wild"][tested], 1 + 0.05 + 0.25, atol=1e-5)
    with pytest.raises(espdiff.InputError, match="would have the same maps"):
        espdiff.ensemble(groups, maps={"wild": tmp_path / "trpcage_wild_1.%d.dx"}, frames="0:50:end", grid_spacing=2)
