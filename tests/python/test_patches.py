"""Fixed patches and regions: every function measures them, with the numbers that NumPy sums over the surface."""

import numpy as np
import pytest

import espdiff

QUICK = {"potential": "coulomb", "grid_spacing": 1.5, "device": "cpu"}
PATCHES = {"tail": "//A/70-76", "site": "//A/6 //A/8"}


@pytest.fixture(scope="module")
def files(data):
    return [data / "series19_ubq_2k39" / f"m0{i}.pqr" for i in (1, 2, 3)]


def sums(result, numbers):
    """Mean, mean magnitude and area of the difference over residues: a third of each triangle at each corner."""
    triangles, positions = result.triangles.astype(int), result.positions
    a, b, c = (positions[triangles[:, i]] for i in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    number = np.asarray(result.residues["number"])[result.residue_index]
    inside = (np.isin(number, numbers) & (result.residue_index >= 0))[triangles].sum(axis=1) >= 2
    inside &= result.why == 0  # trusted
    weight, value = np.repeat(area[inside] / 3, 3), result.difference[triangles[inside]].ravel().astype(float)
    known = np.isfinite(value)
    return np.average(value[known], weights=weight[known]), np.average(abs(value[known]), weights=weight[known]), area[inside].sum()


def numbers_of(patch):
    return patch["mean_signed_difference"], patch["mean_abs_difference"], patch["area_A2"]["trusted"]


def test_numbers_are_those_of_numpy(files):
    result = espdiff.compare(files[0], files[1], patches=PATCHES, **QUICK)
    assert list(result.fixed_patches) == ["tail", "site"]
    for name, numbers in {"tail": range(70, 77), "site": (6, 8)}.items():
        assert numbers_of(result.fixed_patches[name]) == pytest.approx(sums(result, list(numbers)), rel=2e-4)


def test_series_and_matrix_have_the_same(files):
    pair = espdiff.compare(files[0], files[1], patches=PATCHES, region="//A/1-5", **QUICK)
    step = espdiff.Series(files[0], patches=PATCHES, region="//A/1-5", **QUICK).step(files[1])
    assert step.fixed_patches == pair.fixed_patches and step.region == pair.region
    matrix = espdiff.matrix(files, patches=PATCHES, region="//A/1-5", **QUICK).to_dict()
    assert matrix["metrics"]["tail_mean_abs_difference"]["values"][0][1] == pair.fixed_patches["tail"]["mean_abs_difference"]
    assert matrix["metrics"]["region_mean_abs_difference"]["values"][0][1] == pair.region["mean_abs_difference"]


def test_what_is_no_patch(files):
    with pytest.raises(espdiff.InputError, match="patches: '//A' is not a dict"):
        espdiff.compare(*files[:2], patches="//A", **QUICK)
    with pytest.raises(espdiff.InputError, match="the name 'my site' of 'my site=//A/8' is not a letter followed by"):
        espdiff.compare(*files[:2], patches={"my site": "//A/8"}, **QUICK)
    with pytest.raises(espdiff.InputError, match="patch site: .*selects no atom"):
        espdiff.compare(*files[:2], patches={"site": "//Z"}, **QUICK)
