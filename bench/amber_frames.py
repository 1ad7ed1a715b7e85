"""amber_frames.py: frames of an Amber topology (prmtop) and a DCD file as PQR files with their cell, for the studies."""

import math
import struct


def read_topology(path):
    """Lists by their flag: texts as they stand, numbers as floats."""
    sections, width = {}, 0
    for line in path.read_text(encoding="ascii").splitlines():
        if line.startswith("%FLAG"):
            section = sections.setdefault(line.split()[1], [])
        elif line.startswith("%FORMAT"):
            form = line[line.index("(") + 1:line.index(")")]
            is_text = "a" in form
            width = int(form.replace("a", " ").replace("I", " ").replace("E", " ").split()[1].split(".")[0])
        elif not line.startswith("%"):
            words = (line[i:i + width].strip() for i in range(0, len(line.rstrip("\n")), width))
            section.extend(words if is_text else (float(word) for word in words if word))
    return sections


def read_frames(path):
    """(cell lengths and angles, x, y, z) of each frame of a little-endian DCD file with unit cells."""
    content, at = path.read_bytes(), 0

    def record():
        nonlocal at
        size = struct.unpack_from("<i", content, at)[0]
        at += size + 8
        return content[at - size - 4:at - 4]

    record(), record()
    n_atoms = struct.unpack("<i", record())[0]
    while at < len(content):
        # a, gamma, b, beta, alpha, c; angles in degrees or as cosines
        a, gamma, b, beta, alpha, c = struct.unpack("<6d", record())
        yield [a, b, c, alpha, beta, gamma], *(struct.unpack(f"<{n_atoms}f", record()) for _ in range(3))


BONDI_RADII = {"H": 1.2, "C": 1.7, "N": 1.55, "O": 1.52, "S": 1.8}


def degrees(value):
    return value if abs(value) > 1 else math.degrees(math.acos(value))


def write_pqr(topology, frame, path, most_residues=None):
    """Atoms with charges and radii (Bondi's where the topology has none), and the cell as a CRYST1 record.

    most_residues: leaves out what follows; None takes all."""
    (a, b, c, alpha, beta, gamma), x, y, z = frame
    residue_of = {int(first): i for i, first in enumerate(topology["RESIDUE_POINTER"])}
    lines = [f"CRYST1{a:9.3f}{b:9.3f}{c:9.3f}{degrees(alpha):7.2f}{degrees(beta):7.2f}{degrees(gamma):7.2f} P 1           1"]
    residue = -1
    for i, name in enumerate(topology["ATOM_NAME"][:len(x)]):
        residue = residue_of.get(i + 1, residue)
        if most_residues is not None and residue >= most_residues:
            break
        charge = topology["CHARGE"][i] / 18.2223
        radius = topology["RADII"][i] if "RADII" in topology else BONDI_RADII.get(name[0], 1.7)
        lines.append(f"ATOM {i + 1} {name} {topology['RESIDUE_LABEL'][residue]} {residue + 1} {x[i]:.4f} {y[i]:.4f} {z[i]:.4f} {charge:.5f} {radius:.4f}")
    path.write_text("\n".join(lines) + "\nEND\n", encoding="ascii")
