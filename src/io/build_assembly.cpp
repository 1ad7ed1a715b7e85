// build_assembly.cpp: checks of an assembly's size, before gemmi makes it.
#include "io/build_assembly.h"

#include <algorithm>
#include <cstddef>
#include <gemmi/assembly.hpp>  // for make_assembly
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "io/call_gemmi.h"
#include "io/molecule_builder.h"
#include "io/text_cursor.h"

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

}  // namespace

void check_operations(const std::string& path, gemmi::cif::Block& block, const std::string& assembly) {
  const auto refuse_more = [&](long long n, const char* what) {
    if (n > kMostOperations)
      throw InputError(path + ": describes more than " + std::to_string(kMostOperations) + " " + what +
                       " of assemblies, which is the most that are read");
  };
  refuse_more(static_cast<long long>(block.find("_pdbx_struct_assembly.", {"id"}).length()), "names");
  long long n_operations = 0;
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
  }
}

void build_assembly(const std::string& path, const gemmi::Structure& structure, const std::string& name,
                    gemmi::Model& model) {
  const auto found = std::find_if(structure.assemblies.begin(), structure.assemblies.end(),
                                  [&](const gemmi::Assembly& assembly) { return assembly.name == name; });
  if (found == structure.assemblies.end()) {
    std::string names;
    for (const gemmi::Assembly& assembly : structure.assemblies) names += (names.empty() ? "" : ", ") + assembly.name;
    throw InputError(
        path + ": " + option("assembly") + ": there is no assembly " + in_quotes(name) + "; " +
        (names.empty() ? "the file describes none (REMARK 350, _pdbx_struct_assembly)" : "there are " + names));
  }
  check_size(path, *found, model);
  call_gemmi(path, "the assembly cannot be built: ", [&] {
    model = gemmi::make_assembly(*found, model, gemmi::HowToNameCopiedChain::Short, nullptr);
    gemmi::merge_atoms_in_expanded_model(model, gemmi::UnitCell());
    return 0;
  });
}

}  // namespace espdiff
