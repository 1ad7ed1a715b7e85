// hydrophobicity.cpp: scales of the residues' hydrophobicity.
#include <cstring>

#include "align/residue_names.h"
#include "base/error.h"
#include "field/field.h"

namespace espdiff {
namespace {

constexpr const char* kLetters = "ARNDCQEGHILKMFPSTWYV";

/// One value for each of kLetters; positive is hydrophobic.
struct Scale {
  const char* name;
  const char* label;
  const char* unit;
  const char* reference;
  float values[20];
};

/// Wimley and White give free energies of transfer from water; the signs here are reversed. Asp, Glu, Lys and Arg are
/// charged, His is neutral.
constexpr Scale kScales[] = {
    {"kyte-doolittle",
     "Hydrophobicity (Kyte and Doolittle)",
     "",
     "Kyte and Doolittle, A simple method for displaying the hydropathic character of a protein, J. Mol. Biol. 157, "
     "105 "
     "(1982)",
     {1.8F, -4.5F, -3.5F, -3.5F, 2.5F,  -3.5F, -3.5F, -0.4F, -3.2F, 4.5F,
      3.8F, -3.9F, 1.9F,  2.8F,  -1.6F, -0.8F, -0.7F, -0.9F, -1.3F, 4.2F}},
    {"wimley-white",
     "Hydrophobicity (Wimley and White, interface)",
     "kcal/mol",
     "Wimley and White, Experimentally determined hydrophobicity scale for proteins at membrane interfaces, Nat. "
     "Struct. "
     "Biol. 3, 842 (1996)",
     {-0.17F, -0.81F, -0.42F, -1.23F, 0.24F,  -0.58F, -2.02F, -0.01F, -0.17F, 0.31F,
      0.56F,  -0.99F, 0.23F,  1.13F,  -0.45F, -0.13F, -0.14F, 1.85F,  0.94F,  -0.07F}},
    {"octanol",
     "Hydrophobicity (Wimley and White, octanol)",
     "kcal/mol",
     "Wimley, Creamer and White, Solvation energies of amino acid side chains and backbone in a family of host-guest "
     "pentapeptides, Biochemistry 35, 5109 (1996)",
     {-0.50F, -1.81F, -0.85F, -3.64F, 0.02F,  -0.77F, -3.63F, -1.15F, -0.11F, 1.12F,
      1.25F,  -2.80F, 0.67F,  1.71F,  -0.14F, -0.46F, -0.25F, 2.09F,  0.71F,  0.46F}},
    {"eisenberg",
     "Hydrophobicity (Eisenberg)",
     "",
     "Eisenberg, Schwarz, Komaromy and Wall, Analysis of membrane and surface protein sequences with the hydrophobic "
     "moment plot, J. Mol. Biol. 179, 125 (1984)",
     {0.62F, -2.53F, -0.78F, -0.90F, 0.29F, -0.85F, -0.74F, 0.48F, -0.40F, 1.38F,
      1.06F, -1.50F, 0.64F,  1.19F,  0.12F, -0.18F, -0.05F, 0.81F, 0.26F,  1.08F}},
};

const Scale& find_scale(const std::string& name) {
  std::string list;
  for (const Scale& scale : kScales) {
    if (name == scale.name) return scale;
    list += (list.empty() ? "" : ", ") + std::string(scale.name);
  }
  throw InputError(option("field") + ": there is no scale of hydrophobicity '" + name + "'; there are: " + list);
}

/// What is no amino acid has no value.
std::vector<float> values_by(const Scale& scale, const Molecule& molecule) {
  std::vector<float> of_residue;
  for (const Residue& residue : molecule.residues) {
    const char* const place = std::strchr(kLetters, residue_letter(residue.name));
    of_residue.push_back(place != nullptr ? scale.values[place - kLetters] : kNoValue);
  }
  std::vector<float> values;
  for (const Atom& atom : molecule.atoms) values.push_back(of_residue[static_cast<std::size_t>(atom.residue)]);
  return values;
}

}  // namespace

FieldKind hydrophobicity_kind() {
  FieldKind kind{{"hydrophobicity", "Hydrophobicity", "", true},
                 "[SCALE]",
                 "Hydrophobicity of the residues by a scale: kyte-doolittle (the default), wimley-white (interface), "
                 "octanol or eisenberg; positive is hydrophobic",
                 "",
                 nullptr};
  for (const Scale& scale : kScales)
    kind.reference += (kind.reference.empty() ? "" : "; ") + std::string(scale.reference);
  kind.field = [](const FieldKind& self, const std::string& argument) {
    const Scale& scale = find_scale(argument.empty() ? kScales[0].name : argument);
    const FieldKind of_scale =
        kind_of_atoms({self.quantity.name, scale.label, scale.unit, true}, self.help, scale.reference,
                      [&scale](const Molecule& m) { return values_by(scale, m); });
    return of_scale.field(of_scale, "");
  };
  return kind;
}

}  // namespace espdiff
