// python_start.cpp: the interpreter by the program's first line, and what it runs before the program.
#include "system/python_start.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace espdiff {
namespace {

// Asked for anything that is not known here, a module is loaded. Of pkg_resources PROPKA asks for paths of files beside
// its modules only. For vectors of three NumPy takes longer to find out what they are than to compute: a fifth of
// PDB2PQR's time, half of it for distances; the steps are NumPy's, and so are the bits. Definitions of residues are
// copied for each of their patches, by pickle in a tenth of the time. Angles of hydrogen bonds are computed without
// copies of vectors, and the rotations that diagonalize a matrix of 4 x 4 are written out element by element: the same
// steps, and the same bits.
constexpr const char* kStart = R"(
import importlib.machinery, importlib.util, os, sys, types, urllib
del sys.argv[0]
sys.path[0] = os.path.dirname(os.path.realpath(sys.argv[0]))
def load_when_used(name, **known):
    package, _, last = name.rpartition('.')
    parent = importlib.machinery.PathFinder.find_spec(package) if package else None
    if package and parent is None:
        return
    spec = importlib.machinery.PathFinder.find_spec(name, parent and parent.submodule_search_locations)
    if spec is None:
        return
    module = types.ModuleType(name)
    def load(attribute):
        if sys.modules.get(name) is module:
            del sys.modules[name]
        return getattr(importlib.import_module(name), attribute)
    module.__dict__.update(known, __spec__=spec, __path__=spec.submodule_search_locations, __getattr__=load)
    sys.modules[name] = module
    if package in sys.modules:  # a package that is loaded later does it
        setattr(sys.modules[package], last, module)
for name in 'requests', 'urllib.request', 'numpy.fft', 'numpy.ma', 'numpy.polynomial', 'numpy.random':
    load_when_used(name)
load_when_used('pkg_resources', resource_filename=lambda package, name: os.path.join(
    os.path.dirname(sys.modules[package].__file__), name))
def shorten_vectors():
    import numpy
    any_norm, any_cross = numpy.linalg.norm, numpy.cross
    def is_vector(x, n):
        return type(x) is numpy.ndarray and x.dtype == float and x.ndim == 1 and (n is None or x.size == n)
    def norm(x, *how, **more):
        if how or more or not is_vector(x, None):
            return any_norm(x, *how, **more)
        return numpy.sqrt(x.dot(x))
    def cross(a, b, *how, **more):
        if how or more or not (is_vector(a, 3) and is_vector(b, 3)):
            return any_cross(a, b, *how, **more)
        (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
        return numpy.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])
    numpy.linalg.norm, numpy.cross = norm, cross
def shorten_distances():
    import math
    try:
        from pdb2pqr import utilities
    except ImportError:  # of another version; what it needs itself it reports itself
        return
    def distance(coords1, coords2):
        x, y, z = coords1
        u, v, w = coords2
        x, y, z = x - u, y - v, z - w
        return math.sqrt(x * x + y * y + z * z)
    utilities.distance = distance
def shorten_copies():
    import copy, pickle
    try:
        from pdb2pqr import definitions
    except ImportError:
        return
    copies = types.ModuleType('copy')
    copies.__dict__.update(copy.__dict__, deepcopy=lambda thing: pickle.loads(pickle.dumps(thing, -1)))
    definitions.copy = copies
def has_parameters(owner, name, *parameters):
    code = getattr(getattr(owner, name, None), '__code__', None)
    return code is not None and code.co_varnames[:code.co_argcount] == parameters
def shorten_angles():
    import math, numpy
    try:
        from pdb2pqr.hydrogens.optimize import Optimize
    except ImportError:
        return
    if not has_parameters(Optimize, 'get_hbond_angle', 'atom1', 'atom2', 'atom3'):
        return
    acos, array, pi, sqrt = math.acos, numpy.array, math.pi, math.sqrt
    def angle(first, vertex, last):
        x, y, z = vertex.coords
        u, v, w = last.coords
        a = array((u - x, v - y, w - z))
        u, v, w = first.coords
        b = array((u - x, v - y, w - z))
        cosine = (a / sqrt(a.dot(a))).dot(b / sqrt(b.dot(b)))
        return acos(1.0 if cosine > 1 else -1.0 if cosine < -1 else cosine) * 180.0 / pi
    Optimize.get_hbond_angle = staticmethod(angle)
