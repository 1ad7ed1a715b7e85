"""ensemble(): groups of simulations from files or AtomGroups, in one process or in parts."""

from __future__ import annotations

import glob
import hashlib
import os
import tempfile
import typing
import warnings

import numpy as np

from . import _checks, _core
from ._functions import _as_settings, _Progress
from ._inputs import frame_state, is_atomgroup
from ._reports import written
from ._results import EngineResult, frame_of, table_of
from ._signatures import study_defaults, study_texts, takes_options

if typing.TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._options import EnsembleOptions


class Frames:
    """Frames of an AtomGroup, as the engine asks for them, one at a time."""

    def __init__(self, atoms, chosen):
        self._atoms = atoms.atoms
        self.chosen = [int(frame) for frame in chosen]

    def __call__(self, number, everything):
        frame = self.chosen[number]
        self._atoms.universe.trajectory[frame]
        return frame_state(self._atoms, f"frame {frame}", everything)

    def sha256(self):
        """Of the atoms, and of the coordinates and cells of all frames."""
        trajectory = self._atoms.universe.trajectory
        trajectory[self.chosen[0]]
        total = hashlib.sha256(frame_state(self._atoms, "frames", True).sha256.encode())
        for frame in self.chosen:
            step = trajectory[frame]
            total.update(np.ascontiguousarray(step.positions[self._atoms.ix], np.float32))
            total.update(np.asarray(() if step.dimensions is None else step.dimensions, np.float32))
        return total.hexdigest()


def _atomgroup_replicate(group, name, atoms, frames, role, needs_charges):
    if len(atoms) == 0:
        raise _core.InputError(f"{role}: the AtomGroup is empty")
    if needs_charges and not hasattr(atoms, "charges"):
        raise _core.InputError(
            f"{role}: the AtomGroup has no charges; load a topology that has them (PSF, TPR, prmtop), add them, "
            f"universe.add_TopologyAttr('charges', values), or name a PQR file of the same atoms, charges={{{group!r}: ...}}")
    universe = atoms.universe
    if isinstance(frames, str):
        frames = _core.parse_frames(frames, len(universe.trajectory))
    elif isinstance(frames, slice):
        frames = range(len(universe.trajectory))[frames]
    if len(frames) == 0:
        raise _core.InputError(f"{role}: no frame is chosen; the trajectory has {len(universe.trajectory)}")
    read = Frames(atoms, frames)
    return {"group": group, "name": name, "sha256": read.sha256(), "n_frames": len(read.chosen), "read": read,
            "origin": f"{name}: {len(atoms)} atoms of {_file_of(universe.trajectory)}"}


def _file_of(trajectory):
    """A universe forgets the name of its topology on its way to another process; a trajectory does not."""
    return os.path.basename(str(getattr(trajectory, "filename", None) or "")) or "coordinates in memory"


def _members(group, given):
    """[(name or None, replicate)]"""
    if isinstance(given, dict):
        return list(given.items())
    if is_atomgroup(given) or isinstance(given, (str, os.PathLike)):
        given = [given]
    return [(None, replicate) for replicate in _checks.several(f"groups[{group!r}]", given, "replicates")]


def _groups(groups, frames, charges):
    """The groups as the engine takes them: files by their names, AtomGroups by functions that read their frames."""
    made = []
    for group, given in groups.items():
        members = []
        for i, (name, replicate) in enumerate(_members(group, given)):
            role = f"groups[{group!r}][{i if name is None else repr(name)}]"
            if isinstance(replicate, (str, os.PathLike)):
                if name is not None:
                    raise _core.InputError(f"{role}: files name themselves; give a list of them")
                members.append(os.fspath(replicate))
            elif is_atomgroup(replicate):
                members.append(_atomgroup_replicate(group, name or f"{group}_{i + 1}", replicate, frames, role,
                                                    group not in charges))
            else:
                raise _core.InputError(f"{role}: a {type(replicate).__name__} is no replicate; give a path or an AtomGroup")
        _refuse_mixed(group, members)
        made.append((str(group), members))
    return made


def _refuse_mixed(group, members):
    if len({isinstance(member, str) for member in members}) > 1:
        raise _core.InputError(f"groups[{group!r}]: files and AtomGroups do not mix in one group; load the files as universes")
    sizes = {member["origin"].split(": ", 1)[1].split(" ", 1)[0] for member in members if isinstance(member, dict)}
    if len(sizes) > 1:
        raise _core.InputError(
            f"groups[{group!r}]: the AtomGroups are of differing universes, with {' and '.join(sorted(sizes))} atoms; the "
            "replicates of a group have the same atoms")


