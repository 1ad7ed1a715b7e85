"""What the MDAKits registry asks for: licence, versions, metadata, documentation, and analyses of MDAnalysis' form."""

import inspect
import pathlib
import re

import pytest

import espdiff

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
PYPROJECT = (REPOSITORY / "pyproject.toml").read_text()


def entry(name):
    """A top-level text of metadata.yaml."""
    return re.search(rf'^{name}: "?([^"\n]*)"?$', (REPOSITORY / "python" / "metadata.yaml").read_text(), re.MULTILINE).group(1)


def test_metadata():
    # The registry's required entries (mdakits/template/metadata.yaml there).
    text = (REPOSITORY / "python" / "metadata.yaml").read_text()
    for name in ("project_name authors maintainers description keywords license project_home documentation_home "
                 "documentation_type src_install import_name python_requires mdanalysis_requires run_tests test_dependencies "
                 "project_org").split():
        assert re.search(rf"^{name}:", text, re.MULTILINE), name
    # Tests that are no part of the package are fetched by this line, which the registry replaces.
    assert "run_tests:\n  - git clone latest\n" in text
    assert entry("project_name") == entry("import_name") == re.search(r'^name = "(.*)"', PYPROJECT, re.MULTILINE).group(1)
    assert entry("python_requires") == re.search(r'^requires-python = "(.*)"', PYPROJECT, re.MULTILINE).group(1)
    assert f"MDAnalysis{entry('mdanalysis_requires')}" in PYPROJECT
    assert entry("license") == "BSD-3-Clause"
    assert (REPOSITORY / "LICENSE").read_text().startswith("BSD 3-Clause License")
    assert (REPOSITORY / entry("changelog")).is_file()
    listed = (REPOSITORY / "python" / "metadata.yaml").read_text()
    build = re.search(r'\[build\]="(.*?)"', (REPOSITORY / "scripts" / "install-packages").read_text(), re.DOTALL).group(1)
    without = {"libvtk9-dev", "doctest-dev", "tcl8.6-dev", "tcl8.6"}  # which the Python package does without
    assert set(build.split()) - without <= set(listed.split())


def test_one_version():
    assert espdiff.__version__ == re.search(r'^version = "(.*)"', PYPROJECT, re.MULTILINE).group(1)
    assert re.fullmatch(r"\d+\.\d+\.\d+", espdiff.__version__)
    for name, text in {
        "CMakeLists.txt": "project(espdiff VERSION {} ",
        "CITATION.cff": "\nversion: {}\n",
        "CHANGELOG.md": "\n## [{}] - ",
        "conda/recipe.yaml": 'version: "{}"',
        "debian/changelog": "espdiff ({}-",
        "tests/install/CMakeLists.txt": "find_package(espdiff {} REQUIRED)",
    }.items():
        assert text.format(espdiff.__version__) in (REPOSITORY / name).read_text(), name


def test_pages_cite_as_the_citation_file_does():
    cff = (REPOSITORY / "CITATION.cff").read_text()
    title, author = (re.search(pattern, cff, re.MULTILINE).group(1) for pattern in (r'^title: "(.*)"', r'^  - name: "(.*)"'))
    source = (REPOSITORY / "src" / "base" / "text" / "citation.h").read_text()
    words = "".join(re.findall(r'"([^"\n]*)"', source.split("return")[1]))
    assert words == f"{author}. {title}. Version . Computer software."


def test_every_public_name_is_documented():
    page = (REPOSITORY / "docs" / "python.md").read_text()
    for name in espdiff.__all__:
        public = getattr(espdiff, name)
        if name != "__version__":
            assert inspect.getdoc(public), f"{name} has no docstring"
        if inspect.isfunction(public):
            assert f"{name}(" in page or f"espdiff.{name}" in page, f"docs/python.md does not name {name}"


def test_analyses_have_mdanalysis_form():
    base = pytest.importorskip("MDAnalysis.analysis.base", reason="SKIPPED: no MDAnalysis")
    from espdiff.mda import Ensemble, SurfacePotential

    assert issubclass(SurfacePotential, base.AnalysisBase)
    for analysis in (SurfacePotential, Ensemble):
        assert analysis.get_supported_backends() == ("serial", "multiprocessing", "dask")
        parameters = inspect.signature(analysis.run).parameters
        assert {"start", "stop", "step", "frames", "backend", "n_workers", "verbose"} <= set(parameters)
        assert "results." in inspect.getdoc(analysis)


def test_typed():
    assert (pathlib.Path(espdiff.__file__).parent / "py.typed").is_file()
