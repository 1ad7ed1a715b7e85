// read_component.h: the bonds of residues by their names, from definitions of chemical components.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace espdiff {

struct ComponentAtom {
  std::string name;  ///< "C1'"
  /// Elementary charges; 0 where a proton makes it, which depends on the pH.
  int charge = 0;
};

/// Two atoms of a component, by their places in Component::atoms.
struct ComponentBond {
  std::size_t a, b;
  int order;  ///< 1, 2 or 3; kAromaticOrder where the file does not say which bonds of a ring are double
};
constexpr int kAromaticOrder = 4;

/// The heavy atoms of a chemical component, and the bonds between them.
struct Component {
  std::string path;  ///< of the file
  std::string name;  ///< "FMN"
  std::vector<ComponentAtom> atoms;
  std::vector<ComponentBond> bonds;
};

/// Whether a file is read as components, by its name: .cif, or .cif.gz.
bool is_component_path(const std::string& path);

/// The components of a file of the Chemical Component Dictionary, or of a monomer library of CCP4, in its order; of
/// bonds that it calls delocalized each atom between them gets one double bond. Those with bonds to metals, or of no
/// order, are left out.
/// @throws IoError, FormatError (no CIF), InputError (no component with atoms and bonds; a build without gemmi)
std::vector<Component> read_components(const std::string& path);

/// The component of a name in CCP4's monomer library: the folder $CLIBD_MON, or where Debian's package
/// refmac-dictionary has it; nothing where $CLIBD_MON is empty, and where the library lacks or cannot tell its bonds.
std::optional<Component> component_of_library(const std::string& name);
/// Whether its folder is there.
bool has_monomer_library();
/// What to do where it is not: "install it (Debian: refmac-dictionary)".
extern const char* const kMonomerLibraryRemedy;

}  // namespace espdiff
