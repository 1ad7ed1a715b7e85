"""States from what other libraries hold: MDAnalysis' and ProDy's atoms."""

import os

from ._core import InputError, State


def state_of(given, role="state"):
    """The State of a path, a State, or an AtomGroup of MDAnalysis or ProDy.

    Raises InputError naming `role` for anything else.
    """
    if isinstance(given, State):
        return given
    if isinstance(given, (str, os.PathLike)):
        return State.read(os.fspath(given))
    if hasattr(given, "universe") and hasattr(given, "atoms"):
        return _from_mdanalysis(given.atoms, role)
    if hasattr(given, "getCoords") and hasattr(given, "getNames"):
        return _from_prody(given, role)
    raise InputError(
        f"{role}: a {type(given).__name__} is no molecule; give a path, an espdiff.State, or an AtomGroup of "
        "MDAnalysis or ProDy"
    )


def _texts(values):
    return [str(value) for value in values]


def _labels(atoms):
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


def _state_of_atoms(atoms, name):
    radii = atoms.radii if hasattr(atoms, "radii") else None
    charges = atoms.charges if hasattr(atoms, "charges") else None
    return State.from_arrays(
        atoms.positions, radii, charges, cell=atoms.universe.dimensions, name=name, **_labels(atoms)
    )


def _from_mdanalysis(atoms, role):
    universe = atoms.universe
    if len(atoms) == 0:
        raise InputError(f"{role}: the AtomGroup is empty")
    name = str(getattr(universe, "filename", None) or "universe")
    frame = getattr(universe.trajectory, "frame", 0)
    if universe.trajectory.n_frames > 1:
        name += f", frame {frame}"
    state = _state_of_atoms(atoms, name)
    # Water and ions outside the group count for pme in the universe's cell.
    if universe.dimensions is not None and len(atoms) < len(universe.atoms) and hasattr(universe.atoms, "charges"):
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
