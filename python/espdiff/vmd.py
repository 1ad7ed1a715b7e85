"""espdiff inside VMD's Python, and with vmd-python: the Tcl package's commands with Python's values.

    >>> from espdiff import vmd as esp
    >>> r = esp.compare({"mol": 0, "sel": "protein"}, {"mol": 1, "sel": "protein"}, grid_spacing=0.8)
    >>> r.metrics["mean_abs_difference"], r.certificate["trustworthy"]
    >>> r.draw(color="difference", range=(-5, 5))

A state is the id of a molecule in VMD, an `atomsel`, the path of a structure, or a dict with the keys of an endpoint
(docs/tcl.md, Source and target). Options are those of the Tcl commands, with underscores and without the dash.

This module needs neither the engine's Python extension nor NumPy, since VMD's Python is whatever VMD was built with;
arrays are NumPy's where it is there, otherwise memoryviews.
"""

import json
import math
import os

from ._errors import Error, InputError
from ._tables import Trajectory, column, number
from ._tcl import Interpreter, split_dict, split_list, word

_tcl = None
_NO_VALUE = "::espdiff::python_done"  # a command in the background calls it at its end


def _find_evaltcl():
    try:
        from vmd import evaltcl
    except ImportError:
        raise InputError(
            "espdiff.vmd works in the Python inside VMD and with vmd-python, and here is no module `vmd`; "
            "without VMD use `import espdiff`") from None
    return evaltcl


def load(folder=None, evaltcl=None):
    """Loads the Tcl package; the first call of a function does so by itself.

    folder: where `cmake --install` put it, unless VMD finds it (VMDPLUGINPATH, .vmdrc) or it lies beside this module.
    evaltcl: the function that evaluates Tcl, unless it is VMD's.
    """
    global _tcl
    tcl = Interpreter(evaltcl or _find_evaltcl())
    beside = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "tcl")
    folders = [os.path.join(os.fspath(folder), "tcl"), os.fspath(folder)] if folder is not None else [beside]
    for path in folders:
        tcl.eval("lappend ::auto_path " + word(path))
    try:
        tcl.eval("package require espdiff")
    except Error as error:
        raise InputError(
            "the Tcl package espdiff does not load (%s); name its folder, espdiff.vmd.load(FOLDER), or set "
            "VMDPLUGINPATH before VMD starts" % error) from None
    tcl.eval("proc %s {args} {}; proc ::espdiff::python_spelling {name value switch} "
             "{ return `[string map {- _} $name][expr {$switch ? {=True} : $value eq {} ? {} : \"=$value\"}]` }" % _NO_VALUE)
    _tcl = tcl
    return tcl.eval("espdiff version")


def _package():
    if _tcl is None:
        load()
    return _tcl


def _call(*words):
    """Calls a command of the package; its messages spell options as Python does."""
    tcl = _package()
    return tcl.eval(
        "set ::espdiff::option_spelling ::espdiff::python_spelling; "
        "::espdiff::finally { %s } { set ::espdiff::option_spelling {} }" % " ".join(word(entry) for entry in words))


def _options(options):
    return [entry for name, value in options.items() if value is not None
            for entry in ("-" + name.replace("_", "-"), value)]


def _endpoint(given, argument):
    """What Tcl calls an endpoint."""
    if isinstance(given, dict):
        return {key: _endpoint_map(value) if key == "map" else value for key, value in given.items()}
    if isinstance(given, (str, os.PathLike)):
        return {"file": given}
    if isinstance(given, int) and not isinstance(given, bool):
        return {"mol": given}
    if all(hasattr(given, name) for name in ("molid", "frame", "list_attributes")):
        return {"mol": given.molid, "sel": str(given), "frame": given.frame if given.frame >= 0 else "now"}
    raise InputError("%s: a %s is no molecule; give the id of a molecule in VMD, an atomsel, a path, or a dict with `mol` "
                     "or `file`" % (argument, type(given).__name__))


def _endpoint_map(value):
    """A map is a number, a name, or a path: {"map": "wild.dx"}; {"map": ("pb", {"ionic_strength": 0.05})}."""
    if isinstance(value, (list, tuple)):
        return [entry for part in value for entry in (
            [word_of for pair in part.items() for word_of in pair] if isinstance(part, dict) else [part])]
    return value


def _wait(handle, progress):
    """Waits for a computation in the background; Ctrl-C and an error of `progress` cancel it."""
    try:
        while _call("espdiff", "wait", handle, "-timeout", 50) == "0":
            if progress is not None:
                status = split_dict(_call("espdiff", "status", handle))
                progress(status["stage"], float(status["fraction"]))
    except BaseException:
        if handle in split_list(_call("espdiff", "handles")):
            _call("espdiff", "delete", handle)
        raise
    return handle


