"""States from what other libraries hold: MDAnalysis' and ProDy's atoms; states that go to other processes."""

import copyreg
import os

import numpy as np

from ._core import InputError, State


def state(given):
    """The State of a path, or of a Universe or AtomGroup of MDAnalysis, or ProDy's atoms, as they are now.

    A State is a copy: it stays when the universe moves on to another frame.
    """
    return state_of(given)


def is_atomgroup(given):
    """Whether it is MDAnalysis' AtomGroup, or a ResidueGroup and the like."""
    return hasattr(given, "universe") and hasattr(given, "atoms")


def refuse_the_same_atoms(source, target):
    """An AtomGroup's positions are those of its universe's present frame, however long ago it was selected."""
    if not (is_atomgroup(source) and is_atomgroup(target)) or source.universe is not target.universe:
        return
    if len(source.atoms) == len(target.atoms) and (source.atoms.ix == target.atoms.ix).all():
        frame = getattr(source.universe.trajectory, "frame", 0)
        raise InputError(
            f"target: the AtomGroup has the source's own atoms, and their universe shows frame {frame} alone; keep a frame "
            "before the universe moves on, first = espdiff.state(atoms), and compare first with atoms")


def _rebuild(parts):
    if "path" in parts:
        made = State.read(parts["path"], model=parts["model"], hetero=parts["hetero"], water=parts["water"])
        if made.sha256 != parts["sha256"]:
            raise InputError(f"{parts['path']}: it has changed since the State was made of it; read it again")
    else:
        made = State.from_arrays(**parts["arrays"])
        if "preparation" in parts:
            made = made._with_preparation(parts["preparation"])
    if parts.get("everything") is not None:
        made = made.surrounded_by(State.from_arrays(**parts["everything"]))
    for name, values in parts.get("values", {}).items():
        made = made._with_values(name, values)
    if "map_path" in parts:
        made = made.with_map(parts["map_path"], unit=parts["unit"], array=parts["array"])
    elif "map" in parts:
        made = made.with_map(*parts["map"])
    return made


# States go to workers in other processes by their arrays, or by the path of their file.
copyreg.pickle(State, lambda given: (_rebuild, (given._parts(),)))


def is_universe(given):
    return is_atomgroup(given) and hasattr(given, "trajectory") and hasattr(given, "select_atoms")


def state_of(given, role="state"):
    """The State of a path, a State, a Universe or AtomGroup of MDAnalysis, or atoms of ProDy.

    Of a Universe, as of a file, the water is no part of the molecule; it counts for pme in the universe's cell.
    Raises InputError naming `role` for anything else.
    """
    if isinstance(given, State):
        return given
    if isinstance(given, (str, os.PathLike)):
        return State.read(os.fspath(given))
    if is_universe(given):
        whole = _from_mdanalysis(given.atoms, role)
        made = whole.without_water()
        return made if len(made) == len(whole) else made.surrounded_by(whole)
    if is_atomgroup(given):
        return _from_mdanalysis(given.atoms, role)
    if hasattr(given, "getCoords") and hasattr(given, "getNames"):
        return _from_prody(given, role)
    raise InputError(
        f"{role}: a {type(given).__name__} is no molecule; give a path, an espdiff.State, a Universe or AtomGroup of "
        "MDAnalysis, or atoms of ProDy"
    )


def with_values(given, made, name, values, role="state"):
    """The State `made` of `given`, with the field given:NAME: a number for each atom of `given`; NaN for none."""
    values = np.asarray(values, dtype=np.float32)
    if values.ndim != 1:
        raise InputError(f"fields[{name!r}]: the values of {role} have {values.ndim} axes; give one number for each atom")
    of = None
    if is_atomgroup(given):
        atoms = given.atoms
        if len(values) != len(atoms):
            raise InputError(f"fields[{name!r}]: there are {len(values)} values for the {len(atoms)} atoms of {role}")
        values = values[np.isin(atoms.ix, one_conformation(atoms).ix)]
        if len(values) != len(made):
            of = _from_mdanalysis(atoms, role)  # with the water
    try:
        return made._with_values(name, values.tolist(), of)
    except InputError as error:
        raise InputError(f"{role}: {error}") from None


def _texts(values):
    return [str(value) for value in values]


