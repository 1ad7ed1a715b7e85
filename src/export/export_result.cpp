// export_result.cpp: the table of formats, and the files of each.
#include "export/export_result.h"

#include <deque>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "export/write_glb.h"
#include "export/write_mvsj.h"
#include "export/write_ply.h"
#include "export/write_script.h"
#include "io/files/atomic_file.h"
#include "io/files/check_outputs.h"
#include "io/molecules/write_cif.h"
#include "io/molecules/write_pdb.h"
#include "io/structures/run_record.h"

namespace espdiff {
namespace {

/// REMARK lines have 68 characters.
std::vector<std::string> pdb_remarks(const ExportedResult& result) {
  constexpr std::size_t kWidth = 68;
  std::vector<std::string> remarks = {
      "B factor: " + result.residue_scale.label +
      (result.residue_scale.unit.empty() ? "" : " [" + result.residue_scale.unit + "]")};
  for (const auto& [name, text] : result.notes) {
    const std::string note = name + ": " + text;
    for (std::size_t at = 0; at < note.size(); at += kWidth) remarks.push_back(note.substr(at, kWidth));
  }
  return remarks;
}

/// OUT.residues.csv as a category, and what its columns are as another.
std::vector<CifLoop> residue_loops(const CsvTable& table) {
  CifLoop residues{"_espdiff_residue", {}, table.rows};
  CifLoop columns{"_espdiff_residue_column", {"name", "unit", "details"}, {}};
  const std::size_t first = table.require("residue_name") + 1;
  residues.items.assign(table.columns.begin(), table.columns.begin() + static_cast<std::ptrdiff_t>(first));
  for (const ResidueColumn& column : residue_columns(table)) {
    residues.items.push_back(column.name);
    columns.rows.push_back({column.name, column.unit, column.label});
  }
  return {columns, residues};
}

void write_exported_cif(std::ostream& out, const ExportedResult& result, const ExportedMolecule& molecule) {
  std::vector<std::string> notes = {"B_iso_or_equiv: " + result.residue_scale.label +
                                    (result.residue_scale.unit.empty() ? "" : " [" + result.residue_scale.unit + "]")};
  for (const auto& [name, text] : result.notes) notes.push_back(name + ": " + text);
  write_cif(out, std::filesystem::path(result.files.prefix).filename().string(), molecule.molecule, molecule.values,
            notes, residue_loops(result.files.residues));
}

/// "chimerax.cxc"
std::string script_of(const std::string& format) { return format == "chimerax" ? "chimerax.cxc" : format + ".py"; }

/// Writes one file.
/// @param loaded names, without folder, of what a script loads
void write_one(std::ostream& out, const std::string& format, const ExportedResult& result,
               const std::optional<ExportedMolecule>& molecule, const std::vector<std::string>& loaded) {
  if (format == "glb") return write_glb(out, result);
  if (format == "ply") return write_ply(out, result);
  if (format == "mvsj") return write_mvsj(out, result, *molecule);
  if (format == "pdb") return write_pdb(out, molecule->molecule, molecule->values, pdb_remarks(result));
  if (format == "cif") return write_exported_cif(out, result, *molecule);
  write_script(out, script_of(format), result, {loaded[0], loaded.size() > 1 ? loaded[1] : ""});
}

bool has_molecule(const std::string& format) { return format == "mvsj" || format == "pdb" || format == "cif"; }

/// The path without a format's ending, where it has it.
std::string without_ending(const std::string& path, const std::string& ending) {
  const bool has_it =
      path.size() > ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
  return has_it ? path.substr(0, path.size() - ending.size()) : path;
}

void check_inputs(const std::string& prefix, const std::vector<std::string>& outputs, bool overwrite) {
  const RunRecord record = read_run_record(prefix + ".vtp");
  check_outputs({prefix + ".json", prefix + ".vtp", prefix + ".residues.csv", record.source.path, record.target.path,
                 record.source_map.path, record.target_map.path},
                outputs, overwrite);
}

}  // namespace

const std::vector<ExportFormat>& export_formats() {
  static const std::vector<ExportFormat> formats = {
      {"glb", ".glb", "Surface as binary glTF 2.0: colours, values, and the source's shape as a morph target", {}},
      {"ply", ".ply", "Surface as PLY: colours, and values of each vertex", {}},
      {"mvsj", ".mvsj", "Scene for Mol* (MolViewSpec): surface, and the source coloured by residue", {}},
      {"pdb", ".residues.pdb", "Source in the target's frame, with values of the residues as B factors", {}},
      {"cif", ".residues.cif", "The same as mmCIF, with all columns of the table of residues", {}},
      {"chimerax", ".cxc", "Commands for ChimeraX, with the files that they open", {"glb", "cif"}},
      {"pymol", ".pymol.py", "Script for PyMOL, with the files that it loads", {"ply", "pdb"}},
      {"blender", ".blender.py", "Script for Blender, with the file that it loads", {"ply"}},
  };
  return formats;
}

const ExportFormat& export_format(const std::string& name) {
  std::string names;
  for (const ExportFormat& format : export_formats()) {
    if (format.name == name) return format;
    names += (names.empty() ? "" : ", ") + format.name;
  }
  throw InputError(option("to", name) + ": no such format; there are " + names);
}

std::vector<std::string> export_outputs(const std::string& prefix, const ExportFormat& format,
                                        const std::string& output) {
  std::vector<std::string> outputs = {output.empty() ? prefix + format.ending : output};
  for (const std::string& loaded : format.loads)
    outputs.push_back(without_ending(outputs[0], format.ending) + export_format(loaded).ending);
  return outputs;
}

std::vector<std::string> export_result(const std::string& prefix, const ExportFormat& format, const std::string& output,
                                       const ExportOptions& options) {
  const ExportedResult result = read_exported_result(prefix, options);
  std::vector<std::string> outputs = export_outputs(prefix, format, output), formats = {format.name}, loaded;
  formats.insert(formats.end(), format.loads.begin(), format.loads.end());
  for (std::size_t i = 1; i < outputs.size(); ++i)
    loaded.push_back(std::filesystem::path(outputs[i]).filename().string());
  check_inputs(prefix, outputs, options.overwrite);
  std::optional<ExportedMolecule> molecule;
  for (const std::string& one : formats) {
    if (has_molecule(one) && !molecule) molecule = read_exported_molecule(result);
  }
  std::deque<AtomicFile> files;
  std::vector<AtomicFile*> all;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    all.push_back(&files.emplace_back(outputs[i]));
    write_one(files.back().stream(), formats[i], result, molecule, loaded);
  }
  commit_all(all);
  return outputs;
}

}  // namespace espdiff
