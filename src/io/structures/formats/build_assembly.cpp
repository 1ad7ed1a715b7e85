// build_assembly.cpp: checks of an assembly's size, before gemmi makes it.
#include "io/structures/formats/build_assembly.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <gemmi/assembly.hpp>  // for make_assembly
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/formatted.h"
#include "base/memory.h"
#include "io/molecules/molecule_builder.h"
#include "io/structures/call_gemmi.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

/// Of all assemblies that a file describes; a virus has some hundred.
constexpr long long kMostOperations = 10'000;

/// The operations in an expression such as "1,2", "(1-60)" or "(1-60)(61-88)", as gemmi lists them; nothing where a
/// range is not of two numbers.
std::optional<long long> count_operations(std::string_view expression) {
  long long n = 0;
  while (!expression.empty()) {
    const std::size_t end = std::min(expression.find_first_of(",()"), expression.size());
    const std::string_view word = trimmed(expression.substr(0, end));
    expression.remove_prefix(std::min(end + 1, expression.size()));
    if (word.empty()) continue;
    ++n;
    const std::size_t minus = word.find('-');
    if (minus == std::string_view::npos) continue;
    constexpr long long kLargest = 1'000'000'000;
    long long first = 0, last = 0;
    if (!parse_integer(word.substr(0, minus), first) || !parse_integer(word.substr(minus + 1), last)) return {};
    if (first < 0 || last < first || last > kLargest) return {};
    n += last - first;
  }
  return n;
}

/// Atoms of the chains that a generator copies.
std::size_t n_atoms_of(const gemmi::Assembly::Gen& generator, const gemmi::Model& model) {
  const std::set<std::string> chains(generator.chains.begin(), generator.chains.end());
  const std::set<std::string> subchains(generator.subchains.begin(), generator.subchains.end());
  std::size_t n = 0;
  for (const gemmi::Chain& chain : model.chains) {
    const bool is_whole = chains.count(chain.name) > 0;
    for (const gemmi::Residue& residue : chain.residues) {
      if (is_whole || subchains.count(residue.subchain) > 0) n += residue.atoms.size();
    }
  }
  return n;
}

void check_size(const std::string& path, const gemmi::Assembly& assembly, const gemmi::Model& model) {
  double n = 0;
  for (const gemmi::Assembly::Gen& generator : assembly.generators)
    n += static_cast<double>(generator.operators.size()) * static_cast<double>(n_atoms_of(generator, model));
  if (n <= static_cast<double>(kMostAtoms)) return;
  throw InputError(path + ": assembly " + in_quotes(assembly.name) + " has " +
                   std::to_string(static_cast<long long>(n)) + " atoms, and at most " + std::to_string(kMostAtoms) +
                   " are read; give a smaller assembly");
}

/// gemmi leaves out operations that it does not find.
void check_number(const std::string& path, const gemmi::Assembly& assembly, std::size_t n_named) {
  std::size_t n_found = 0;
  for (const gemmi::Assembly::Gen& generator : assembly.generators) n_found += generator.operators.size();
  if (n_found == n_named && n_found > 0) return;
  throw InputError(path + ": assembly " + in_quotes(assembly.name) + " has " + std::to_string(n_named) +
                   " operations, and " + std::to_string(n_found) +
                   " are described with the chains that they apply to (REMARK 350, _pdbx_struct_assembly_gen, "
                   "_pdbx_struct_oper_list)");
}

/// A rotation, to the digits that files have, and a shift.
bool is_rigid(const gemmi::Transform& transform) {
  constexpr double kRounding = 0.01, kFarthest_A = 1e6;
  const gemmi::Mat33 product = transform.mat.multiply(transform.mat.transpose());
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (!(std::fabs(product[row][column] - (row == column ? 1 : 0)) <= kRounding)) return false;
    }
    if (!(std::fabs(transform.vec.at(row)) <= kFarthest_A)) return false;
  }
  return transform.mat.determinant() > 0;
}

void check_rigid(const std::string& path, const gemmi::Assembly& assembly) {
  for (const gemmi::Assembly::Gen& generator : assembly.generators) {
    for (const gemmi::Assembly::Operator& operation : generator.operators) {
      if (!is_rigid(operation.transform))
        throw InputError(path + ": operation " + in_quotes(operation.name) + " of assembly " +
                         in_quotes(assembly.name) + " is not a rotation with a shift of at most 10^6 Angstrom");
    }
  }
}

/// gemmi looks for copies of an atom at one place by a grid over the whole box.
void check_extent(const std::string& path, const std::string& name, const gemmi::Model& model) {
  gemmi::Box<gemmi::Position> box;
  std::size_t n_atoms = 0;
  for (const gemmi::const_CRA& at : model.all()) {
    const gemmi::Position& p = at.atom->pos;
    if (!std::isfinite(p.x + p.y + p.z))
      throw InputError(path + ": an atom of assembly " + in_quotes(name) + " has a coordinate that is not finite");
    box.extend(p);
    ++n_atoms;
  }
  if (n_atoms == 0) throw InputError(path + ": assembly " + in_quotes(name) + " has no atoms: none are in its chains");
  constexpr double kCell_A = 4, kMargins_A = 12, kCells = 2e6, kCellsOfAtom = 1000, kBytesOfCell = 24;
  const gemmi::Position size = box.get_size();
  double n_cells = 1;
  for (const double extent : {size.x, size.y, size.z}) n_cells *= (extent + kMargins_A) / kCell_A;
  if (n_cells > kCells + kCellsOfAtom * static_cast<double>(n_atoms))
    throw InputError(path + ": assembly " + in_quotes(name) +
                     formatted(" spans %.6g x %.6g x %.6g Angstrom with %zu atoms; its operations cannot be right",
                               size.x, size.y, size.z, n_atoms));
  require_memory(kBytesOfCell * n_cells, path);
}

}  // namespace

