"""Results that files hold: what load() reads, and what a pickled Comparison becomes."""

import csv
import io
import json
import os
import tempfile

import numpy as np

from . import _checks, _core
from ._reports import table_beside
from ._results import Comparison, Matrix, verdict_of

FORMATS = {"comparison": "espdiff comparison", "matrix": "espdiff matrix", "ensemble": "espdiff ensemble"}
FORMAT_VERSION = 1
_ENDINGS = (".json", ".vtp", ".residues.csv")
_KEPT = (".causes.csv", ".source.pqr", ".target.pqr")
_KEPT_NAME = b"espdiff-kept-result"  # of files while they are pickled; save() gives them their names
_TYPES = {"source_position": np.float64, "residue_number": np.int32, "residue_index": np.int32, "sign_change": np.uint8,
          "corrupt": np.uint8, "no_counterpart": np.uint8}


def _read_only(values):
    values.setflags(write=False)
    return values


def _surface_of(content):
    """As Comparison.surface_arrays() gives it: the types of the file."""
    with tempfile.TemporaryDirectory(prefix="espdiff-") as folder:
        path = os.path.join(folder, "surface.vtp")
        with open(path, "wb") as file:
            file.write(content)
        surface = _core.read_surface(path)
    typed = {part: {name: _read_only(values.astype(_TYPES.get(name, np.float32))) for name, values in surface[part].items()}
             for part in ("points", "cells")}
    return {**typed, "texts": surface["texts"], "positions": _read_only(np.array(surface["positions"])),
            "triangles": _read_only(surface["triangles"].astype(np.uint32))}


def _column_name(header, names):
    base = header.split(" [")[0]
    return next((name for name in (base, base + "_A", base + "_A2") if name in names), base)


def _columns_of(content):
    rows = list(csv.reader(io.StringIO(content.decode("utf-8", "replace"))))
    names = {row["name"] for row in _core.metrics()}
    columns = {"chain": [], "number": [], "insertion_code": [], "name": []}
    for name, values in zip(("chain", "number", "insertion_code", "name"), zip(*rows[1:])):
        columns[name] = [int(value) for value in values] if name == "number" else list(values)
    for place, header in enumerate(rows[0][4:], 4):
        columns[_column_name(header, names)] = np.array([float(row[place] or "nan") for row in rows[1:]])
    return columns


def _at(record, pointer):
    for key in pointer.split("/")[1:]:
        record = record.get(key) if isinstance(record, dict) else None
    return float("nan") if record is None else float(record)


