// variants.cpp: labels, lists and groups of a matrix's molecules.
#include "matrix/variants.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "base/error.h"
#include "base/molecule/earlier_patch.h"
#include "base/molecule/input_options.h"
#include "compare/stages/fields.h"
#include "field/field_kinds.h"
#include "io/files/read_csv.h"
#include "io/structures/structure_file.h"
#include "io/text/text_cursor.h"
#include "options/options.h"
#include "prepare/region.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

/// One variant per model; messages and labels use `path` for the file.
std::vector<VariantFiles> models_of(const VariantFiles& file) {
  const StructureFile structure(file.structure);
  const int n_models = structure.n_models();
  std::vector<VariantFiles> models;
  for (int model = 1; model <= n_models; ++model) {
    models.push_back(file);
    models.back().sha256 = structure.sha256();
    models.back().model = model;
    if (n_models > 1 && !file.label.empty()) models.back().label += ":" + std::to_string(model);
  }
  return models;
}

std::string file_name(const std::string& path) {
  fs::path name = fs::path(path).filename();
  if (name.extension() == ".gz") name = name.stem();
  return name.stem().string();
}

/// Labels the variants without a label.
void label(std::vector<VariantFiles>& variants) {
  std::map<std::string, std::set<std::string>> files_named;
  std::map<std::string, int> n_models;
  for (const VariantFiles& v : variants) {
    if (!v.label.empty()) continue;
    files_named[file_name(v.structure)].insert(v.structure);
    ++n_models[v.structure];
  }
  for (VariantFiles& v : variants) {
    if (!v.label.empty()) continue;
    v.label = files_named[file_name(v.structure)].size() > 1 ? v.structure : file_name(v.structure);
    if (n_models[v.structure] > 1) v.label += ":" + std::to_string(v.model);
  }
}

/// A path in the list, relative to the working folder.
std::string beside(const std::string& list, const std::string& path) {
  if (path.empty() || fs::path(path).is_absolute()) return path;
  return (fs::path(list).parent_path() / path).lexically_normal().string();
}

void check_columns(const CsvTable& table, const std::vector<std::string>& known) {
  for (const std::string& column : table.columns) {
    if (std::find(known.begin(), known.end(), column) != known.end()) continue;
    std::string list;
    for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
    throw FormatError(table.path, 0, "the column '" + column + "' means nothing here; columns are " + list);
  }
}

}  // namespace

std::vector<std::string> input_paths(const std::vector<Variant>& variants) {
  std::vector<std::string> paths;
  for (const Variant& variant : variants) {
    for (const InputFile& input : variant.inputs) paths.push_back(input.path);
  }
  return paths;
}

std::vector<VariantFiles> variants_of_files(const std::vector<std::string>& paths) {
  std::vector<VariantFiles> variants;
  for (const std::string& path : paths) {
    VariantFiles file;
    file.structure = path;
    const std::vector<VariantFiles> models = models_of(file);
    variants.insert(variants.end(), models.begin(), models.end());
  }
  label(variants);
  return variants;
}

std::vector<VariantFiles> read_variant_list(const std::string& path) {
  const CsvTable table = read_csv(path);
  check_columns(table, {"structure", "model", "map", "unit", "label", "group"});
  table.require("structure");
  std::vector<VariantFiles> variants;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto field = [&](const char* column) {
      const int found = table.find(column);
      return found < 0 ? std::string() : table.rows[row][static_cast<std::size_t>(found)];
    };
    VariantFiles file;
    file.structure = beside(path, field("structure"));
    file.map = beside(path, field("map"));
    file.map_unit = field("unit");
    file.label = field("label");
    file.group = field("group");
    const std::string model = field("model");
    for (const std::string& needed : {file.structure, file.map}) {
      if (!needed.empty() && !fs::exists(needed))
        throw FormatError(path, table.lines[row], "there is no file '" + needed + "'");
    }
    if (file.structure.empty()) throw FormatError(path, table.lines[row], "the structure is missing");
    if (model.empty()) {
      const std::vector<VariantFiles> models = models_of(file);
      variants.insert(variants.end(), models.begin(), models.end());
      continue;
    }
    long long number = 0;
    if (!parse_integer(model, number) || number < 1 || number > 1000000)
      throw FormatError(path, table.lines[row], "model: " + in_quotes(model) + " is no number from 1 on");
    file.model = static_cast<int>(number);
    variants.push_back(file);
  }
  label(variants);
  return variants;
}

