"""Results: the engine's arrays and numbers, with what plots and tables need."""

from __future__ import annotations

import json
import os
import tempfile
import typing

import numpy as np

from . import _checks
from ._core import InputError, report_page
from ._reports import page_of_files, written


class Certificate:
    """Whether a correspondence can be trusted: `trustworthy`, `reasons`, and every check by its name in OUT.json."""

    def __init__(self, values):
        self._values = values

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self._values[name]
        except KeyError:
            raise AttributeError(f"the certificate has no {name!r}; it has {', '.join(self._values)}") from None

    def __dir__(self):
        return [*super().__dir__(), *self._values]

    def to_dict(self) -> dict:
        return dict(self._values)

    def __repr__(self):
        return "; ".join([f"<espdiff.Certificate {verdict_of(self._values)}", *self.reasons]) + ">"

    def _repr_html_(self):
        from ._html import certificate

        return certificate(self)


def verdict_of(certificate):
    """The verdict's words, of the record where it has them."""
    return certificate.get("verdict") or ("TRUSTWORTHY" if certificate["trustworthy"] else "NOT TRUSTWORTHY")


def table_of(columns):
    """A pandas.DataFrame where pandas is installed, otherwise the dict of columns."""
    try:
        import pandas
    except ImportError:
        return columns
    return pandas.DataFrame(columns)


def frame_of(columns, /, **arguments):
    """A pandas.DataFrame, or an error that says how to get pandas."""
    try:
        import pandas
    except ImportError:
        raise InputError("to_frame: pandas is not installed; `pip install pandas`, or take the columns") from None
    return pandas.DataFrame(columns, **arguments)


class EngineResult:
    """A result that the engine holds: its attributes are the engine's, and the arrays are views of its memory."""

    def __init__(self, core):
        self._core = core
        self._json = None

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self._core, name)

    def __dir__(self):
        return sorted({*super().__dir__(), *(n for n in dir(self._core) if not n.startswith("_"))})

    def __str__(self):
        return self._core.table()

    def to_dict(self) -> dict:
        """The content of OUT.json."""
        if self._json is None:
            self._json = json.loads(self._core.json())
        return self._json


def _array(name, shape, help_text):
    """A property that is an array of the engine's."""

    def get(self) -> np.ndarray:
        return getattr(self._core, name)

    get.__name__ = name
    get.__doc__ = f"{shape}: {help_text}"
    return property(get)


