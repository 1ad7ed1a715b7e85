// pdb_pqr.cpp: PQR and PDB as a format of structures: which of both a file is, its lines say.
#include <algorithm>
#include <mutex>
#include <utility>

#include "base/error.h"
#include "io/structures/atom_records.h"
#include "io/structures/formats/pdb_text.h"
#include "io/structures/formats/read_gemmi.h"
#include "io/structures/formats/read_pqr.h"
#include "io/structures/read_unit_cells.h"
#include "io/structures/structure_format.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

/// The lines that describe biological assemblies.
std::string assembly_remarks(std::string_view text) {
  std::string remarks;
  for (std::size_t begin = text.find("REMARK 350"); begin != std::string_view::npos;
       begin = text.find("REMARK 350", begin + 1)) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    remarks += std::string(text.substr(begin, end - begin)) + '\n';
  }
  return remarks;
}

class AtomRecords : public StructureModels {
 public:
  explicit AtomRecords(FileContent file) : file_(std::move(file)) {
    unify_line_ends(file_.content);
    models_ = split_models(file_.content, file_.path);
  }

  int n_models() const override { return static_cast<int>(models_.size()); }

  std::optional<UnitCell> unit_cell(int model) const override {
    std::call_once(cells_are_read_, [&] { cells_ = read_unit_cells(file_.content, models_, file_.path); });
    return cells_.at(static_cast<std::size_t>(model - 1));
  }

  long line_of(int model, const Residue& residue) const override {
    constexpr std::size_t kNumberAt = 22, kWidth = 5;
    std::string number = std::to_string(residue.number);
    if (residue.insertion_code != ' ') number += residue.insertion_code;
    for (const AtomLine& line : pick_model(models_, model, file_.path)) {
      if (line.text.size() >= kNumberAt + kWidth && trimmed(line.text.substr(kNumberAt, kWidth)) == number &&
          pdb_chain_name(line) == residue.chain)
        return line.number;
    }
    return 0;
  }

  Molecule read(const StructureOptions& options) const override {
    const auto& [path, text, sha256] = file_;
    const AtomModel& model = pick_model(models_, options.model, path);
    if (looks_like_pqr(model, path)) {
      if (!options.assembly.empty())
        throw InputError(path + ": is a PQR file, which describes no assemblies; leave " + option("assembly") +
                         " out, or give the PDB or mmCIF entry");
      return read_pqr(path, model, options);
    }
    Molecule molecule =
        read_pdb(path, model, options.assembly.empty() ? std::string() : assembly_remarks(text), options);
    molecule.formulas = formulas_in_pdb(text);
    return molecule;
  }

 private:
  FileContent file_;
  std::vector<AtomModel> models_;  // they point into the content
  mutable std::once_flag cells_are_read_;
  mutable std::vector<std::optional<UnitCell>> cells_;  // [model] read when the first of them is asked for
};

}  // namespace

StructureFormat pdb_pqr_format() {
  return {"PQR, PDB", [](std::string_view, FileKind kind) { return kind == FileKind::kAtomRecords; },
          [](FileContent file) -> std::unique_ptr<StructureModels> {
            return std::make_unique<AtomRecords>(std::move(file));
          }};
}

}  // namespace espdiff