class Ensemble(EngineResult):
    """The result of ensemble(). Arrays are NumPy's, read-only views of the engine's (see `espdiff._core.Ensemble`)."""

    def __init__(self, core, prefix, folder=None):
        super().__init__(core)
        self._prefix = prefix  # of its files
        self._folder = folder  # which holds them where the user named none

    def __repr__(self):
        return f"<espdiff.Ensemble of {' and '.join(self.means)}, {self.n_frames} frames>"

    @property
    def fields(self):
        """The fields besides the potential, {name: Ensemble}; their family-wise p are over all their surfaces together."""
        return {name: Ensemble(core, f"{self._prefix}.{name}", self._folder) for name, core in self._core.fields.items()}

    @property
    def fixed_patches(self):
        """The patches that `patches=` named, by name: dicts, as in OUT.json."""
        return self.to_dict().get("fixed_patches", {})

    @property
    def patches(self):
        """The significant patches: dicts, as in OUT.json."""
        return self.to_dict().get("patches", [])

    @property
    def residues(self):
        """The table of OUT.residues.csv: a pandas.DataFrame where pandas is installed, otherwise a dict of columns."""
        return table_of(self._core.residue_columns())

    @property
    def frames(self):
        """What each frame is and how it was mapped: a pandas.DataFrame where pandas is installed, otherwise columns."""
        return table_of(self._core.frame_columns())

    def to_frame(self):
        """The table of the residues as a pandas.DataFrame."""
        return frame_of(self._core.residue_columns())

    def _repr_html_(self):
        from ._html import ensemble

        return ensemble(self)

    def report(self, path=None, *, title: str = ""):
        """One page for any browser, without network: the template's surface, patches, replicates, the conclusion.

        Writes it to `path` and returns that; returns the page's text without one. It is made of the result's files.
        """
        return written(_core.report_page(self._prefix, _checks.text("title", title)), path)

    def plot(self, ax=None, top=None):
        """Draws each residue's difference with its interval (Matplotlib); returns the axes. Filled: significant."""
        from ._plots import plot_ensemble

        return plot_ensemble(self, ax, top)

    def to_pyvista(self):
        """The template's surface as a pyvista.PolyData, with the arrays of OUT.vtp that the test has."""
        from ._plots import polydata

        arrays = {f"mean_{group}": values for group, values in self.means.items()}
        if len(self.difference):
            arrays.update({f"{self.to_dict().get('field', {}).get('name', 'potential')}_difference": self.difference})
            arrays.update(standard_error=self.standard_error, p=self.p,
                          p_family_wise=self.p_family_wise, patch=self.patch)
        return polydata(self.positions, self.triangles, {**arrays, "residue_index": self.residue_index})


def _order(output, given):
    """The order of a study; what is not among the rows of its options has another form in Python."""
    frames = given.get("frames", "all")
    rows = {**given, "frames": frames if isinstance(frames, str) else "all"}
    return {
        "charges": {str(group): os.fspath(path) for group, path in (given.get("charges") or {}).items()},
        "maps": {str(group): os.fspath(pattern) for group, pattern in (given.get("maps") or {}).items()},
        "output": output, "options": study_texts("ensemble", rows)}


ORDER = {"charges": None, "maps": None, **study_defaults("ensemble")}


def _check_groups(groups):
    if not isinstance(groups, (dict, str, os.PathLike)):
        raise _core.InputError(
            f'groups: a {type(groups).__name__} has no names; give {{"wild": ["w1.pdb", ...], "mutant": ["m1.pdb", ...]}}, or '
            "the path of a list")


