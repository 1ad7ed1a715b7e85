"""The functions of the package: arguments of Python's kind for the engine's."""

from __future__ import annotations

import os
import tempfile
import typing
import warnings

import numpy as np

from . import _checks, _core
from ._inputs import refuse_the_same_atoms, state_of, with_values
from ._reports import table_beside
from ._results import Comparison, Matrix
from ._signatures import PREPARATION_GROUPS, as_text, option_rows, study_defaults, study_texts, takes_options
from ._tables import Trajectory

if typing.TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import MatrixOptions, Options, TrajectoryOptions


def _as_settings(options):
    """[(name, text)] of keyword arguments: grid_spacing=1 is the option grid-spacing; patches={name: selection};
    fields={name: kind}, or a list of kinds."""
    options = dict(options)
    patches = options.pop("patches", None) or {}
    if not hasattr(patches, "items"):
        raise _core.InputError(f'patches: {patches!r} is not a dict, such as {{"site": "//A/8-12"}}')
    fields = options.pop("fields", None) or []
    if isinstance(fields, str):
        fields = [fields]
    if hasattr(fields, "items"):
        fields = [f"{name}={kind}" for name, kind in fields.items()]
    return [(name.replace("_", "-"), as_text(value)) for name, value in options.items()] + [
        ("patch", f"{name}={selection}") for name, selection in patches.items()] + [("field", field) for field in fields]


def _array_fields(options, n_states):
    """Takes fields of arrays out of the options: the options with given:NAME in their place, and
    {name: [an array for each state]}. One array serves all states; a list or tuple has one for each."""
    fields = options.get("fields")
    if not hasattr(fields, "items"):
        return options, {}
    kinds, arrays = {}, {}
    for name, value in fields.items():
        if isinstance(value, str):
            kinds[name] = value
            continue
        several = isinstance(value, (list, tuple)) and len(value) > 0 and all(np.ndim(entry) > 0 for entry in value)
        if several and len(value) != n_states:
            raise _core.InputError(f"fields[{name!r}]: there are {len(value)} arrays for {n_states} states")
        if not several and np.ndim(value) != 1:
            raise _core.InputError(f"fields[{name!r}]: {value!r} is neither a kind, such as 'hydrophobicity', nor an array "
                                   "with a number for each atom")
        kinds[name], arrays[name] = f"given:{name}", list(value) if several else [value] * n_states
    return {**options, "fields": kinds}, arrays


def _with_arrays(states, given, arrays, roles):
    """The States with their arrays; `given` is what they were made of."""
    for name, values in arrays.items():
        states = [with_values(one, state, name, array, role)
                  for one, state, array, role in zip(given, states, values, roles)]
    return states


def _call(function, options):
    """What results tell of the call: the potential first, and not where it was computed."""
    arguments = ", ".join(f"{name}={value!r}" for name, value in {"potential": "auto", **options}.items()
                          if name not in ("pme_cell", "device", "threads"))
    return f"espdiff.{function}({arguments})"


class _Bar:
    """Progress as a bar of tqdm's, where it is installed."""

    def __init__(self, what):
        try:
            from tqdm.auto import tqdm
        except ImportError:
            self._bar = None
        else:
            self._bar = tqdm(total=100, desc=what, leave=False, bar_format="{desc}: {percentage:3.0f}%|{bar}| {postfix}")

    def __call__(self, stage, fraction):
        if self._bar is not None:
            self._bar.n = round(100 * fraction)
            self._bar.set_postfix_str(stage)

    def close(self):
        if self._bar is not None:
            self._bar.close()


class _Progress:
    """What `progress=` gives: True for a bar, a function of (stage, fraction), or nothing."""

    def __init__(self, progress, what):
        self.listener = _Bar(what) if _checks.listener(progress) is True else progress or None

    def __enter__(self):
        return self.listener

    def __exit__(self, *_):
        if isinstance(self.listener, _Bar):
            self.listener.close()


def _with_map(state, given, unit, role):
    if given is None:
        return state
    if isinstance(given, (str, os.PathLike)):
        return state.with_map(os.fspath(given), unit=unit or "")
    if isinstance(given, _core.Map):
        steps = [given.steps[axis][axis] for axis in range(3)]
        if any(given.steps[a][b] for a in range(3) for b in range(3) if a != b):
            raise _core.InputError(f"{role}_map: its axes are not x, y and z; save it, and give the file")
        return state.with_map(given.values, list(given.origin), steps, given.unit)
    raise _core.InputError(f"{role}_map: a {type(given).__name__} is no map; give a path or an espdiff.Map")