def _compute(words, options, progress):
    return _wait(_call("espdiff", *words, *_options(options), "-command", _NO_VALUE), progress)


def _array(handle, name):
    """An array of a surface, read-only, in NumPy's form where NumPy is."""
    kind, columns, digits = split_list(_call("::espdiff::core::array", handle, name))
    data, columns = bytes.fromhex(digits), int(columns)
    try:
        import numpy
    except ImportError:
        code = {"f4": "f", "f8": "d", "u4": "I", "i4": "i", "u1": "B"}[kind]
        flat = memoryview(data).cast(code)
        return flat.cast("B").cast(code, (len(flat) // columns, columns)) if columns > 1 and len(flat) else flat
    values = numpy.frombuffer(data, dtype="<" + kind)
    return values.reshape(-1, columns) if columns > 1 else values


class _Handle:
    """A result that the Tcl package keeps until delete()."""

    def __init__(self, handle):
        self.handle = handle
        self._result = None

    @property
    def result(self):
        """The content of OUT.json: a dict."""
        if self._result is None:
            self._result = json.loads(_call("::espdiff::core::result_json", self.handle))
        return self._result

    def delete(self):
        """Frees the result, with its drawings."""
        if self.handle is not None:
            _call("espdiff", "delete", self.handle)
        self.handle = None

    def __repr__(self):
        return "<espdiff.vmd %s>" % (self.handle or "result, deleted")


class _Surface(_Handle):
    _arrays = ()

    def __getattr__(self, name):
        if name in self._arrays:
            return _array(self.handle, name)
        raise AttributeError(name)

    def __dir__(self):
        return sorted({*super().__dir__(), *self._arrays})

    def draw(self, **options):
        """Draws it in VMD (`espdiff draw`): color, range, uncertain, view, ... Returns the graphics molecules' ids."""
        return [int(number) for number in split_list(_call("espdiff", "draw", self.handle, *_options(options)))]

    def undraw(self):
        _call("espdiff", "undraw", self.handle)

    def save(self, prefix, **options):
        """Writes PREFIX.json, PREFIX.vtp, PREFIX.residues.csv (of a surface, PREFIX.vtp); returns their names."""
        return split_list(_call("espdiff", "export", self.handle, prefix, *_options(options)))


class Comparison(_Surface):
    """The result of compare(). Arrays, read-only:

    positions, source_positions (vertices, 3) float64, A; normals, source_normals (vertices, 3) float32;
    triangles (triangles, 3) uint32; difference, source_potential, target_potential, displacement, slip, path_length
    (vertices) float32; residue_index (vertices) int32; corrupt, unmatched (triangles) uint8.
    """

    _arrays = ("positions", "source_positions", "normals", "source_normals", "triangles", "difference",
               "source_potential", "target_potential", "displacement", "slip", "path_length", "residue_index", "corrupt",
               "unmatched")

    @property
    def metrics(self):
        """The numbers of the comparison by name, as in OUT.json."""
        return {name: value for name, value in self.result.items() if isinstance(value, (int, float))}

    @property
    def certificate(self):
        return self.result["certificate"]

    @property
    def residues(self):
        """A dict for each residue of the source; NaN where there is no value."""
        texts = ("chain", "insertion", "name", "target_chain", "target_insertion", "target_name")
        rows = [split_dict(row) for row in split_list(_call("espdiff", "residues", self.handle))]
        return [{key: value if key in texts else int(value) if value and key in ("index", "number", "target_number")
                 else number(value)
                 for key, value in row.items()} for row in rows]

    def table(self):
        """The table of the command line."""
        return _call("espdiff", "table", self.handle)

    def highlight(self, residues, **options):
        """Highlights residues by their `index`; an empty list ends that. Returns the molecules."""
        return [int(number) for number in split_list(
            _call("espdiff", "highlight", self.handle, list(residues), *_options(options)))]

    def color_atoms(self, **options):
        """Writes a quantity of the residues to their atoms (`espdiff atoms`): quantity, field, show, ... A dict."""
        return {key: number(value) if key in ("min", "max") else int(value) if key == "atoms" else value
                for key, value in split_dict(_call("espdiff", "atoms", self.handle, *_options(options))).items()}

    def uncolor_atoms(self):
        _call("espdiff", "uncolor", self.handle)

    def map(self, **options):
        """A quantity on a lattice around the surface: mol=ID returns the data set's number, file=PATH the file."""
        made = _call("espdiff", "map", self.handle, *_options(options))
        return int(made) if options.get("mol") is not None else made

    def __str__(self):
        return self.table()


class Surface(_Surface):
    """The result of surface(): positions, normals, triangles, residue_index, potential; see Comparison."""

    _arrays = ("positions", "normals", "triangles", "residue_index", "potential")


class Ensemble(_Surface):
    """The result of ensemble(): `result` is the content of OUT.json. Arrays by vertex of the template, read-only:

    positions (vertices, 3) float64, A; normals; triangles; residue_index; difference, low, high, p, p_family_wise
    (vertices) float64, NaN where not tested, empty for one group.
    """

    _arrays = ("positions", "normals", "triangles", "residue_index", "difference", "low", "high", "p", "p_family_wise")

    @property
    def patches(self):
        """The significant patches: dicts, as in OUT.json."""
        return self.result.get("patches", [])

    def table(self):
        """The table of the command line."""
        return _call("espdiff", "table", self.handle)

    def __str__(self):
        return self.table()


class Matrix(_Handle):
    """The result of matrix(): `result` is the content of OUT.json."""

    @property
    def labels(self):
        return [variant["label"] for variant in self.result["variants"]]

    def __getitem__(self, metric):
        """[source][target], NaN where there is no value; NumPy's where it is there."""
        rows = [[math.nan if value is None else value for value in row]
                for row in self.result["metrics"][metric]["values"]]
        try:
            import numpy
        except ImportError:
            return rows
        return numpy.array(rows, dtype=float)

    def table(self):
        return _call("espdiff", "table", self.handle)


def compare(source, target, progress=None, **options):
    """Compares two states; returns a Comparison. progress: a function of (stage, fraction). Ctrl-C cancels."""
    words = ("compare", _endpoint(source, "source"), _endpoint(target, "target"))
    return Comparison(_compute(words, options, progress))


def surface(molecule, progress=None, **options):
    """The surface of one state, with its potential where there is a map; returns a Surface."""
    return Surface(_compute(("surface", _endpoint(molecule, "molecule")), options, progress))


def matrix(states, output, progress=None, **options):
    """Compares each state with each other; dicts may have `label`, `group` and `frames`. Returns a Matrix.

    output: prefix of OUT.csv and OUT.json. Options: resume, overwrite, on_error, shard, template, exact_sample,
    cluster_by, ...
    """
    words = ("matrix", [_endpoint(state, "states[%d]" % i) for i, state in enumerate(states)], "-output", output)
    return Matrix(_compute(words, options, progress))


def ensemble(groups, output, progress=None, **options):
    """Compares two groups of simulations on one template surface (`espdiff ensemble`); returns an Ensemble.

    groups: {name: replicates}; a replicate is a molecule of VMD with its frames (an id, an atomsel, or a dict with mol, sel
    and frames), or a file: a path, or a dict with file, topology and label. output: prefix of OUT.h5 and the results.
    Options: charges={group: file}, frames, template, map, resume, patch={name: selection}, states, ...
    """
    words = []
    for name, replicates in groups.items():
        members = [_endpoint(each, "groups[%r][%d]" % (name, i)) for i, each in enumerate(replicates)]
        for member in members:
            member.pop("frame", None)  # all of them; `frames` chooses
        words += [name, members]
    return Ensemble(_compute(("ensemble", words), dict(options, output=output), progress))


def trajectory(mol=None, csv=None, file=None, reference=None, progress=None, **options):
    """Compares each frame of a molecule, or model of a file, with a reference; a row each in a CSV file.

    reference: a frame's number, "previous", or a state; frame 0 without it. Options: sel, frames ("0:5:end"), map,
    resume, overwrite, on_error, ... Returns a Trajectory.
    """
    if csv is None:
        raise InputError("csv: name the file that gets the rows")
    if isinstance(reference, int) and not isinstance(reference, bool):
        reference = ["frame", reference]
    elif reference is not None and reference != "previous":
        reference = _endpoint(reference, "reference")
    handle = _compute(("trajectory",), dict(options, mol=mol, file=file, reference=reference, csv=csv), progress)
    summary = split_dict(_call("espdiff", "result", handle))
    _call("espdiff", "delete", handle)
    return Trajectory({key: value if key == "csv" else number(value) if key == "seconds" else int(value)
                       for key, value in summary.items()})


def undraw():
    """Removes all drawings."""
    _call("espdiff", "undraw")


def call(command, *arguments, **options):
    """Any other command of the Tcl package, such as call("prepare", {"mol": 0}, pqr="out.pqr"); its result as text."""
    return _call("espdiff", command, *arguments, *_options(options))


def doctor():
    """What is installed, found, loaded and missing."""
    return _call("espdiff", "doctor")


__all__ = ["Comparison", "Ensemble", "Matrix", "Surface", "Trajectory", "call", "compare", "doctor", "ensemble", "load",
           "matrix", "surface", "trajectory", "undraw"]