class Saved:
    """What a Comparison needs of the engine, from the files that it wrote.

    files: {ending: content}; text: the table that was printed, empty where no file has it.
    """

    def __init__(self, files, text=""):
        self.files, self.text = files, text
        self.record = json.loads(files[".json"])
        self._surface = self._columns = None

    @classmethod
    def of(cls, core):
        with tempfile.TemporaryDirectory(prefix="espdiff-") as folder:
            prefix = os.path.join(folder, _KEPT_NAME.decode())
            files = {}
            for path in core.save(prefix):
                with open(path, "rb") as file:
                    files[path[len(prefix):]] = file.read()
        return cls(files, core.table())

    def json(self):
        return self.files[".json"].decode("utf-8", "replace")

    def table(self):
        return self.text or "\n".join([*self._lines(), self.verdict]) + "\n"

    def _lines(self):
        values = self.metrics
        for row in _core.metrics():
            if row["has_result"] and np.isfinite(values[row["name"]]):
                unit = self.unit if row["shown_unit"] == "potential" else row["shown_unit"]
                yield f"{row['label']:<45} {row['shown_factor'] * values[row['name']]:.4g} {unit}".rstrip()

    @property
    def metrics(self):
        return {row["name"]: _at(self.record, row["json"]) for row in _core.metrics() if row["has_result"]}

    @property
    def verdict(self):
        name = "mean_abs_difference" if self.has_potential else "mean_displacement_A"
        label = next(row["label"] for row in _core.metrics() if row["name"] == name)
        unit = self.record["potential_unit"] if self.has_potential else "A"
        return (f"{verdict_of(self.record['certificate'])}: {label[0].lower()}{label[1:]} "
                f"{self.metrics[name]:.4g} {unit}")

    trustworthy = property(lambda self: self.record["certificate"]["trustworthy"])
    has_potential = property(lambda self: self.record["potential_unit"] is not None)
    unit = property(lambda self: self.record["potential_unit"] or "")

    def surface_arrays(self):
        if self._surface is None:
            self._surface = _surface_of(self.files[".vtp"])
        return self._surface

    def residue_columns(self):
        if self._columns is None:
            self._columns = _columns_of(self.files[".residues.csv"])
        return dict(self._columns)

    def _point(self, name):
        found = self.surface_arrays()["points"].get(name)
        return np.empty(0, np.float32) if found is None else found

    positions = property(lambda self: self.surface_arrays()["positions"])
    triangles = property(lambda self: self.surface_arrays()["triangles"])
    source_positions = property(lambda self: self._point("source_position"))
    normals = property(lambda self: self._point("normal"))
    source_normals = property(lambda self: self._point("source_normal"))
    source_potential = property(lambda self: self._point("potential_source"))
    target_potential = property(lambda self: self._point("potential_target"))
    difference = property(lambda self: self._point("potential_difference"))
    displacement = property(lambda self: self._point("displacement"))
    path_length = property(lambda self: self._point("path_length"))
    slip = property(lambda self: self._point("slip"))
    residue_index = property(lambda self: self._point("residue_index"))
    corrupt = property(lambda self: self.surface_arrays()["cells"]["corrupt"])
    unmatched = property(lambda self: self.surface_arrays()["cells"]["no_counterpart"])

    @property
    def area(self):
        counted = (np.asarray(self.corrupt) == 0) & (np.asarray(self.unmatched) == 0)
        corners = np.asarray(self.triangles)[counted]
        a, b, c = (np.asarray(self.positions)[corners[:, k]] for k in range(3))
        thirds = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6
        areas = np.zeros(len(self.positions))
        for k in range(3):
            np.add.at(areas, corners[:, k], thirds)
        return areas

    def _state(self, role):
        """The state as it was compared: kept beside the result, or its file."""
        kept = self.files.get(f".{role}.pqr")
        if kept is None:
            given = next(entry for entry in self.record["inputs"] if entry["role"] == role)
            return _core.State.read(given["path"], model=given.get("model", 1), hetero=given.get("hetero", True),
                                    water=given.get("water", False))
        with tempfile.TemporaryDirectory(prefix="espdiff-") as folder:
            path = os.path.join(folder, f"result.{role}.pqr")
            with open(path, "wb") as file:
                file.write(kept)
            return _core.State.read(path, water=True)

    source = property(lambda self: self._state("source"))
    target = property(lambda self: self._state("target"))

    def save(self, prefix):
        """Writes the files as the run wrote them; files beside them are named by the new prefix."""
        name = os.path.basename(prefix).encode()
        old = self._kept_name()
        paths = []
        for ending, content in self.files.items():
            if ending == ".json" and old:
                for kept in _KEPT:
                    content = content.replace(b'"' + old + kept.encode() + b'"', b'"' + name + kept.encode() + b'"')
            try:
                with open(prefix + ending, "wb") as file:
                    file.write(content)
            except OSError as error:
                raise _core.IoError(f"{prefix}{ending}: cannot be written: {error.strerror}") from None
            paths.append(prefix + ending)
        return paths

    def _kept_name(self):
        for given in self.record["inputs"]:
            ending = f".{given['role']}.pqr"
            if ending in self.files and given["path"].endswith(ending):
                return given["path"][:-len(ending)].encode()
        return b""


def rebuilt(files, text):
    return Comparison(Saved(files, text))


def _kind_of(path, record):
    found = record.get("format") if isinstance(record, dict) else None
    if found not in FORMATS.values():
        raise _core.FormatError(f"{path}: no result of compare, matrix or ensemble in a format that this version reads; "
                                "give OUT.json, or compute it again")
    version = record.get("format_version", FORMAT_VERSION)
    if version != FORMAT_VERSION:
        raise _core.FormatError(f"{path}: has format version {version}, and this espdiff {_core.__version__} reads "
                                f"{FORMAT_VERSION}; use the version that wrote it, {record.get('version')}")
    return found


def _read(path):
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise _core.IoError(f"{path}: cannot be read: {error.strerror}") from None


def load(path):
    """A result that files hold: the Comparison, Matrix or Ensemble of OUT.json.

    path: OUT.json, its prefix OUT, or OUT.vtp; OUT.h5 of an ensemble, whose statistics are computed again from it.
    A Comparison has all numbers and arrays of its files; its potentials are not computed again.
    Raises IoError (a file is missing), FormatError (it is no result, or another version's).
    """
    path = _checks.path("path", path)
    prefix = next((path[:-len(end)] for end in (".residues.csv", ".json", ".vtp", ".h5", ".vtkhdf") if path.endswith(end)), path)
    if path.endswith((".h5", ".vtkhdf")):
        return _load_ensemble(path, {})
    content = _read(prefix + ".json")
    try:
        record = json.loads(content)
    except ValueError as error:
        raise _core.FormatError(f"{prefix}.json: no JSON: {error}") from None
    kind = _kind_of(prefix + ".json", record)
    if kind == FORMATS["matrix"]:
        return Matrix(content, table_beside(prefix))
    if kind == FORMATS["ensemble"]:
        return _load_ensemble(prefix + ".h5", record)
    files = {".json": content, **{ending: _read(prefix + ending) for ending in _ENDINGS[1:]}}
    return Comparison(Saved({**files, **{end: _read(prefix + end) for end in _KEPT if os.path.exists(prefix + end)}}))


def _load_ensemble(path, record):
    from ._ensembles import ensemble

    given = record.get("options", {})
    names = {"alpha": "alpha", "control": "control", "most_missing": "most_missing", "permutations": "max_permutations",
             "seed": "seed"}
    return ensemble(from_file=path, **{name: given[key] for name, key in names.items() if key in given})
