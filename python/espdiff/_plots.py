"""Pictures of results: Matplotlib's and PyVista's."""

import numpy as np


def polydata(positions, triangles, arrays):
    """A surface as a pyvista.PolyData with arrays at its vertices.

    All are copies: VTK would write through a view of the engine's memory, and keep the result alive in every window.
    """
    import pyvista

    triangles = np.asarray(triangles)
    faces = np.hstack([np.full((len(triangles), 1), 3, dtype=np.int64), triangles.astype(np.int64)])
    mesh = pyvista.PolyData(np.array(positions), faces.ravel())
    for name, values in arrays.items():
        mesh.point_data[name] = np.array(values)
    return mesh


def plot_ensemble(result, ax=None, top=None):
    """Each residue's difference between the groups with its interval; filled where it is significant."""
    import matplotlib.pyplot as plt

    columns = result.residue_columns()
    labels = np.array(columns["residue"])
    groups = list(result.means)
    if ax is None:
        _, ax = plt.subplots(figsize=(8, 3), layout="constrained")
    compares = "difference" in columns
    values = np.asarray(columns["difference" if compares else f"mean_{groups[0]}"])
    chosen = np.flatnonzero(np.isfinite(values))
    if top is not None:
        chosen = np.sort(chosen[np.argsort(-np.abs(values[chosen]), kind="stable")[:top]])
    at = np.arange(len(chosen))
    if compares:
        low, high = (np.asarray(columns[name])[chosen] for name in ("low", "high"))
        significant = np.asarray(columns["p_false_discovery"])[chosen] <= result.to_dict()["options"]["alpha"]
        ax.vlines(at, low, high, color="#999999", linewidth=1.5)
        for shown, face in ((significant, "#d55e00"), (~significant, "white")):
            ax.plot(at[shown], values[chosen][shown], "o", color="#d55e00", markerfacecolor=face, markersize=5)
        ax.set_ylabel(f"{groups[1]} - {groups[0]} (kT/e)")
    else:
        ax.bar(at, values[chosen], width=0.9, color="#d55e00")
        ax.set_ylabel(f"mean of {groups[0]} (kT/e)")
    ax.axhline(0, color="black", linewidth=0.6)
    ax.set_xticks(at, labels[chosen], rotation=90, fontsize=7)
    ax.margins(x=0.02)
    return ax


def residue_labels(columns):
    """A:LYS33, of residue columns."""
    return np.array([f"{chain}{':' if chain else ''}{name}{number}{code}" for chain, name, number, code in zip(
        columns["chain"], columns["name"], columns["number"], columns["insertion_code"])])


def plot_residues(result, quantity, ax=None, top=None):
    """A quantity of the residues as bars."""
    import matplotlib.pyplot as plt

    from ._core import InputError, metrics

    columns = result.residue_columns()
    known = {row["name"]: row for row in metrics()}
    shown = [name for name in columns if name in known]
    if quantity not in shown:
        raise InputError(f"quantity: there is no {quantity!r}; there are {', '.join(shown)}")
    values, labels = np.asarray(columns[quantity]), residue_labels(columns)
    if top is not None:
        order = np.argsort(-np.nan_to_num(np.abs(values)), kind="stable")[:top]
        values, labels = values[order], labels[order]
    if ax is None:
        _, ax = plt.subplots(figsize=(8, 3), layout="constrained")
    ax.bar(np.arange(len(values)), values, width=0.9, color="#d55e00")
    ticks = np.unique(np.linspace(0, max(len(values) - 1, 0), min(len(values), 24)).astype(int))
    ax.set_xticks(ticks, labels[ticks] if len(values) else [], rotation=90, fontsize=7)
    about = known[quantity]
    unit = result.unit if about["unit"] == "potential" else about["unit"]
    ax.set_ylabel(f"{about['label']}{f' ({unit})' if unit else ''}")
    ax.margins(x=0.01)
    return ax
