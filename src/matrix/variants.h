// variants.h: the molecules of a matrix by name, group and SHA-256, from files and lists.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/molecule/structure_options.h"
#include "base/types.h"
#include "mapping/input.h"
#include "prepare/load_state.h"
#include "report/sections/provenance.h"

namespace espdiff {

struct CompareOptions;
struct InputOptions;

/// One molecule of a matrix and its potential.
struct Variant {
  std::string label;              ///< unique
  std::string group;              ///< empty for none
  std::vector<InputFile> inputs;  ///< its inputs; roles "structure" and "map"
  Molecule molecule;
  std::optional<Grid> map;
  MapMaker make_map = nullptr;  ///< instead of `map`; in kT/e
  SurfaceParts parts{};         ///< as the source of a pair
  StateOrigin origin{};         ///< for the warnings of its cells
  FieldInput fields{};          ///< see set_fields()

  bool has_potential() const { return map || make_map != nullptr; }
};

/// Every file that made them.
std::vector<std::string> input_paths(const std::vector<Variant>& variants);

/// Files of a variant.
struct VariantFiles {
  std::string structure;
  std::string sha256;  ///< of the structure file, where its models were counted
  int model = 1;
  std::string map;       ///< empty for none
  std::string map_unit;  ///< empty: from the file
  std::string label, group;
};

/// One variant for each model of each file, labelled by the file's name without folder and extension, plus `:MODEL` if
/// a file has several. If two files would get the same label, both are labelled by their paths.
/// @throws as StructureFile
std::vector<VariantFiles> variants_of_files(const std::vector<std::string>& paths);

/// Reads a list of variants: a table (read_csv()) with a column `structure` and optionally `model` (from 1; without it
/// every model is a variant), `map`, `unit` (of the map), `label` and `group`. Paths are relative to the list's folder.
/// Missing labels follow the rules of variants_of_files().
/// @throws FormatError, IoError (naming the line), and as variants_of_files()
std::vector<VariantFiles> read_variant_list(const std::string& path);

/// Sets the groups of variants from a table with the columns `label` and `group`.
/// @throws FormatError, InputError (a label that no variant has, or twice)
void read_groups(const std::string& path, std::vector<VariantFiles>& variants);

/// @throws InputError naming an empty label or one that two variants share, with the remedy
void check_labels(const std::vector<std::string>& labels);

/// Sets region and patches of each variant, by its own residues and atoms. A variant without the atoms that the region
/// is near to takes the region of the first variant that has them, carried over by the pairing of residues.
/// @param wholes [variant] the atoms of its file before the selection; of molecules in no file, the molecule
/// @throws as region_residues()
void set_parts(std::vector<Variant>& variants, const std::vector<const Molecule*>& wholes, const InputOptions& options);

/// Makes the fields of each variant before the work, so that one without is refused at once, and notes the files that
/// it alone has as its inputs.
/// @throws InputError naming the variant and the field, IoError, FormatError
void set_fields(std::vector<Variant>& variants, const CompareOptions& options);

/// Converts all maps to the unit of the first one.
/// @throws InputError if only some variants have maps, or only some units are unknown
void unite_map_units(std::vector<Variant>& variants, double temperature_K);

}  // namespace espdiff
