def read_ply(path):
    """Vertices as a dictionary of columns, faces as triples, and whether each face is counted."""
    with open(path, 'rb') as file:
        names, formats, n_vertices, n_faces, n_counted, line = [], '<', 0, 0, 0, b''
        while line != b'end_header':
            line = file.readline().rstrip()
            words = line.decode('utf-8', 'replace').split(' ')
            if words[:2] == ['comment', 'counted_faces']:
                n_counted = int(words[2])
            elif words[:2] == ['element', 'vertex']:
                n_vertices = int(words[2])
            elif words[:2] == ['element', 'face']:
                n_faces = int(words[2])
            elif words[0] == 'property' and n_faces == 0:
                names.append(words[2])
                formats += {'float': 'f', 'uchar': 'B'}[words[1]]
        size = struct.calcsize(formats)
        rows = list(struct.iter_unpack(formats, file.read(size * n_vertices)))
        faces = list(struct.iter_unpack('<BIII', file.read(13 * n_faces)))
    columns = dict(zip(names, zip(*rows))) if rows else {name: () for name in names}
    return columns, [face[1:] for face in faces], [i < n_counted for i in range(n_faces)]
