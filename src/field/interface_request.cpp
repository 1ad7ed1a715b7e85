// interface_request.cpp: partners of an interface from chains or selections.
#include "field/interface_request.h"

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "base/molecule/residue_label.h"
#include "base/text/printable.h"
#include "io/molecules/select_atoms.h"

namespace espdiff {
namespace {

/// Chains as a selection.
std::string selection_of(const std::string& partner) {
  const bool are_chains = std::all_of(partner.begin(), partner.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == ',' || c == '_' || c == '-';
  });
  return are_chains ? "//" + partner : partner;
}

std::vector<bool> atoms_of_partner(const std::string& partner, const Molecule& molecule) {
  std::vector<bool> atoms = select_atoms(molecule, selection_of(partner), "interface");
  if (std::find(atoms.begin(), atoms.end(), true) == atoms.end())
    throw InputError(option("interface") + ": '" + printable(partner) + "' selects no atom; " + molecule.name +
                     " has " + describe_chains(molecule));
  return atoms;
}

}  // namespace

InterfaceRequest parse_interface(const std::string& text) {
  const std::size_t colon = text.find(':');
  InterfaceRequest request{text.substr(0, colon), colon == std::string::npos ? "" : text.substr(colon + 1)};
  if (request.first.empty() || request.second.empty() || request.second.find(':') != std::string::npos)
    throw InputError(option("interface") + ": '" + printable(text) +
                     "' does not name two partners; write chains, such as H,L:A, or two selections with a colon "
                     "between them");
  return request;
}

PartnerAtoms atoms_of(const InterfaceRequest& request, const Molecule& molecule) {
  PartnerAtoms atoms{atoms_of_partner(request.first, molecule), atoms_of_partner(request.second, molecule)};
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (atoms.first[i] && atoms.second[i])
      throw InputError(option("interface") + ": " +
                       residue_label(molecule.residues[static_cast<std::size_t>(molecule.atoms[i].residue)]) +
                       " belongs to both partners; name two that share no atom");
  }
  return atoms;
}

}  // namespace espdiff
