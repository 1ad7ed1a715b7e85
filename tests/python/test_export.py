"""The files of `espdiff export`, read by other programs' libraries."""

import json
import os
import pathlib
import shutil
import subprocess

import numpy as np
import pytest

PROGRAM = os.environ.get("ESPDIFF_PROGRAM", "espdiff")
ROW = "ATOM  %5d  CA  ALA A%4d    %8.3f%8.3f%8.3f %7.4f %6.4f\n"


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A comparison of two rows of atoms, and the means of its residues."""
    if shutil.which(PROGRAM) is None:
        pytest.skip("SKIPPED: no program espdiff; set ESPDIFF_PROGRAM")
    folder = tmp_path_factory.mktemp("export")
    for name, shift in (("a", 0), ("b", 0.4)):
        atoms = [ROW % (i + 1, i + 1, shift + 3 * i, 0.7 * (i % 3), 0.4 * (i % 2), 0.5, 2) for i in range(8)]
        (folder / f"{name}.pqr").write_text("".join(atoms))
    prefix = folder / "pair"
    subprocess.run([PROGRAM, folder / "a.pqr", folder / "b.pqr", "--potential", "coulomb", "-q", "-o", prefix], check=True)
    return prefix


def exported(result, form):
    answer = subprocess.run([PROGRAM, "export", result, "--to", form, "--overwrite"], check=True, capture_output=True, text=True)
    return pathlib.Path(answer.stdout.splitlines()[0].removeprefix("wrote "))


def n_vertices(result):
    return json.loads(result.with_suffix(".json").read_text())["n_vertices"]


def test_trimesh_reads_glb_with_colours(result):
    trimesh = pytest.importorskip("trimesh", reason="SKIPPED: no trimesh")
    scene = trimesh.load(exported(result, "glb"))
    mesh = next(iter(scene.geometry.values()))
    assert len(mesh.vertices) == n_vertices(result)
    assert np.ptp(mesh.vertices[:, 0]) > 20
    differences = np.ravel(mesh.vertex_attributes["_POTENTIAL_DIFFERENCE"])
    assert np.isfinite(differences).all() and np.ptp(differences) > 0


def test_pygltflib_validates_glb(result):
    pygltflib = pytest.importorskip("pygltflib", reason="SKIPPED: no pygltflib")
    gltf = pygltflib.GLTF2().load(str(exported(result, "glb")))
    attributes = gltf.meshes[0].primitives[0].attributes
    assert gltf.accessors[attributes.POSITION].count == n_vertices(result)
    assert gltf.accessors[attributes.COLOR_0].normalized
    sizes = {5123: 2, 5125: 4, 5126: 4}
    shapes = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
    for accessor in gltf.accessors:
        view = gltf.bufferViews[accessor.bufferView]
        assert view.byteLength == accessor.count * sizes[accessor.componentType] * shapes[accessor.type]
        assert view.byteOffset + view.byteLength <= gltf.buffers[0].byteLength


def test_trimesh_and_meshio_read_ply(result):
    trimesh = pytest.importorskip("trimesh", reason="SKIPPED: no trimesh")
    path = exported(result, "ply")
    mesh = trimesh.load(path, process=False)
    assert len(mesh.vertices) == n_vertices(result)
    vertices = mesh.metadata["_ply_raw"]["vertex"]["data"]
    assert np.ravel(vertices["potential_difference"]).shape == (n_vertices(result),)
    assert mesh.visual.vertex_colors.shape == (n_vertices(result), 4)
    meshio = pytest.importorskip("meshio", reason="SKIPPED: no meshio")
    again = meshio.read(path)
    assert np.allclose(again.points, mesh.vertices)
    assert "potential_target" in again.point_data


def test_gemmi_reads_mmcif_and_pdb(result):
    gemmi = pytest.importorskip("gemmi", reason="SKIPPED: no gemmi")
    path = exported(result, "cif")
    table = gemmi.cif.read(str(path)).sole_block().find("_espdiff_residue.", ["residue_number", "mean_abs_difference"])
    values = {int(number): float(value) for number, value in table}
    assert len(values) == 8
    for file in (path, exported(result, "pdb")):
        residues = list(gemmi.read_structure(str(file))[0]["A"])
        assert [residue.name for residue in residues] == ["ALA"] * 8
        for residue in residues:
            assert residue[0].b_iso == pytest.approx(values[residue.seqid.num], abs=0.006)


def test_molviewspec_accepts_the_scene(result):
    mvs = pytest.importorskip("molviewspec", reason="SKIPPED: no molviewspec")
    text = exported(result, "mvsj").read_text()
    scene = mvs.nodes.State.model_validate_json(text)
    kinds, found = [scene.root], []
    while kinds:
        node = kinds.pop()
        found.append(node.kind)
        kinds += node.children or []
        # A name that the format does not know would be dropped or refused.
        known = {"component": "ComponentInlineParams", "color": "ColorInlineParams", "tooltip": "TooltipInlineParams",
                 "representation": "RepresentationParams", "download": "DownloadParams", "parse": "ParseParams",
                 "structure": "StructureParams", "primitives": "PrimitivesParams"}.get(node.kind)
        if known and known != "RepresentationParams":
            given = dict(node.params)
            model = getattr(mvs.nodes, known)
            assert set(given) <= set(model.model_fields), (node.kind, set(given))
            model.model_validate(given)
    assert found.count("tooltip") == 8 and "primitive" in found
    mesh = json.loads(text)["root"]["children"][1]["children"][0]["params"]
    mvs.nodes.MeshParams.model_validate({**mesh, "group_colors": {int(k): v for k, v in mesh["group_colors"].items()}})


def test_python_scripts_compile_and_read_their_mesh(result):
    for form in ("pymol", "blender"):
        path = exported(result, form)
        code = path.read_text()
        compile(code, str(path), "exec")
        reader = code[code.index("def read_ply") :].split("\n\n\n")[0]
        space = {"struct": __import__("struct")}
        exec(reader, space)
        columns, faces, counted = space["read_ply"](result.with_suffix(".ply"))
        assert len(columns["x"]) == n_vertices(result)
        assert max(max(face) for face in faces) < len(columns["x"])
        assert len(counted) == len(faces) and counted == sorted(counted, reverse=True)


def test_pymol_runs_its_script(result):
    python = shutil.which("python3", path="/usr/bin")  # Debian's package is a module of its Python
    if python is None or subprocess.run([python, "-c", "import pymol"], capture_output=True).returncode != 0:
        pytest.skip("SKIPPED: no PyMOL")
    path = exported(result, "pymol")
    check = result.parent / "check.py"
    check.write_text("from pymol import cmd\nprint('SEEN', sorted(cmd.get_names()), cmd.count_atoms('residues'))\n")
    answer = subprocess.run([python, "-m", "pymol", "-cq", path, check], capture_output=True, text=True, timeout=300)
    assert "SEEN ['difference', 'residues', 'scale'] 8" in answer.stdout.replace("'not_counted', ", ""), answer.stdout