@takes_options(besides=ORDER)
def ensemble(groups=None, *, output=None, progress=None, **options: Unpack[EnsembleOptions]) -> typing.Optional[Ensemble]:
    """Compares two groups of simulations on one template surface: where is the difference more than noise?

    groups: {name: replicates}, two groups, or one to describe it; or the path of a list of them (`espdiff ensemble
    --help`). Replicates are paths (each file one, or a topology and then trajectories of its atoms), or AtomGroups,
    whose universes' frames are taken; a dict names them.
    charges: {group: PQR file}. maps: {group: pattern} of potentials that other programs computed, with %d for the frame
    and {replicate} for the replicate's name, in map_unit where the files give none. frames: of each replicate: "all", "0:5:end", ...; of AtomGroups also a slice, or a list of
    numbers. template: medoid, medoid:GROUP, the
    number of a frame, or a file. patches: {name: selection} chosen beforehand, in fixed_patches of the result.
    check_template, states: see the command.
    regress: "FILE.csv:COLUMN", a value of each replicate, regressed on the surface; to_dict()["regression"] has the answer.
    alpha, control, equilibration, most_missing, permutations, seed: of the statistics.
    output: prefix of OUT.h5 and the results, the bytes of the command line's; with `resume` a run that broke off goes
    on. Without it nothing stays but the result. shard: "2/8" maps a part, for espdiff.merge(); it needs `output`.
    from_file: a complete OUT.h5, of which the statistics alone are computed again: without groups, or with
    its replicates in other ones, {"one": ["wild/1", "wild/2@0:49"], ...}.
    Other options are those of compare().

    Returns an Ensemble, None for a shard. What the design cannot show is a warning.
    """
    if groups is not None:
        _check_groups(groups)
    if hasattr(options.get("fields"), "items"):
        for name, kind in options["fields"].items():
            if not isinstance(kind, str):
                raise _core.InputError(f"fields[{name!r}]: an ensemble takes kinds of fields, such as 'charge', not a "
                                       f"{type(kind).__name__}; write the values of each residue or atom to a table")
    order = {name: value for name, value in options.items() if name in ORDER}
    settings = {name: value for name, value in options.items() if name not in ORDER}
    if output is None and (order.get("shard") or order.get("resume")):
        raise _core.InputError("output: a part of an ensemble, or one to continue, needs files")
    if groups is None and not order.get("from_file"):
        raise _core.InputError('groups: none is given; name one or two, {"wild": ["w1.pdb", ...], "mutant": [...]}')
    folder = tempfile.TemporaryDirectory(prefix="espdiff-") if output is None else None
    made = _order(os.path.join(folder.name, "ensemble") if folder else _checks.prefix("output", output), order)
    universes = {atoms.universe for name, members in (groups.items() if isinstance(groups, dict) else ())
                 for _, atoms in _members(name, members) if is_atomgroup(atoms)}
    before = [(universe.trajectory, universe.trajectory.frame) for universe in universes]
    given = []
    try:
        if isinstance(groups, (str, os.PathLike)):
            made["list"] = os.fspath(groups)
        elif groups is not None:
            given = _groups(groups, order.get("frames", "all"), made["charges"])
        with _Progress(progress, "ensemble") as listener:
            core = _core.ensemble(given, made, _as_settings(settings), listener)
    finally:
        for trajectory, frame in before:
            trajectory[frame]
    if core is None:
        return None
    for text in core.design_warnings:
        warnings.warn(text, stacklevel=3)
    return Ensemble(core, made["output"], folder)


def _part(task):
    groups, options = task
    ensemble(groups, **options)


def ensemble_in_parts(apply, n_parts, groups, output, *, resume=False, overwrite=False, **options):
    """ensemble() by several processes: apply(function, tasks) runs them; the bytes are those of one process.

    output: in a folder that all of them see.
    """
    for name in ("shard", "check_template", "from_file"):
        if options.get(name):
            raise _core.InputError(f"{name}: an ensemble in parts does without; leave it out")
    prefix = os.path.abspath(output)
    if os.path.exists(prefix + ".h5") and not (resume or overwrite):
        raise _core.InputError(f"output: {prefix}.h5 exists; set overwrite=True, or name another prefix")
    if n_parts > 1 and not (resume and os.path.exists(prefix + ".h5")):
        mapping = {**options, "output": prefix, "resume": resume, "overwrite": overwrite, "progress": None}
        apply(_part, [(groups, {**mapping, "shard": f"{i + 1}/{n_parts}"}) for i in range(n_parts)])
        first = f".shard-1-of-{n_parts}.h5"  # the run's, then those of its fields
        for stem in sorted(path[:-len(first)] for path in [prefix + first, *glob.glob(glob.escape(prefix) + ".*" + first)]):
            parts = [f"{stem}.shard-{i + 1}-of-{n_parts}.h5" for i in range(n_parts)]
            _core.merge_ensemble(parts, stem, overwrite, None)
            for path in parts:
                os.remove(path)
        resume, overwrite = True, False
    return ensemble(groups, output=prefix, resume=resume, overwrite=overwrite, **options)