@takes_options
def compare(source, target, *, source_map=None, target_map=None, source_map_unit=None, target_map_unit=None, progress=None,
            **options: Unpack[Options]) -> Comparison:
    """Compares the electrostatic potential on the surfaces of two states.

    source, target: path, State, Universe or AtomGroup of MDAnalysis, atoms of ProDy. Those without charges get some from
    PDB2PQR as files do, or are an error; potential="none" compares shapes alone.
    source_map, target_map: paths (DX, VTI, cube) or Maps of the potentials; without them `potential` is computed.
    progress: True for a bar (tqdm), or a function of (stage, fraction).
    options: those of the command line, with underscores: potential="pme", ionic_strength=0.1, threads=4;
    `espdiff.help_options()` explains them.
    fields: other quantities besides, {name: kind}; instead of a kind an array with a number for each atom, or a pair of
    arrays, of the source's and of the target's atoms.

    Returns a Comparison. Raises espdiff.Error: InputError, FormatError, IoError, GeometryError, ...; Ctrl-C raises
    KeyboardInterrupt and ends the computation.
    """
    if source_map is None and target_map is None:
        refuse_the_same_atoms(source, target)
    a = _with_map(state_of(source, "source"), source_map, source_map_unit, "source")
    b = _with_map(state_of(target, "target"), target_map, target_map_unit, "target")
    options, arrays = _array_fields(options, 2)
    a, b = _with_arrays([a, b], [source, target], arrays, ["source", "target"])
    with _Progress(progress, "compare") as listener:
        return Comparison(_core.compare(a, b, _as_settings(options), _call("compare", options), listener))


@takes_options
def surface(state, *, map=None, map_unit=None, regularize: bool = False, progress=None,
            **options: Unpack[Options]) -> _core.Surface:
    """The surface of one molecule with its potential at the vertices; potential="none" leaves that out.

    Arguments as of compare(). regularize: even out the triangles, as for the source of a comparison.
    """
    regularize = _checks.switch("regularize", regularize)
    given = _with_map(state_of(state, "state"), map, map_unit, "state")
    with _Progress(progress, "surface") as listener:
        return _core.surface(given, _as_settings(options), regularize, listener)


@takes_options(without=("potential", "pme_cell"))
def potential(state, method: str = "auto", *, progress=None, **options: Unpack[Options]) -> _core.Map:
    """A map of the potential of a molecule's charges: pb, pme or coulomb; auto as in compare().

    Returns a Map: values (nx, ny, nz), origin, steps, unit; save("map.dx").
    """
    with _Progress(progress, "potential") as listener:
        return _core.potential(state_of(state, "state"), _as_settings({"potential": method, **options}), listener)


@takes_options(groups=PREPARATION_GROUPS)
def prepare(state, *, progress=None, **options: Unpack[Options]) -> _core.State:
    """A State with charges, radii and hydrogens, as compare() makes it of what has none: PDB2PQR and PROPKA.

    state: as in compare(); one that has charges keeps them. options: select, leave_out, ph, force_field, ligand, ...
    Returns a State: save("a.pqr") writes it, preparation tells what was added, repaired and protonated.
    """
    with _Progress(progress, "prepare") as listener:
        return _core.prepare(state_of(state), _as_settings(options), listener)


def labels_of_states(states):
    """A file's name without its ending; "state3" for what is no file."""
    return [os.path.splitext(os.path.basename(os.fspath(s)))[0] if isinstance(s, (str, os.PathLike)) else f"state{i}"
            for i, s in enumerate(states)]


@takes_options(besides=study_defaults("matrix"))
def matrix(states, labels=None, *, groups=None, output=None, progress=None,
           **options: Unpack[MatrixOptions]) -> typing.Optional[Matrix]:
    """Compares every state with every other one, in both directions.

    states: as in compare(). labels: a name for each; paths name themselves. groups: optional, one for each state.
    output: prefix of OUT.csv and OUT.json; with `resume` a run that broke off continues. shard: "2/8" computes a part,
    for espdiff merge; it needs `output`.
    template: "medoid", a label, a number from 0, or a structure file, whose surface is mapped onto each state: a mapping
    for each state instead of each pair, and differences of potentials only. exact_sample: pairs, chosen at random, that
    are compared by themselves as well; Matrix.template["exact"] tells how they agree.

    Returns a Matrix, None for a shard.
    """
    own = {name: options.pop(name) for name in study_defaults("matrix") if name in options}
    states = _checks.several("states", states, "states")
    labels, groups = ([_checks.text(name, entry) for entry in _checks.several(name, given, "texts")]
                      if given is not None else None for name, given in (("labels", labels), ("groups", groups)))
    if labels is None:
        labels = labels_of_states(states)
    if (own.get("shard") or own.get("resume")) and output is None:
        raise _core.InputError("output: a part of a matrix, or one to continue, needs files")
    roles = [f"states[{i}]" for i in range(len(states))]
    options, arrays = _array_fields(options, len(states))
    given = _with_arrays([state_of(state, role) for state, role in zip(states, roles)], states, arrays, roles)
    with _Progress(progress, "matrix") as listener, tempfile.TemporaryDirectory(prefix="espdiff-") as scratch:
        prefix = _checks.prefix("output", output) if output is not None else os.path.join(scratch, "matrix")
        text = _core.matrix(given, list(labels), list(groups or []), _as_settings(options), prefix,
                            study_texts("matrix", own), listener)
        return Matrix(text, table_beside(prefix)) if text else None


