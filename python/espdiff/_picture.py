"""Pictures of surfaces for notebooks: drawn by NumPy, so that they need neither a display nor another package."""

import base64
import struct
import zlib

import numpy as np

from ._core import automatic_limit, signed_colours

_GREY = np.array([128, 128, 128])


def _rotated(positions, normals, side):
    """Along the principal axes, the longest across the picture; `side` 1 is the front, -1 the back."""
    centred = positions - positions.mean(axis=0)
    axes = np.linalg.svd(centred[:: max(1, len(centred) // 5000)], full_matrices=False)[2]
    axes[2] = np.cross(axes[0], axes[1])
    turn = axes * np.array([[side], [1], [side]])
    return centred @ turn.T, normals @ turn.T


def _samples(corners):
    """Weights of points spread over a triangle, (points, 3), so that each pixel of most triangles has one."""
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    n = int(np.clip(np.ceil(1.6 * np.percentile(edges, 98)), 2, 24))
    return np.array([(i, j, n - i - j) for i in range(n + 1) for j in range(n + 1 - i)], float) / n


def draw(positions, normals, triangles, colours, width, side=1):
    """An RGB picture (height, width, 3) uint8; colours (vertices, 3). White where there is nothing."""
    at, facing = _rotated(np.asarray(positions, float), np.asarray(normals, float), side)
    low, high = at.min(axis=0), at.max(axis=0)
    scale = (width - 8) / (high[0] - low[0])
    height = int(np.ceil((high[1] - low[1]) * scale)) + 8
    light = np.clip(0.45 + 0.55 * np.abs(facing[:, 2]), 0, 1)[:, None]
    depth = np.full(width * height, -np.inf)
    picture = np.full((width * height, 3), 255, np.uint8)
    lit = colours * light
    front = np.asarray(triangles)[facing[np.asarray(triangles)].mean(axis=1)[:, 2] > -0.3]
    weights = _samples(at[front][:, :, :2] * scale)
    for chosen in np.array_split(front, max(1, len(front) // 20000)):
        points = np.einsum("pk,tkc->tpc", weights, at[chosen]).reshape(-1, 3)
        shades = np.einsum("pk,tkc->tpc", weights, lit[chosen]).reshape(-1, 3)
        x = ((points[:, 0] - low[0]) * scale + 4).astype(int)
        y = ((high[1] - points[:, 1]) * scale + 4).astype(int)
        pixel = y * width + x
        order = np.argsort(points[:, 2], kind="stable")  # the nearest is written last
        pixel, shades, z = pixel[order], shades[order], points[order, 2]
        nearest = z >= depth[pixel]
        pixel, shades, z = pixel[nearest], shades[nearest], z[nearest]
        depth[pixel], picture[pixel] = z, shades.astype(np.uint8)
    return picture.reshape(height, width, 3)


def png(picture):
    """A picture as the bytes of a PNG file."""
    height, width, _ = picture.shape
    rows = b"".join(b"\0" + row.tobytes() for row in picture)

    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b"")


def signed(values, limit):
    """Colours of signed values, grey for none."""
    palette = np.array(signed_colours(255))
    place = np.clip((np.nan_to_num(values) / limit + 1) / 2 * 254, 0, 254).round().astype(int)
    return np.where(np.isfinite(values)[:, None], palette[place], _GREY).astype(float)


def of_comparison(result, width=300):
    """The difference from both sides as PNG, and the end of its scale; of shapes the displacement's surface alone."""
    surface = result._core.surface_arrays()
    positions, triangles = surface["positions"], surface["triangles"]
    unmatched = np.asarray(surface["cells"]["no_counterpart"]) != 0
    source = surface["points"]["source_position"], surface["points"]["source_normal"]
    values = np.array(surface["points"]["potential_difference"], float)
    corrupt = np.asarray(surface["cells"]["corrupt"]) != 0
    values[np.unique(np.asarray(triangles)[unmatched | corrupt])] = np.nan  # grey
    limit = automatic_limit(np.asarray(surface["points"]["potential_difference"], np.float32).tolist())
    colours = signed(values, limit)
    # On the source's shape, where every triangle has a place.
    sides = [draw(*source, triangles, colours, width, side) for side in (1, -1)]
    height = max(side.shape[0] for side in sides)
    padded = [np.pad(side, ((0, height - side.shape[0]), (0, 0), (0, 0)), constant_values=255) for side in sides]
    return png(np.concatenate(padded, axis=1)), limit


def scale_png(width=160, height=10):
    """The bar of the colours of signed values."""
    palette = np.array(signed_colours(width), np.uint8)
    return png(np.repeat(palette[None], height, axis=0))


def inline(content):
    return "data:image/png;base64," + base64.b64encode(content).decode()