class Comparison(EngineResult):
    """The result of compare(), or one that load() read. Arrays are NumPy's and read-only."""

    positions: np.ndarray = _array("positions", "(vertices, 3) float64, A", "the source's surface mapped onto the target, "
                                   "in the target's frame")
    source_positions: np.ndarray = _array("source_positions", "(vertices, 3) float64, A", "where each vertex lies on the "
                                          "source, in the source's frame")
    normals: np.ndarray = _array("normals", "(vertices, 3) float32", "outward, of the target")
    source_normals: np.ndarray = _array("source_normals", "(vertices, 3) float32", "outward, of the source")
    triangles: np.ndarray = _array("triangles", "(triangles, 3) uint32", "vertices, counter-clockwise seen from outside")
    source_potential: np.ndarray = _array("source_potential", "(vertices) float32", "empty where shapes alone are compared")
    target_potential: np.ndarray = _array("target_potential", "(vertices) float32", "empty where shapes alone are compared")
    difference: np.ndarray = _array("difference", "(vertices) float32", "target minus source")
    displacement: np.ndarray = _array("displacement", "(vertices) float32, A", "NaN where unmatched")
    slip: np.ndarray = _array("slip", "(vertices) float32, A", "NaN where unmatched or without partner; empty if no atoms pair")
    path_length: np.ndarray = _array("path_length", "(vertices) float32, A", "NaN where unmatched")
    residue_index: np.ndarray = _array("residue_index", "(vertices) int32", "row of `residues`; -1 for none")
    corrupt: np.ndarray = _array("corrupt", "(triangles) uint8", "not 0 where the mapping cannot be trusted")
    unmatched: np.ndarray = _array("unmatched", "(triangles) uint8", "not 0 where it is unmatched; empty where all are matched")
    area: np.ndarray = _array("area", "(vertices) float64, A^2", "a third of a vertex's triangles, without unmatched and corrupt ones")

    def __init__(self, core):
        super().__init__(core)
        self._residues = None

    def __repr__(self):
        metrics = self.metrics
        verdict = verdict_of(self.to_dict()["certificate"])
        verdict = {"TRUSTWORTHY": "trustworthy", "NOT TRUSTWORTHY": "NOT trustworthy"}.get(verdict, verdict)
        if self.has_potential:
            return f"<espdiff.Comparison mean |difference| {metrics['mean_abs_difference']:.3g} {self.unit}, {verdict}>"
        return f"<espdiff.Comparison of shapes, {verdict}>"

    def _repr_html_(self):
        from ._html import comparison

        return comparison(self)

    def __reduce__(self):
        from ._saved import Saved, rebuilt

        saved = self._core if isinstance(self._core, Saved) else Saved.of(self._core)
        return rebuilt, (saved.files, saved.text)

    @property
    def metrics(self) -> typing.Dict[str, float]:
        """Every number of the comparison by name; NaN where there is none."""
        return self._core.metrics

    @property
    def unit(self) -> str:
        """Of potentials; of those that see neither water nor a dielectric, kT/e in vacuum."""
        return self._core.unit

    @property
    def has_potential(self) -> bool:
        """False where shapes alone were compared."""
        return self._core.has_potential

    @property
    def trustworthy(self) -> bool:
        """The certificate's verdict; `certificate.reasons` tells why not."""
        return self._core.trustworthy

    @property
    def verdict(self) -> str:
        """The verdict and the main number in one line, as the command line prints it."""
        return self._core.verdict

    @property
    def certificate(self) -> Certificate:
        """Every check of the correspondence, and the verdict."""
        return Certificate(self.to_dict()["certificate"])

    @property
    def warnings(self) -> typing.List[str]:
        """What the inputs leave in doubt."""
        return [warning["text"] for warning in self.to_dict()["warnings"]]

    @property
    def region(self) -> typing.Optional[dict]:
        """The numbers, certificate and residues of the region, a dict under the names of OUT.json; None without one."""
        return self.to_dict()["region"]

    @property
    def fixed_patches(self) -> dict:
        """The same of each patch that `patches=` named, by name."""
        return self.to_dict()["fixed_patches"]

    @property
    def fields(self) -> dict:
        """The numbers of each field besides the potential that `fields=` named, by name, as in OUT.json."""
        return self.to_dict()["fields"]

    @property
    def interface(self) -> typing.Optional[dict]:
        """The complementarity that `interface=` asked for: partners, both states, the change; None without."""
        return self.to_dict()["interface"]

    @property
    def field_patches(self) -> list:
        """The patches of both states that `patches_of=` asked for: a dict for each field, as in OUT.json."""
        return self.to_dict()["field_patches"]

    @property
    def causes(self) -> list:
        """Which charges make the difference: a dict for each reading that `causes=` named, as in OUT.json."""
        return self.to_dict()["causes"]

    @property
    def residues(self):
        """The residue table: a pandas.DataFrame where pandas is installed, otherwise a dict of columns."""
        if self._residues is None:
            self._residues = table_of(self._core.residue_columns())
        return self._residues

    def to_frame(self):
        """The residue table as a pandas.DataFrame."""
        return frame_of(self._core.residue_columns())

    def save(self, prefix) -> typing.List[str]:
        """Writes PREFIX.json, PREFIX.vtp and PREFIX.residues.csv as the command line does; returns their names."""
        return self._core.save(_checks.prefix("prefix", prefix))

    def report(self, path=None, *, title: str = ""):
        """One page for any browser, without network: the surface to be turned, residues, numbers, verdict, provenance.

        Writes it to `path` and returns that; returns the page's text without one.
        """
        _checks.text("title", title)
        with tempfile.TemporaryDirectory(prefix="espdiff-") as folder:
            prefix = os.path.join(folder, "result")
            self.save(prefix)
            page = report_page(prefix, title)
        return written(page, path)

    def plot(self, quantity="mean_abs_difference", ax=None, top=None):
        """Draws a quantity by residue (Matplotlib); returns the axes. top: only the residues with the largest values."""
        from ._plots import plot_residues

        return plot_residues(self, quantity, ax, top)

    def to_pyvista(self):
        """The mapped surface as a pyvista.PolyData, with copies of all arrays of OUT.vtp under their names."""
        from ._plots import polydata

        surface = self._core.surface_arrays()
        mesh = polydata(surface["positions"], surface["triangles"], surface["points"])
        for name, values in surface["cells"].items():
            mesh.cell_data[name] = np.array(values)
        for name, text in surface["texts"].items():
            mesh.field_data[name] = [text]
        mesh.point_data.active_scalars_name = "potential_difference" if self.has_potential else "displacement"
        return mesh


