// gro.cpp: GROMACS' GRO files as a format of structures.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/molecule/water.h"
#include "io/molecules/molecule_builder.h"
#include "io/structures/structure_format.h"
#include "io/text/column_lines.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

constexpr double kAngstromPerNm = 10;
/// Columns of a line of an atom: number and name of the residue, name and number of the atom, five each; then the
/// coordinates, whose width is the distance of their points.
constexpr std::size_t kWidth = 5, kNumbersAt = 4 * kWidth;

struct GroAtom {
  std::string_view text;
  long line = 0;
  int residue_number = 0;
  std::size_t chain = 0;  ///< this and the next: see set_chains()
  char insertion_code = ' ';

  std::string_view residue_name() const { return trimmed(text.substr(kWidth, kWidth)); }
  std::string_view name() const { return trimmed(text.substr(2 * kWidth, kWidth)); }
};

struct GroModel {
  std::vector<GroAtom> atoms;
  std::optional<UnitCell> cell;
  std::size_t n_chains = 0;
  bool has_fall = false;  ///< numbers fall within a chain
};

/// "A", "B", ...; nothing where there is one chain only, with rising numbers.
std::string chain_name(const GroModel& model, std::size_t chain) {
  return model.n_chains == 1 && !model.has_fall ? std::string() : chain_letter(chain);
}

GroAtom read_names(const std::string& path, std::string_view text, long line) {
  GroAtom atom{text, line};
  long long number = 0;
  if (text.size() < kNumbersAt || !parse_integer(trimmed(text.substr(0, kWidth)), number))
    throw FormatError(path, line,
                      "this line of a GRO file has no residue number in its first five columns: " + in_quotes(text) +
                          "; columns of residue number, residue, atom and atom number, five each, were expected: is "
                          "the number of atoms above them right?");
  atom.residue_number = static_cast<int>(number);
  return atom;
}

Vec3d read_position(const std::string& path, const GroAtom& atom) {
  const std::size_t first = atom.text.find('.', kNumbersAt), second = atom.text.find('.', first + 1);
  const std::size_t width = second == std::string_view::npos ? 0 : second - first;
  Vec3d position;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t begin = kNumbersAt + axis * width;
    const std::string_view word = begin < atom.text.size() ? trimmed(atom.text.substr(begin, width)) : "";
    double number = 0;
    if (width == 0 || begin + width > atom.text.size() || !parse_number(word, number))
      throw FormatError(path, atom.line,
                        std::string(1, "xyz"[axis]) + " coordinate of atom " + in_quotes(atom.name()) + " is " +
                            in_quotes(word) +
                            "; three numbers of nm in columns of one width were expected: write the file again");
    position[static_cast<int>(axis)] = kAngstromPerNm * number;
  }
  return position;
}

/// The atom of a name among those of a residue; null if there is none.
const GroAtom* atom_named(const std::vector<GroAtom>& atoms, std::size_t begin, std::size_t end,
                          std::string_view name) {
  const auto first = atoms.begin() + static_cast<std::ptrdiff_t>(begin),
             last = atoms.begin() + static_cast<std::ptrdiff_t>(end);
  const auto found = std::find_if(first, last, [&](const GroAtom& atom) { return atom.name() == name; });
  return found == last ? nullptr : &*found;
}

/// The end of the residue that begins at an atom. Two residues of one name and number, such as 82 and 82A of an
/// antibody, follow each other without a mark: the second begins with its N.
std::size_t residue_end(const std::vector<GroAtom>& atoms, std::size_t begin) {
  std::size_t end = begin + 1;
  for (; end < atoms.size() && atoms[end].residue_number == atoms[begin].residue_number &&
         atoms[end].residue_name() == atoms[begin].residue_name();
       ++end) {
    if (atoms[end].name() == "N" && atom_named(atoms, begin, end, "N") != nullptr &&
        atom_named(atoms, begin, end, "CA") != nullptr)
      break;
  }
  return end;
}

/// Whether a bond leads from the residue at `before` to that at `begin`.
bool are_bonded(const std::string& path, const std::vector<GroAtom>& atoms, std::size_t before, std::size_t begin,
                std::size_t end) {
  constexpr double kLongest_A = 2.2;
  for (const auto& [last, first] : {std::pair("C", "N"), {"O3'", "P"}}) {
    const GroAtom *const from = atom_named(atoms, before, begin, last), *const to =
                                                                            atom_named(atoms, begin, end, first);
    if (from != nullptr && to != nullptr && norm(read_position(path, *from) - read_position(path, *to)) < kLongest_A)
      return true;
  }
  return false;
}

/// The chains, which the format does not name: where the numbers of residues other than water start over and no bond
/// leads on, another one begins. After 99,999 they start over too. Nor does it have insertion codes: a number that the
/// chain has already gets one.
void set_chains(const std::string& path, GroModel& model) {
  constexpr int kLargest = 99999, kMostCodes = 26;
  std::vector<GroAtom>& atoms = model.atoms;
  std::size_t chain = 0, before = 0;
  std::map<int, int> n_of_number;  // residues of the chain
  int number_before = 0;
  for (std::size_t begin = 0, end = 0; begin < atoms.size(); begin = end) {
    end = residue_end(atoms, begin);
    const int number = atoms[begin].residue_number;
    int n_before = 0;
    if (!is_water_name(atoms[begin].residue_name())) {
      const bool falls = number < number_before && number_before != kLargest;
      const bool is_new = (falls && !are_bonded(path, atoms, before, begin, end)) || n_of_number[number] > kMostCodes;
      if (is_new) {
        ++chain;
        n_of_number.clear();
      } else if (falls) {
        model.has_fall = true;
      }
      n_before = n_of_number[number]++;
      number_before = number;
      before = begin;
    }
    for (std::size_t i = begin; i < end; ++i) {
      atoms[i].chain = chain;
      if (n_before > 0) atoms[i].insertion_code = static_cast<char>('A' + n_before - 1);
    }
  }
  model.n_chains = chain + 1;
}

