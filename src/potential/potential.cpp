// potential.cpp: methods, cells and grids of potentials: read from text, around atoms, from lengths and angles.
#include "potential/potential.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/formatted.h"
#include "base/vector.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

std::vector<double> numbers_in(const std::string& text, const std::string& what) {
  std::string plain = text;
  for (char& c : plain) {
    if (c == '{' || c == '}' || c == ',' || c == '"') c = ' ';
  }
  std::vector<double> numbers;
  for (const std::string_view word : split_words(plain)) {
    double value = 0;
    if (!parse_number(word, value)) throw InputError(what + " has " + in_quotes(word) + ", which is not a number");
    numbers.push_back(value);
  }
  return numbers;
}

/// The least number >= n whose prime factors are 2, 3, 5 and 7: fast transforms.
int next_smooth(int n) {
  for (;; ++n) {
    int rest = n;
    for (const int factor : {2, 3, 5, 7}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return n;
  }
}

struct Box {
  Vec3d low, high;
};

Box box_around(const std::vector<Vec3d>& positions) {
  if (positions.empty()) throw InputError("a cell around no atoms; select some");
  Box box{positions.front(), positions.front()};
  for (const Vec3d& p : positions) {
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], p[axis]);
      box.high[axis] = std::max(box.high[axis], p[axis]);
    }
  }
  return box;
}

/// The numbers of points in PMEPot's list.
constexpr int kPmepotSizes[] = {8,   10,  12,  16,  20,  24,  30,  32,  36,  40,  48,  50,  56,  60,  64,  72,
                                80,  84,  88,  96,  100, 108, 112, 120, 128, 144, 160, 168, 176, 192, 200, 216,
                                224, 240, 256, 264, 288, 300, 324, 336, 360, 384, 400, 432, 448, 480, 512};

int pmepot_size(double wanted) {
  for (const int n : kPmepotSizes) {
    if (n >= wanted) return n;
  }
  return *std::prev(std::end(kPmepotSizes));
}

}  // namespace

PotentialMethod parse_potential_method(const std::string& text) {
  if (text == "pme") return PotentialMethod::kPme;
  if (text == "coulomb") return PotentialMethod::kCoulomb;
  if (text == "pb") return PotentialMethod::kPoissonBoltzmann;
  throw InputError("unknown potential '" + text + "'; use pb, pme or coulomb");
}

int usual_order(bool compatible) {
  constexpr int kPmepotOrder = 4;
  return compatible ? kPmepotOrder : PmeOptions().order;
}

void require_charges(const Molecule& molecule) {
  const bool any = std::any_of(molecule.charges.begin(), molecule.charges.end(), [](float q) { return q != 0; });
  if (any) return;
  throw InputError(
      molecule.name + ": " + (molecule.charges.empty() ? "has no charges" : "every atom has charge 0") +
      ", and a potential needs them; give a PQR file (from PDB2PQR, or VMD's writepqr), or in VMD load the "
      "topology that has them (PSF, prmtop)");
}

GridChoice parse_grid_choice(const std::string& text) {
  const std::string accepted =
      "; give three numbers of points, one number of points from 8 on, or a resolution below 8 A";
  const std::vector<double> numbers = numbers_in(text, "the grid '" + text + "'");
  constexpr double kLeastPoints = 8;
  GridChoice choice;
  if (numbers.size() == 1 && numbers[0] < kLeastPoints) {
    if (!(numbers[0] > 0)) throw InputError("the grid's resolution '" + text + "' is not above 0" + accepted);
    choice.resolution_A = numbers[0];
    return choice;
  }
  if (numbers.size() != 1 && numbers.size() != 3)
    throw InputError("the grid '" + text + "' has " + std::to_string(numbers.size()) + " numbers" + accepted);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double n = numbers[numbers.size() == 1 ? 0 : axis];
    constexpr double kMost = 1e6;
    if (n != std::floor(n) || n < 1 || n > kMost)
      throw InputError("the grid '" + text + "' has a number of points that is not a whole positive one" + accepted);
    choice.size[axis] = static_cast<int>(n);
  }
  return choice;
}

PmeCell parse_cell(const std::string& text) {
  const std::vector<double> n = numbers_in(text, "the cell '" + text + "'");
  if (n.size() != 12)
    throw InputError("the cell '" + text + "' has " + std::to_string(n.size()) +
                     " numbers; give twelve in Angstrom: centre and three edges, '{{ox oy oz} {ax ay az} {bx by bz} "
                     "{cx cy cz}}'");
  return {{n[0], n[1], n[2]}, {{{n[3], n[4], n[5]}, {n[6], n[7], n[8]}, {n[9], n[10], n[11]}}}};
}

Vec3d middle_of(const std::vector<Vec3d>& positions) {
  const Box box = box_around(positions);
  return 0.5 * (box.low + box.high);
}

PmeCell padded_cell(const std::vector<Vec3d>& positions, double pad_A) {
  if (!(pad_A >= 0) || !std::isfinite(pad_A))
    throw InputError("a padding of " + formatted(pad_A) + " A is negative; 10 is usual");
  const Box box = box_around(positions);
  const Vec3d side = box.high - box.low;
  const double pads = 2 * pad_A;
  return {0.5 * (box.low + box.high),
          {Vec3d{side.x + pads, 0, 0}, Vec3d{0, side.y + pads, 0}, Vec3d{0, 0, side.z + pads}}};
}

PmeCell cell_from(const UnitCell& cell, Vec3d centre) { return {centre, edges_of(cell)}; }

PmeCell choose_cell(const PotentialOptions& options, const std::vector<Vec3d>& positions,
                    const std::optional<UnitCell>& own_cell) {
  constexpr double kUsualPad_A = 10;
  if (options.cell) return *options.cell;
  if (own_cell && !options.pad_A) return cell_from(*own_cell, middle_of(positions));
  return padded_cell(positions, options.pad_A.value_or(kUsualPad_A));
}

std::array<int, 3> choose_grid_size(const PmeCell& cell, const GridChoice& choice, bool compatible) {
  if (choice.size[0] != 0) return choice.size;
  if (!(choice.resolution_A > 0) || !std::isfinite(choice.resolution_A))
    throw InputError("a grid resolution of " + formatted(choice.resolution_A) + " A is not above 0; 1 is usual");
  std::array<int, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double wanted = norm(cell.edges[axis]) / choice.resolution_A;
    constexpr double kMost = 1e6;  // the engine names its own limit
    constexpr double kSlack = 1e-9;
    const int least = std::isfinite(wanted) ? static_cast<int>(std::ceil(std::min(wanted, kMost) - kSlack)) : 0;
    size[axis] = compatible ? pmepot_size(wanted) : next_smooth(std::max(least, kPmepotSizes[0]));
  }
  return size;
}

}  // namespace espdiff
