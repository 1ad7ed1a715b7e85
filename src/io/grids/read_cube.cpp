// read_cube.cpp: header, atoms and values of Gaussian cube files.
#include "io/grids/read_cube.h"

#include <array>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "base/error.h"
#include "io/grids/grid_checks.h"
#include "io/grids/grid_format.h"
#include "io/grids/read_dx.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

constexpr double kBohrInAngstrom = 0.529177210903;  // CODATA 2018

struct CubeHeader {
  Lattice lattice;
  std::size_t n_atoms = 0;
  std::size_t n_volumes = 1;
  bool lists_orbitals = false;  // a line with the orbitals' numbers follows the atoms
  long counts_line = 0;
  std::string title;  // of another quantity than a potential
};

/// A count and a vector, as in the header's lines 3 to 6; the optional fifth number of line 3 in `extra`.
struct CountAndVector {
  long long count = 0;
  Vec3d vector;
  long long extra = 1;
};

CountAndVector read_count_and_vector(TextCursor& cursor, const char* what) {
  const std::vector<std::string_view> words = split_words(cursor.rest_of_line());
  CountAndVector line;
  bool ok = words.size() >= 4 && parse_integer(words[0], line.count);
  for (std::size_t axis = 0; ok && axis < 3; ++axis) {
    double x = 0;
    ok = parse_number(words[axis + 1], x);
    line.vector[static_cast<int>(axis)] = x;
  }
  if (ok && words.size() > 4) ok = parse_integer(words[4], line.extra);
  if (!ok) cursor.fail(std::string("cube header without ") + what + "; a count and three numbers were expected");
  return line;
}

CubeHeader read_header(TextCursor& cursor, const std::string& path) {
  CubeHeader header;
  for (int line = 0; line < 2; ++line) {  // of comment
    const std::string title = title_of_other_quantity(cursor.rest_of_line());
    if (header.title.empty()) header.title = title;
  }
  const CountAndVector atoms = read_count_and_vector(cursor, "number of atoms and origin");
  header.lists_orbitals = atoms.count < 0;
  header.n_atoms = static_cast<std::size_t>(std::llabs(atoms.count));
  if (!header.lists_orbitals && atoms.extra < 1) cursor.fail("number of values a point is below 1");
  if (!header.lists_orbitals) header.n_volumes = static_cast<std::size_t>(atoms.extra);

  std::array<long long, 3> counts{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const CountAndVector line = read_count_and_vector(cursor, "number of points and grid step");
    counts[axis] = line.count;
    header.lattice.step[axis] = line.vector;
  }
  header.counts_line = cursor.line();
  const bool in_angstrom = counts[0] < 0;
  for (long long& count : counts) {
    if ((count < 0) != in_angstrom)
      cursor.fail("the three counts differ in sign; positive means Bohr, negative Angstrom");
    count = std::llabs(count);
  }
  header.lattice.size = check_counts(counts, path, header.counts_line);
  const double unit = in_angstrom ? 1.0 : kBohrInAngstrom;
  header.lattice.origin = unit * atoms.vector;
  for (Vec3d& step : header.lattice.step) step = unit * step;
  check_axes(header.lattice, path, header.counts_line);
  return header;
}

/// Atoms, then, where told so, the number of orbitals and their numbers.
void skip_to_values(TextCursor& cursor, CubeHeader& header) {
  for (std::size_t atom = 0; atom < header.n_atoms; ++atom) {
    if (cursor.at_end()) cursor.fail("the file ends within its " + std::to_string(header.n_atoms) + " atoms");
    if (split_words(cursor.rest_of_line()).size() != 5) {
      cursor.fail("atom " + std::to_string(atom + 1) + " of " + std::to_string(header.n_atoms) +
                  " does not have five numbers (element, charge, x, y, z)");
    }
  }
  if (!header.lists_orbitals) return;
  const long long n_orbitals = cursor.next_integer("number of orbitals");
  if (n_orbitals < 1 || static_cast<std::size_t>(n_orbitals) > cursor.n_bytes_left()) {
    cursor.fail("number of orbitals is " + std::to_string(n_orbitals) + "; at least 1 was expected");
  }
  for (long long i = 0; i < n_orbitals; ++i) cursor.next_integer("an orbital's number");
  header.n_volumes = static_cast<std::size_t>(n_orbitals);
}

[[noreturn]] void fail_at_value(TextCursor& cursor, std::size_t n_read, std::size_t n_promised) {
  const std::string_view word = cursor.peek_word();
  if (word.empty()) {
    cursor.fail("only " + std::to_string(n_read) + " values were found, but the header promises " +
                std::to_string(n_promised) + "; is the file cut short?");
  }
  cursor.fail("value " + std::to_string(n_read + 1) + " is " + in_quotes(word) + "; a finite number was expected");
}

void read_values(TextCursor& cursor, const CubeHeader& header, Grid& grid) {
  const auto [nx, ny, nz] = grid.lattice.size;
  const std::ptrdiff_t column = nx, row = ny;
  const std::size_t n_promised = grid.values.size() * header.n_volumes;
  std::size_t n_read = 0;
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      for (int k = 0; k < nz; ++k) {
        for (std::size_t volume = 0; volume < header.n_volumes; ++volume, ++n_read) {
          float value = 0;
          if (!cursor.try_column_value(value)) fail_at_value(cursor, n_read, n_promised);
          if (volume == 0) grid.values[static_cast<std::size_t>(i + column * (j + row * k))] = value;
        }
      }
    }
  }
}

}  // namespace

Grid read_cube(const std::string& path, std::string_view text) {
  TextCursor cursor(text, path);
  CubeHeader header = read_header(cursor, path);
  skip_to_values(cursor, header);
  Grid grid;
  grid.name = path;
  grid.lattice = header.lattice;
  grid.contradicting_title = header.title;
  // Both factors are bounded: points by check_counts(), volumes by the file's size or, just below, by division.
  const std::size_t n_points = grid.lattice.n_points();
  const bool absurd = header.n_volumes > cursor.n_bytes_left();
  const std::size_t n_values = absurd ? n_points : n_points * header.n_volumes;
  if (absurd)
    cursor.fail("the header promises " + std::to_string(header.n_volumes) + " volumes; the file is too short for them");
  check_size_promise(n_values, 2 * n_values - 1, cursor.n_bytes_left(), path, header.counts_line);
  allocate_values(grid);
  read_values(cursor, header, grid);
  if (!cursor.at_end()) {
    const std::string_view word = cursor.peek_word();
    cursor.fail("more values than the " + std::to_string(n_values) + " that the header promises, the first " +
                in_quotes(word));
  }
  return grid;
}

GridFormat cube_format() {
  return {"cube", [](std::string_view, FileKind kind) { return kind == FileKind::kCube; },
          [](FileContent file, const GridOptions& /*options*/) {
            unify_line_ends(file.content);
            return read_cube(file.path, file.content);
          }};
}

}  // namespace espdiff