class Matrix:
    """The result of matrix(): `labels`, and a table [source, target] for each metric."""

    def __init__(self, text, table=None):
        self._json = json.loads(text)
        self._files = {".json": text, ".csv": table}  # None without OUT.csv

    @property
    def labels(self) -> typing.List[str]:
        return [variant["label"] for variant in self._json["variants"]]

    @property
    def metrics(self) -> typing.List[str]:
        """Names of the tables."""
        return list(self._json["metrics"])

    def __getitem__(self, metric) -> np.ndarray:
        """(n, n) float64; row: source, column: target; NaN on the diagonal and where there is no value."""
        if metric not in self._json["metrics"]:
            raise InputError(f"metric: there is no {metric!r}; there are {', '.join(self.metrics)}")
        return np.array(self._json["metrics"][metric]["values"], dtype=float)

    @property
    def trustworthy(self) -> np.ndarray:
        """(n, n) bool."""
        return np.array([[bool(value) for value in row] for row in self._json["trustworthy"]])

    @property
    def template(self) -> typing.Optional[dict]:
        """Of matrix(template=...): name, states (how each maps), absent metrics, and exact: pairs and their agreement;
        otherwise None."""
        return self._json.get("template")

    def to_dict(self) -> dict:
        """The content of OUT.json."""
        return self._json

    def to_frame(self, metric=None):
        """A pandas.DataFrame: one table, or without a metric a row for each pair with all metrics."""
        if metric is not None:
            return frame_of(self[metric], index=self.labels, columns=self.labels)
        n, labels, trusted = len(self.labels), self.labels, self.trustworthy
        pairs = [(i, j) for i in range(n) for j in range(n) if i != j]
        columns = {"source": [labels[i] for i, _ in pairs], "target": [labels[j] for _, j in pairs]}
        for name in self.metrics:
            values = self[name]
            columns[name] = [values[pair] for pair in pairs]
        return frame_of({**columns, "trustworthy": [bool(trusted[pair]) for pair in pairs]})

    def report(self, path=None, *, title: str = ""):
        """One page for any browser, without network: a map of each metric, and all numbers of the pair that is selected.

        Writes it to `path` and returns that; returns the page's text without one.
        """
        if self._files[".csv"] is None:
            raise InputError("report: the page needs OUT.csv, which was not beside this matrix' OUT.json when it was read")
        return page_of_files(self._files, "matrix", path, title or f"{len(self.labels)} states")

    def __repr__(self):
        return f"<espdiff.Matrix of {len(self.labels)} states>"

    def _repr_html_(self):
        from ._html import matrix

        return matrix(self)