def shorten_rotations():
    import math
    try:
        from pdb2pqr import quatfit
    except ImportError:
        return
    if not has_parameters(quatfit, 'jacobi', 'amat', 'nrot'):
        return
    four = range(4)
    def a(i, j):
        return 'a%d%d' % (min(i, j), max(i, j))
    lines = ['def diagonalized(matrix, most):']
    for i in four:
        lines += [' a%d%d = matrix[%d][%d]' % (i, j, i, j) for j in range(i, 4)] + [' d%d = a%d%d' % (i, i, i)]
        lines += [' v%d%d = %d.0' % (i, j, i == j) for j in four]
    pairs = [(i, j) for j in four for i in range(j)]
    lines += [' for _ in range(most):', '  size = ' + ' + '.join('abs(d%d)' % i for i in four),
              '  if size != 0 and (' + ' + '.join('abs(%s)' % a(*pair) for pair in pairs) + ') / size <= 1e-12: break']
    for i, j in pairs:
        lines += ['  e = ' + a(i, j), '  if abs(e) > 0:', '   m = d%d - d%d' % (j, i),
                  '   if abs(m) + abs(e) <= abs(m): t = e / m', '   else:', '    q = 0.5 * m / e',
                  '    t = 1.0 / (abs(q) + sqrt(1 + q * q))', '    if q < 0: t = -t',
                  '   c = 1.0 / sqrt(t * t + 1)', '   s = t * c', '   %s = 0.0' % a(i, j)]
        turned = [(a(k, i), a(k, j)) for k in four if k not in (i, j)] + [('v%d%d' % (k, i), 'v%d%d' % (k, j)) for k in four]
        lines += ['   {0}, {1} = c * {0} - s * {1}, s * {0} + c * {1}'.format(*two) for two in turned]
        lines += ['   x, y, z = c * c, s * s, 2.0 * c * s * e',
                  '   d{0}, d{1} = x * d{0} + y * d{1} - z, y * d{0} + x * d{1} + z'.format(i, j)]
    lines += [' return [d0, d1, d2, d3], [' + ', '.join('[v%d0, v%d1, v%d2, v%d3]' % ((k,) * 4) for k in four) + ']']
    space = {'sqrt': math.sqrt}
    exec('\n'.join(lines), space)
    def jacobi(amat, nrot):
        values, vectors = space['diagonalized'](amat, nrot)
        order = [0, 1, 2, 3]
        for place in range(3):
            least = min(range(place, 4), key=lambda k: values[order[k]])
            order[place], order[least] = order[least], order[place]
        return [values[k] for k in order], [[row[k] for k in order] for row in vectors]
    quatfit.jacobi = jacobi
if importlib.util.find_spec('pdb2pqr') and importlib.util.find_spec('numpy'):
    shorten_vectors()
    shorten_distances()
    shorten_copies()
    shorten_angles()
    shorten_rotations()
with open(sys.argv[0], 'rb') as program:
    code = compile(program.read(), sys.argv[0], 'exec')
exec(code, {'__name__': '__main__', '__file__': sys.argv[0]})
)";

/// The words behind "#!"; none where the file does not begin with it.
std::vector<std::string> interpreter_of(const std::string& program) {
  constexpr std::size_t kLongest = 256;  // Linux reads no more
  std::string head(kLongest, '\0');
  std::ifstream file(program, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  head.resize(std::min(head.find('\n'), head.size()));
  std::vector<std::string> words;
  if (head.compare(0, 2, "#!") != 0) return words;
  std::istringstream line(head.substr(2));
  for (std::string word; line >> word;) words.push_back(word);
  return words;
}

}  // namespace

std::vector<std::string> words_to_start(const std::string& program) {
  std::vector<std::string> words = interpreter_of(program);
  const bool is_python = std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word.compare(word.find_last_of('/') + 1, 6, "python") == 0;
  });
  if (!is_python) return {program};
  words.insert(words.end(), {"-c", kStart, program});
  return words;
}

}  // namespace espdiff
