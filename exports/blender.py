# Opens a comparison of espdiff in Blender 3.4 or later: blender --python FILE.blender.py
@NOTES@
import math
import os
import struct

import bpy

MESH = @MESH@
SCALE = @SCALE@
UNIT = 0.1  # one Angstrom, in Blender's units


@READ_PLY@

def linear(channel):
    """sRGB, 0 to 255, to linear light (IEC 61966-2-1)."""
    value = channel / 255
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def add_mesh(name, columns, faces):
    points = list(zip(columns['x'], columns['y'], columns['z']))
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(UNIT * x for x in point) for point in points], [], faces)
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    colours = mesh.color_attributes.new('colour', 'FLOAT_COLOR', 'POINT')
    for v in range(len(points)):
        colours.data[v].color = [linear(columns[channel][v]) for channel in ('red', 'green', 'blue')] + [1]
    for array, values in columns.items():
        if array not in ('x', 'y', 'z', 'nx', 'ny', 'nz', 'red', 'green', 'blue'):
            mesh.attributes.new(array, 'FLOAT', 'POINT').data.foreach_set(
                'value', [0 if math.isnan(value) else value for value in values])
    shown = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(shown)
    shown.shape_key_add(name='target')
    source = shown.shape_key_add(name='source')
    for v, point in enumerate(zip(columns['source_x'], columns['source_y'], columns['source_z'])):
        source.data[v].co = [UNIT * x for x in point]
    return shown


def material(name, alpha, attribute=None):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes['Principled BSDF']
    shader.inputs['Roughness'].default_value = 0.8
    shader.inputs['Alpha'].default_value = alpha
    shader.inputs['Base Color'].default_value = (0.2, 0.2, 0.2, 1)
    if attribute:
        node = made.node_tree.nodes.new('ShaderNodeAttribute')
        node.attribute_name = attribute
        made.node_tree.links.new(node.outputs['Color'], shader.inputs['Base Color'])
    return made


def show_all(points):
    """A camera that sees all points, and a light; the cube of Blender's empty scene would hide in the surface."""
    cube = bpy.data.objects.get('Cube')
    if cube and cube.type == 'MESH' and len(cube.data.vertices) == 8:
        bpy.data.objects.remove(cube)
    middle = [UNIT * (min(axis) + max(axis)) / 2 for axis in points]
    radius = max(math.dist(middle, [UNIT * x for x in point]) for point in zip(*points))
    camera = bpy.data.objects.new('espdiff camera', bpy.data.cameras.new('espdiff camera'))
    distance = radius / math.sin(math.atan(0.5 * 9 / 16 * camera.data.sensor_width / camera.data.lens))
    camera.location = (middle[0], middle[1] - distance, middle[2])
    camera.rotation_euler = (math.pi / 2, 0, 0)
    camera.data.clip_end = distance + 2 * radius
    sun = bpy.data.objects.new('espdiff sun', bpy.data.lights.new('espdiff sun', 'SUN'))
    sun.rotation_euler = (math.pi / 3, 0, math.pi / 6)
    sun.data.energy = 3
    for added in (camera, sun):
        bpy.context.scene.collection.objects.link(added)
    bpy.context.scene.camera = camera


folder = os.path.dirname(os.path.abspath(__file__))
columns, faces, counted = read_ply(os.path.join(folder, MESH))
surface = add_mesh('difference', columns, [face for face, known in zip(faces, counted) if known])
surface.data.materials.append(material('difference', 1, 'colour'))
surface['scale'] = SCALE['title']
rest = [face for face, known in zip(faces, counted) if not known]
if rest:
    add_mesh('not counted', columns, rest).data.materials.append(material('not counted', 0.4))
show_all([columns[axis] for axis in 'xyz'])