/// Edges in the order of the format: the diagonal, then a's y and z, b's x and z, c's x and y, which may be left out.
std::optional<UnitCell> read_box(const std::string& path, std::string_view text, long line) {
  std::array<double, 9> box{};
  const std::vector<std::string_view> words = split_words(text);
  bool is_box = words.size() == 3 || words.size() == box.size();
  for (std::size_t i = 0; i < words.size() && is_box; ++i) is_box = parse_number(words[i], box[i]);
  if (!is_box)
    throw FormatError(path, line,
                      "the box of a GRO file is " + in_quotes(text) +
                          "; three or nine numbers of nm were expected: is the number of atoms above right?");
  const Vec3d a = kAngstromPerNm * Vec3d{box[0], box[3], box[4]}, b = kAngstromPerNm * Vec3d{box[5], box[1], box[6]},
              c = kAngstromPerNm * Vec3d{box[7], box[8], box[2]};
  UnitCell cell;
  cell.lengths = {norm(a), norm(b), norm(c)};
  constexpr double kNoEdge_A = 1;
  if (!(std::min({cell.lengths.x, cell.lengths.y, cell.lengths.z}) > kNoEdge_A)) return std::nullopt;
  const auto angle = [](const Vec3d& p, const Vec3d& q) {
    return std::acos(dot(p, q) / (norm(p) * norm(q))) * 180 / 3.14159265358979323846;
  };
  cell.angles = {angle(b, c), angle(a, c), angle(a, b)};
  return cell;
}

class GroModels : public StructureModels {
 public:
  explicit GroModels(FileContent file) : file_(std::move(file)) {
    unify_line_ends(file_.content);
    ColumnLines lines{file_.content};
    while (!lines.only_blanks_follow()) models_.push_back(next_model(lines));
  }

  int n_models() const override { return static_cast<int>(models_.size()); }
  std::optional<UnitCell> unit_cell(int model) const override { return at(model).cell; }

  long line_of(int number, const Residue& residue) const override {
    const GroModel& model = at(number);
    for (const GroAtom& atom : model.atoms) {
      if (atom.residue_number == residue.number && atom.insertion_code == residue.insertion_code &&
          atom.residue_name() == residue.name && chain_name(model, atom.chain) == residue.chain)
        return atom.line;
    }
    return 0;
  }

  Molecule read(const StructureOptions& options) const override {
    if (!options.assembly.empty())
      throw InputError(file_.path + ": is a GRO file, which describes no assemblies; leave " + option("assembly") +
                       " out, or give the PDB or mmCIF entry");
    const GroModel& model = at(options.model);
    MoleculeBuilder builder(file_.path, options);
    builder.reserve(model.atoms.size());
    for (const GroAtom& atom : model.atoms) {
      AtomEntry entry;
      entry.residue_name = atom.residue_name();
      if (!builder.wants(entry.residue_name, false)) continue;
      entry.name = atom.name();
      entry.chain = chain_name(model, atom.chain);
      entry.residue_number = atom.residue_number;
      entry.insertion_code = atom.insertion_code;
      entry.position = read_position(file_.path, atom);
      entry.line = atom.line;
      builder.add(entry);
    }
    return builder.finish();
  }

 private:
  const GroModel& at(int model) const {
    if (model >= 1 && model <= n_models()) return models_[static_cast<std::size_t>(model - 1)];
    throw InputError(file_.path + ": there is no model " + std::to_string(model) + "; the file has " +
                     std::to_string(n_models()));
  }

  /// A title, the number of atoms, their lines, and the box.
  GroModel next_model(ColumnLines& lines) const {
    GroModel model;
    lines.next();
    const std::string_view count = trimmed(lines.next());
    long long n = 0;
    if (!parse_integer(count, n) || n < 0 || n > static_cast<long long>(kMostAtoms))
      throw FormatError(file_.path, lines.number,
                        "the number of atoms in a GRO file is " + in_quotes(count) + "; an integer of at most " +
                            std::to_string(kMostAtoms) + " below the title was expected");
    const auto require_line = [&](long long n_read) {
      if (lines.rest.empty())
        throw FormatError(file_.path, lines.number,
                          "the file ends after " + std::to_string(n_read) + " atoms, and " + std::to_string(n) +
                              " atoms and a box were expected: it seems to be cut; write it again");
    };
    for (long long i = 0; i < n; ++i) {
      require_line(i);
      const std::string_view text = lines.next();
      model.atoms.push_back(read_names(file_.path, text, lines.number));
    }
    require_line(n);
    const std::string_view box = trimmed(lines.next());
    model.cell = read_box(file_.path, box, lines.number);
    set_chains(file_.path, model);
    return model;
  }

  FileContent file_;
  std::vector<GroModel> models_;  // they point into the content
};

}  // namespace

StructureFormat gro_format() {
  return {"GRO", [](std::string_view, FileKind kind) { return kind == FileKind::kGro; },
          [](FileContent file) -> std::unique_ptr<StructureModels> {
            return std::make_unique<GroModels>(std::move(file));
          }};
}

}  // namespace espdiff