def labels_of(atoms):
    """Names and residues of MDAnalysis' atoms, as far as the topology has them."""
    labels = {"names": _texts(atoms.names)} if hasattr(atoms, "names") else {}
    if hasattr(atoms, "elements"):
        labels["elements"] = _texts(atoms.elements)
    if hasattr(atoms, "resnames"):
        labels["residue_names"] = _texts(atoms.resnames)
    if hasattr(atoms, "resids"):
        labels["residue_numbers"] = [int(number) for number in atoms.resids]
    # PDB files have chains; PSF and TPR files have segments in their place.
    chains = atoms.chainIDs if hasattr(atoms, "chainIDs") else atoms.segids if hasattr(atoms, "segids") else ()
    labels["chains"] = _texts(chains)
    if hasattr(atoms, "icodes"):
        labels["insertion_codes"] = _texts(atoms.icodes)
    return labels


def one_conformation(atoms):
    """Without alternate locations but those of the largest occupancy of their residue, as files are read."""
    if not hasattr(atoms, "altLocs"):
        return atoms
    places = np.array([str(place).strip() for place in atoms.altLocs])
    several = np.flatnonzero(places != "")
    if len(several) == 0:
        return atoms
    occupancies = getattr(atoms, "occupancies", np.ones(len(atoms)))
    sums = {}
    for i in several:
        of_residue = sums.setdefault(atoms.resindices[i], {})
        of_residue[places[i]] = of_residue.get(places[i], 0.0) + float(occupancies[i])
    best = {residue: max(found, key=found.get) for residue, found in sums.items()}
    keep, names = [], {(atoms.resindices[i], atoms.names[i]) for i in several if places[i] == best[atoms.resindices[i]]}
    for i in range(len(atoms)):
        key = (atoms.resindices[i], atoms.names[i])
        if places[i] == "" or places[i] == best[key[0]]:
            keep.append(i)
        elif key not in names:  # the best conformation lacks this atom
            names.add(key)
            keep.append(i)
    return atoms[keep]


def _state_of_atoms(atoms, name):
    atoms = one_conformation(atoms)
    radii = atoms.radii if hasattr(atoms, "radii") else None
    charges = atoms.charges if hasattr(atoms, "charges") else None
    if radii is None and not hasattr(atoms, "names") and not hasattr(atoms, "elements"):
        raise InputError("radii: the topology has none, and neither names nor elements to take them from; add one, "
                         "universe.add_TopologyAttr('radii', values)")
    # The frame's own array: `atoms.positions` would be a copy.
    return State.from_arrays(
        atoms.universe.trajectory.ts.positions, radii, charges, rows=atoms.ix, cell=atoms.universe.dimensions, name=name,
        **labels_of(atoms))


def _from_mdanalysis(atoms, role):
    universe = atoms.universe
    if len(atoms) == 0:
        raise InputError(f"{role}: the AtomGroup is empty")
    if not hasattr(universe, "trajectory"):
        raise InputError(f"{role}: the universe has no coordinates; load a trajectory or a structure")
    name = str(getattr(universe, "filename", None) or "universe")
    frame = getattr(universe.trajectory, "frame", 0)
    if universe.trajectory.n_frames > 1:
        name += f", frame {frame}"
    try:
        return frame_state(atoms, name)
    except InputError as error:
        raise InputError(f"{role}: {error}") from None


def frame_state(atoms, name, everything=True):
    """The State of an AtomGroup as it is now, with what surrounds it in its universe's cell."""
    universe = atoms.universe
    state = _state_of_atoms(atoms, name)
    # Water and ions outside the group count for pme in the universe's cell.
    outside = universe.dimensions is not None and len(atoms) < len(universe.atoms) and hasattr(universe.atoms, "charges")
    if everything and outside:
        state = state.surrounded_by(_state_of_atoms(universe.atoms, name))
    return state


def _from_prody(atoms, role):
    positions = atoms.getCoords()
    if positions is None or len(positions) == 0:
        raise InputError(f"{role}: the atoms have no coordinates")
    labels = {"names": _texts(atoms.getNames())}
    for key, values in (
        ("elements", atoms.getElements()),
        ("residue_names", atoms.getResnames()),
        ("chains", atoms.getChids()),
        ("insertion_codes", atoms.getIcodes()),
    ):
        if values is not None:
            labels[key] = _texts(values)
    if atoms.getResnums() is not None:
        labels["residue_numbers"] = [int(number) for number in atoms.getResnums()]
    return State.from_arrays(positions, atoms.getRadii(), atoms.getCharges(), name=str(atoms.getTitle()), **labels)