std::size_t check_biomt(const std::string& path, std::string_view remarks, const std::string& assembly) {
  std::size_t n = 0;
  bool is_found = false, is_inside = false;
  int n_rows = 0;
  const auto refuse = [&](std::string_view line) {
    throw InputError(path + ": the operations of assembly " + in_quotes(assembly) + " have " +
                     (line.empty() ? "an incomplete last one" : "the line " + in_quotes(std::string(line))) +
                     "; rows BIOMT1, BIOMT2 and BIOMT3 of numbers in their columns were expected");
  };
  while (!remarks.empty()) {
    const std::size_t end = std::min(remarks.find('\n'), remarks.size());
    const std::string_view line = trimmed(remarks.substr(0, end));
    remarks.remove_prefix(std::min(end + 1, remarks.size()));
    const auto columns = [&](std::size_t begin, std::size_t size) {
      return line.size() > begin ? line.substr(begin, size) : std::string_view();
    };
    if (columns(11, 12) == "BIOMOLECULE:") {
      if (n_rows != 0) refuse(line);
      is_inside = !is_found && trimmed(columns(23, 20)) == assembly;
      is_found = is_found || is_inside;
    }
    if (!is_inside || columns(11, 7) != "  BIOMT") continue;
    double number = 0;
    const bool has_numbers =
        parse_number(trimmed(columns(23, 10)), number) && parse_number(trimmed(columns(33, 10)), number) &&
        parse_number(trimmed(columns(43, 10)), number) && parse_number(trimmed(columns(58, 10)), number);
    // gemmi takes a row of any number, and leaves out an operation without a third one.
    if (!has_numbers || !trimmed(columns(53, 5)).empty() || line[18] != "123"[n_rows]) refuse(line);
    n_rows = (n_rows + 1) % 3;
    if (n_rows == 0) ++n;
  }
  if (n_rows != 0) refuse("");
  return n;
}

std::size_t check_operations(const std::string& path, gemmi::cif::Block& block, const std::string& assembly) {
  const auto refuse_more = [&](long long n, const char* what) {
    if (n > kMostOperations)
      throw InputError(path + ": describes more than " + std::to_string(kMostOperations) + " " + what +
                       " of assemblies, which is the most that are read");
  };
  refuse_more(static_cast<long long>(block.find("_pdbx_struct_assembly.", {"id"}).length()), "names");
  long long n_operations = 0;
  std::size_t n_of_assembly = 0;
  for (const auto row : block.find("_pdbx_struct_assembly_gen.", {"assembly_id", "oper_expression"})) {
    const std::string expression = row.str(1);
    const std::string where =
        path + ": the operations of assembly " + in_quotes(row.str(0)) + " are " + in_quotes(expression);
    const std::optional<long long> n = count_operations(expression);
    if (!n) throw InputError(where + "; names, or ranges such as (1-60), were expected");
    refuse_more(n_operations += *n, "operations");
    const std::size_t open = expression.find('(', 1), close = expression.find(')');
    if (row.str(0) == assembly && (open != std::string::npos || close < expression.size() - 1))
      throw InputError(where + ", a product, which is not built; give a file with the assembly's coordinates");
    if (row.str(0) == assembly) n_of_assembly += static_cast<std::size_t>(*n);
  }
  return n_of_assembly;
}

void build_assembly(const std::string& path, const gemmi::Structure& structure, const std::string& name,
                    std::size_t n_operations, gemmi::Model& model) {
  const auto found = std::find_if(structure.assemblies.begin(), structure.assemblies.end(),
                                  [&](const gemmi::Assembly& assembly) { return assembly.name == name; });
  if (found == structure.assemblies.end()) {
    std::string names;
    for (const gemmi::Assembly& assembly : structure.assemblies) names += (names.empty() ? "" : ", ") + assembly.name;
    throw InputError(
        path + ": " + option("assembly") + ": there is no assembly " + in_quotes(name) + "; " +
        (names.empty() ? "the file describes none (REMARK 350, _pdbx_struct_assembly)" : "there are " + names));
  }
  check_number(path, *found, n_operations);
  check_rigid(path, *found);
  check_size(path, *found, model);
  const char* const problem = "the assembly cannot be built: ";
  call_gemmi(path, problem, [&] {
    model = gemmi::make_assembly(*found, model, gemmi::HowToNameCopiedChain::Short, nullptr);
    return 0;
  });
  check_extent(path, name, model);
  call_gemmi(path, problem, [&] {
    gemmi::merge_atoms_in_expanded_model(model, gemmi::UnitCell());
    return 0;
  });
}

}  // namespace espdiff
