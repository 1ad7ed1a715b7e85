# Opens a comparison of espdiff in PyMOL 2 or later: pymol FILE.pymol.py
@NOTES@
import os
import struct
import sys

from pymol import cgo, cmd

FOLDER = os.path.dirname(os.path.abspath(globals().get('__script__') or globals().get('__file__') or sys.argv[-1]))
MESH, STRUCTURE = @MESH@, @STRUCTURE@
SCALE = @SCALE@
RESIDUES = @RESIDUES@


@READ_PLY@

def surface(columns, faces):
    """Triangles of PyMOL, with the normals and colours of their corners."""
    has_normals = 'nx' in columns
    drawn = [cgo.BEGIN, cgo.TRIANGLES]
    for face in faces:
        for v in face:
            drawn += [cgo.COLOR] + [columns[name][v] / 255 for name in ('red', 'green', 'blue')]
            if has_normals:
                drawn += [cgo.NORMAL] + [columns[name][v] for name in ('nx', 'ny', 'nz')]
            drawn += [cgo.VERTEX] + [columns[name][v] for name in ('x', 'y', 'z')]
    return drawn + [cgo.END]


def named_colours(prefix, scale):
    names = []
    for i, colour in enumerate(scale['colours']):
        names.append('%s_%d' % (prefix, i))
        cmd.set_color(names[-1], colour)
    return names


columns, faces, counted = read_ply(os.path.join(FOLDER, MESH))
cmd.load_cgo(surface(columns, [face for face, known in zip(faces, counted) if known]), 'difference')
rest = [face for face, known in zip(faces, counted) if not known]
if rest:
    grey = dict(columns, red=[128] * len(columns['x']), green=[128] * len(columns['x']), blue=[128] * len(columns['x']))
    cmd.load_cgo(surface(grey, rest), 'not_counted')
    cmd.set('cgo_transparency', 0.5, 'not_counted')
cmd.load(os.path.join(FOLDER, STRUCTURE), 'residues')
cmd.hide('everything', 'residues')
cmd.show('cartoon', 'residues and polymer')
cmd.show('sticks', 'residues and hetatm')
cmd.color('grey50', 'residues')
cmd.spectrum('b', ' '.join(named_colours('espdiff_residue', RESIDUES)), 'residues and q > 0',
             minimum=RESIDUES['values'][0], maximum=RESIDUES['values'][-1])
cmd.ramp_new('scale', 'none', SCALE['values'], SCALE['colours'])
cmd.orient()
print(SCALE['title'] + ': surface; ' + RESIDUES['title'] + ': residues')
