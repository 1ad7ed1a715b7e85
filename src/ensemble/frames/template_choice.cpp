// template_choice.cpp: reads a template, and tells one from another.
#include "ensemble/frames/template_choice.h"

#include "io/files/sha256.h"
#include "io/structures/structure_file.h"
#include "options/options.h"
#include "prepare/load_state.h"

namespace espdiff {

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == std::string::npos;
}

LoadedState read_template(const std::string& path, const StructureOptions& structure, const InputOptions& options,
                          const Progress& progress) {
  const StructureFile file(path);
  StateRequest request{structure};
  request.wants_charges = false;
  return load_state(file, request, options, progress);
}

std::string sha256_of_template(const Molecule& molecule) {
  Sha256 sum;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    sum.update(molecule.atoms[i].name.data(), molecule.atoms[i].name.size());
    sum.update(&molecule.atoms[i].residue, sizeof molecule.atoms[i].residue);
    sum.update(&molecule.positions[i], sizeof molecule.positions[i]);
    sum.update(&molecule.radii[i], sizeof molecule.radii[i]);
  }
  return sum.finish();
}

}  // namespace espdiff