void read_groups(const std::string& path, std::vector<VariantFiles>& variants) {
  const CsvTable table = read_csv(path);
  const std::size_t label_column = table.require("label"), group_column = table.require("group");
  std::set<std::string> seen;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string& label = table.rows[row][label_column];
    const auto found =
        std::find_if(variants.begin(), variants.end(), [&](const VariantFiles& v) { return v.label == label; });
    if (found == variants.end())
      throw FormatError(path, table.lines[row],
                        "there is no variant " + in_quotes(label) + "; the first one is labelled " +
                            in_quotes(variants.empty() ? "" : variants.front().label));
    if (!seen.insert(label).second)
      throw FormatError(path, table.lines[row], "the variant " + in_quotes(label) + " is in a group already");
    found->group = table.rows[row][group_column];
  }
}

void check_labels(const std::vector<std::string>& labels) {
  std::set<std::string> seen;
  for (const std::string& label : labels) {
    if (label.empty()) throw InputError("a variant has an empty label; give each one a label");
    if (!seen.insert(label).second)
      throw InputError("two variants are labelled '" + label + "'; give each one a label of its own, in a list");
  }
}

void set_parts(std::vector<Variant>& variants, const std::vector<const Molecule*>& wholes,
               const InputOptions& options) {
  if (!options.has_region() && options.patches.empty()) return;
  const auto has_atoms = [&](const Molecule* whole) { return has_region_atoms(*whole, options); };
  const auto found = std::find_if(wholes.begin(), wholes.end(), has_atoms);
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const std::size_t other = found == wholes.end() ? i : static_cast<std::size_t>(found - wholes.begin());
    variants[i].parts = source_parts(variants[i].molecule, *wholes[i], variants[other].molecule, *wholes[other],
                                     options, variants.front().parts.patches);
    for (const SurfacePatch& patch : variants[i].parts.patches) {
      if (patch.earlier != nullptr)
        variants[i].inputs.push_back({"patch " + patch.name, patch.earlier->path, patch.earlier->sha256, {}, {}});
    }
  }
}

void set_fields(std::vector<Variant>& variants, const CompareOptions& options) {
  if (options.fields.empty()) return;
  const std::vector<Field> fields = make_fields(options.fields);
  for (Variant& variant : variants) {
    variant.fields.label = variant.label;
    variant.fields.group = variant.group;
    try {
      variant.fields.made = std::make_shared<const StateFields>(
          make_state_fields(fields, variant.molecule, {FieldSide::kVariant, variant.fields}));
    } catch (const InputError& error) {
      throw InputError(variant.label + ": " + error.message());
    }
    for (std::size_t f = 0; f < fields.size(); ++f) {
      for (const FieldFile& file : (*variant.fields.made)[f].files)
        variant.inputs.push_back({"field " + fields[f].quantity.name, file.path, file.sha256, {}, {}});
    }
  }
}

void unite_map_units(std::vector<Variant>& variants, double temperature_K) {
  if (variants.empty()) return;
  const Variant& first = variants.front();
  for (Variant& v : variants) {
    if (v.has_potential() != first.has_potential()) {
      const Variant& without = v.has_potential() ? first : v;
      throw InputError("a potential is missing for the variant '" + without.label +
                       "', and others have one; give all of them a map, or none to compare shapes alone");
    }
    if (!v.map || !first.map || v.map->unit == first.map->unit) continue;
    if (v.map->unit == PotentialUnit::kUnknown || first.map->unit == PotentialUnit::kUnknown) {
      const Variant& unknown = v.map->unit == PotentialUnit::kUnknown ? v : first;
      throw InputError("the unit of the map of '" + unknown.label +
                       "' is unknown, and others are known; name it in the list's column `unit`");
    }
    const float factor = static_cast<float>(conversion_factor(v.map->unit, first.map->unit, temperature_K));
    for (float& value : v.map->values) value *= factor;
    v.map->unit = first.map->unit;
  }
}

}  // namespace espdiff
