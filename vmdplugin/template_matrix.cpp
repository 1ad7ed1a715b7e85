// template_matrix.cpp: the call into the ensembles' room, or the error of a build without it.
#include "template_matrix.h"

#include "base/error.h"
#include "matrix/variants.h"
#ifdef ESPDIFF_HAVE_HDF5
#include "ensemble/ensemble_study.h"
#include "ensemble/template_matrix.h"
#endif

namespace espdiff::vmdplugin {

#ifdef ESPDIFF_HAVE_HDF5

MatrixReport matrix_by_template(const MatrixObject& object, Engine& engine, const std::vector<Variant>& variants,
                                const Progress& progress) {
  const TemplateRequest request{object.template_text, object.n_exact, ensemble_options(object.settings)};
  return run_template_matrix(engine, variants, object.computation.options, request, object.run, progress);
}

MatrixReport merged_matrix(const std::vector<std::string>& paths, const MatrixRun& run) {
  return are_parts_of_template_matrix(paths) ? merge_template_matrix(paths, run) : merge_matrix(paths, run);
}

#else

MatrixReport matrix_by_template(const MatrixObject&, Engine&, const std::vector<Variant>&, const Progress&) {
  throw InputError(option("template") +
                   ": the potentials are kept in an HDF5 file, and this module was built without HDF5");
}

MatrixReport merged_matrix(const std::vector<std::string>& paths, const MatrixRun& run) {
  return merge_matrix(paths, run);
}

#endif

}  // namespace espdiff::vmdplugin
