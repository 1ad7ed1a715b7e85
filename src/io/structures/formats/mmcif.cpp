// mmcif.cpp: mmCIF as a format of structures.
#include <utility>

#include "io/structures/formats/read_gemmi.h"
#include "io/structures/structure_format.h"

namespace espdiff {
namespace {

class CifModels : public StructureModels {
 public:
  explicit CifModels(FileContent file) : file_(std::move(file)) { unify_line_ends(file_.content); }

  int n_models() const override { return count_mmcif_models(file_.path, file_.content); }
  Molecule read(const StructureOptions& options) const override {
    return read_mmcif(file_.path, file_.content, options);
  }

 private:
  FileContent file_;
};

}  // namespace

StructureFormat mmcif_format() {
  return {"mmCIF", [](std::string_view, FileKind kind) { return kind == FileKind::kMmcif; },
          [](FileContent file) -> std::unique_ptr<StructureModels> {
            return std::make_unique<CifModels>(std::move(file));
          }};
}

}  // namespace espdiff
