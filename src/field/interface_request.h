// interface_request.h: which two partners of a complex an interface lies between.
#pragma once

#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// The field that an interface is compared by.
constexpr const char* kComplementarity = "complementarity";

/// The partners, as chains "H,L" or as selections "//A;polymer".
struct InterfaceRequest {
  std::string first, second;
};

/// Reads "H,L:A": chains, or selections of select_atoms() where a partner has more than letters, digits and commas.
/// @throws InputError (form)
InterfaceRequest parse_interface(const std::string& text);

/// [atom] of each partner.
struct PartnerAtoms {
  std::vector<bool> first, second;
};

/// @throws InputError (a partner of no atoms, with the chains there are; an atom of both)
PartnerAtoms atoms_of(const InterfaceRequest& request, const Molecule& molecule);

}  // namespace espdiff