def merge(parts, output, *, overwrite: bool = False):
    """Merges the parts of `shard=`, as `espdiff merge` does: the bytes of one process.

    parts: OUT.shard-*.state of a matrix (with `template` the OUT.shard-*.h5 too), whose OUT.csv and OUT.json are written;
    or OUT.shard-*.h5 of an ensemble, whose OUT.h5 and results are. Returns the Matrix or Ensemble.
    """
    parts = [_checks.path("parts", part) for part in _checks.several("parts", parts, "paths")]
    output, overwrite = _checks.prefix("output", output), _checks.switch("overwrite", overwrite)
    if parts and all(part.endswith(".h5") for part in parts) and not _core.is_template_matrix(parts):
        from ._ensembles import ensemble

        _core.merge_ensemble(parts, output, overwrite, None)
        return ensemble(from_file=output + ".h5", output=output)
    return Matrix(_core.merge_matrix(parts, output, overwrite, None), table_beside(output))


class Series:
    """Many targets against one source, whose surface and potential are made once.

        series = espdiff.Series("reference.pqr", potential="pb")
        for frame in frames:
            r = series.step(frame)

    start: auto, source or previous: where each mapping begins (`espdiff trajectory --help`).
    """

    @takes_options
    def __init__(self, source, *, start: str = "auto", **options: Unpack[Options]):
        options, arrays = _array_fields(options, 2)
        self._arrays = {name: target for name, (_, target) in arrays.items()}
        of_source, = _with_arrays([state_of(source, "source")], [source], {n: a[:1] for n, a in arrays.items()}, ["source"])
        call = _call("Series", {"potential": "auto", "start": _checks.text("start", start), **options})
        self._series = _core.Series(of_source, _as_settings(options), start, call)

    def step(self, target, progress=None, *, fields=None) -> Comparison:
        """Compares the source with the next target. Returns a Comparison.

        fields: {name: array} of this target, instead of those that the series was given.
        """
        arrays = {**self._arrays, **(fields or {})}
        if arrays.keys() - self._arrays.keys():
            raise _core.InputError(f"fields: the series has no field of arrays {sorted(arrays.keys() - self._arrays.keys())[0]!r}"
                                   "; name it where the Series is made")
        state, = _with_arrays([state_of(target, "target")], [target], {n: [a] for n, a in arrays.items()}, ["target"])
        with _Progress(progress, "compare") as listener:
            return Comparison(self._series.step(state, listener))


@takes_options(besides=study_defaults("trajectory"))
def trajectory(source, files, csv, *, source_frames=None, progress=None,
               **options: Unpack[TrajectoryOptions]) -> Trajectory:
    """Compares each frame of files with one structure: a row for each frame, as `espdiff trajectory` writes them.

    source: path of a structure, or of a topology, which is then compared in the first frame's coordinates.
    files: paths of structures with models, or of trajectories that VMD reads; one, or a list.
    csv: table that gets a row for each frame; with `resume` an interrupted run continues.
    reference: source, or previous for the frame before. source_frames: paths; frame i is compared with frame i of these.
    frames_of: a structure or topology of the frames' own atoms, charges and radii. source_map, target_map: paths.
    For states that are no files, and whole results, see Series.

    Returns a Trajectory: result (numbers of rows), columns, to_frame(). A resumed run that cannot continue the previous
    mapping says so in a warning.
    """
    own = {name: options.pop(name) for name in study_defaults("trajectory") if name in options}
    paths = {name: [_checks.path(name, path) for path in ([given] if isinstance(given, (str, os.PathLike)) else
                                                          _checks.several(name, given, "paths"))]
             for name, given in (("files", files), ("source_frames", source_frames or []))}
    if not paths["files"]:
        raise _core.InputError("files: name one trajectory or more")
    order = {"source": _checks.path("source", source), "frames": paths["files"], "source_frames": paths["source_frames"],
             "settings": _as_settings(options),
             "options": study_texts("trajectory", own), "csv": _checks.prefix("csv", csv)}
    with _Progress(progress, "trajectory") as listener:
        summary = _core.trajectory(order, listener)
    told = summary.pop("warning")
    if told:
        warnings.warn(told, stacklevel=2)
    return Trajectory({**summary, "csv": order["csv"]})


def frames(topology, *files, plugins=""):
    """The frames of trajectories as a sequence of States, read by VMD's molfile plugins as on the command line.

    topology: a structure, or a topology that VMD reads (PSF, prmtop, GRO, ...). files: trajectories of its atoms (DCD, XTC,
    TRR, NetCDF, ...), or structures with models. plugins: their folder, unless VMD is found ($VMDDIR, PATH). A DCD that
    lacks frames is told by a warning.

        frames = espdiff.frames("adk.psf", "adk_dims.dcd")
        r = espdiff.compare(frames[0], frames[-1])
    """
    if not files:
        raise _core.InputError("files: name one trajectory or more")
    found = _core.Frames(_checks.path("topology", topology), [_checks.path("files", path) for path in files],
                         _checks.path("plugins", plugins))
    if found.incomplete:
        warnings.warn(found.incomplete, stacklevel=2)
    return found


def help_options():
    """Every option that compare() takes: a list of dicts with name, kind, group, choices, default and help."""
    return option_rows()


def status():
    """Which back ends there are, and why one is missing."""
    return _core.status()
