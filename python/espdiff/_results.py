"""Results: the engine's arrays and numbers, with what plots and tables need."""

import json

import numpy as np


class Certificate:
    """Whether a correspondence can be trusted: `trustworthy`, `reasons`, and every check by its name in OUT.json."""

    def __init__(self, values):
        self._values = values

    def __getattr__(self, name):
        try:
            return self._values[name]
        except KeyError:
            raise AttributeError(f"the certificate has no {name!r}; it has {', '.join(self._values)}") from None

    def __dir__(self):
        return [*super().__dir__(), *self._values]

    def to_dict(self):
        return dict(self._values)

    def __repr__(self):
        verdict = self.verdict if self.trustworthy else self.verdict + ": " + "; ".join(self.reasons)
        return f"<espdiff.Certificate {verdict}>"


def table_of(columns):
    """A pandas.DataFrame where pandas is installed, else the dict of columns."""
    try:
        import pandas
    except ImportError:
        return columns
    return pandas.DataFrame(columns)


class EngineResult:
    """A result that the engine holds: its attributes are the engine's, and the arrays are views of its memory."""

    def __init__(self, core):
        self._core = core
        self._json = None

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self._core, name)

    def __dir__(self):
        return sorted({*super().__dir__(), *(n for n in dir(self._core) if not n.startswith("_"))})

    def __str__(self):
        return self._core.table()

    def to_dict(self):
        """The content of OUT.json."""
        if self._json is None:
            self._json = json.loads(self._core.json())
        return self._json


class Comparison(EngineResult):
    """The result of compare(). Arrays are NumPy's, read-only views of the engine's (see `espdiff._core.Comparison`)."""

    def __init__(self, core):
        super().__init__(core)
        self._residues = None

    def __repr__(self):
        metrics = self.metrics
        verdict = self._core.verdict
        if self.has_potential:
            return f"<espdiff.Comparison mean |difference| {metrics['mean_abs_difference']:.3g} {self.unit}, {verdict}>"
        return f"<espdiff.Comparison of shapes, {verdict}>"

    @property
    def certificate(self):
        return Certificate(self.to_dict()["certificate"])

    @property
    def region(self):
        """The numbers, certificate and residues of the region, a dict under the names of OUT.json; None without one."""
        return self.to_dict()["region"]

    @property
    def fixed_patches(self):
        """The same of each patch that `patches=` named, by name."""
        return self.to_dict()["fixed_patches"]

    @property
    def causes(self):
        """Which charges make the difference: a dict for each reading that `causes=` named, as in OUT.json."""
        return self.to_dict()["causes"]

    @property
    def residues(self):
        """The residue table: a pandas.DataFrame where pandas is installed, else a dict of columns."""
        if self._residues is None:
            self._residues = table_of(self._core.residue_columns())
        return self._residues

    def save(self, prefix):
        """Writes PREFIX.json, PREFIX.vtp and PREFIX.residues.csv as the command line does; returns their names."""
        return self._core.save(str(prefix))

    def plot(self, quantity="mean_abs_difference", ax=None, top=None):
        """Draws a quantity by residue (Matplotlib); returns the axes. top: only the residues with the largest values."""
        import matplotlib.pyplot as plt

        columns = self._core.residue_columns()
        if quantity not in columns:
            from ._core import InputError

            raise InputError(f"quantity: there is no {quantity!r}; there are {', '.join(list(columns)[4:])}")
        values = np.asarray(columns[quantity])
        labels = np.array([f"{chain}{':' if chain else ''}{name}{number}{code}" for chain, name, number, code in zip(
            columns["chain"], columns["name"], columns["number"], columns["insertion_code"])])
        if top is not None:
            order = np.argsort(-np.nan_to_num(np.abs(values)), kind="stable")[:top]
            values, labels = values[order], labels[order]
        if ax is None:
            _, ax = plt.subplots(figsize=(8, 3), layout="constrained")
        ax.bar(np.arange(len(values)), values, width=0.9, color="#d55e00")
        ticks = np.unique(np.linspace(0, max(len(values) - 1, 0), min(len(values), 24)).astype(int))
        ax.set_xticks(ticks, labels[ticks] if len(values) else [], rotation=90, fontsize=7)
        from ._core import metrics

        about = {row["name"]: row for row in metrics()}[quantity]
        unit = self.unit if about["unit"] == "potential" else about["unit"]
        ax.set_ylabel(f"{about['label']}{f' ({unit})' if unit else ''}")
        ax.margins(x=0.01)
        return ax

    def to_pyvista(self):
        """The mapped surface as a pyvista.PolyData, with copies of the arrays of OUT.vtp."""
        from ._plots import polydata

        arrays = {"displacement": self.displacement, "residue_index": self.residue_index}
        if self.has_potential:
            arrays.update(potential_source=self.source_potential, potential_target=self.target_potential,
                          potential_difference=self.difference)
        triangles = self.triangles
        mesh = polydata(self.positions, triangles, arrays)
        mesh.cell_data["corrupt"] = np.array(self.corrupt)
        mesh.cell_data["unmatched"] = np.array(self.unmatched) if len(self.unmatched) else np.zeros(len(triangles), np.uint8)
        return mesh


class Matrix:
    """The result of matrix(): `labels`, and a table [source, target] for each metric."""

    def __init__(self, text):
        self._json = json.loads(text)

    @property
    def labels(self):
        return [variant["label"] for variant in self._json["variants"]]

    @property
    def metrics(self):
        """Names of the tables."""
        return list(self._json["metrics"])

    def __getitem__(self, metric):
        """(n, n) float64; row: source, column: target; NaN on the diagonal and where there is no value."""
        return np.array(self._json["metrics"][metric]["values"], dtype=float)

    @property
    def trustworthy(self):
        return np.array([[bool(value) for value in row] for row in self._json["trustworthy"]])

    @property
    def template(self):
        """Of matrix(template=...): name, states (how each maps), absent metrics, and exact: pairs and their agreement;
        otherwise None."""
        return self._json.get("template")

    def to_dict(self):
        """The content of OUT.json."""
        return self._json

    def to_frame(self, metric):
        """One table as a pandas.DataFrame."""
        import pandas

        return pandas.DataFrame(self[metric], index=self.labels, columns=self.labels)

    def __repr__(self):
        return f"<espdiff.Matrix of {len(self.labels)} states>"
