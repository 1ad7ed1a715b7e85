// export_result.h: a comparison as files of other programs.
#pragma once

#include <string>
#include <vector>

#include "export/exported_result.h"

namespace espdiff {

/// A format that a result is exported to.
struct ExportFormat {
  std::string name;    ///< "glb"
  std::string ending;  ///< of its file: ".glb"
  std::string help;    ///< one line
  /// Formats whose files a script loads; they are written beside it.
  std::vector<std::string> loads;
};

/// All of them. @throws InputError from the second form: no such format, with those there are
const std::vector<ExportFormat>& export_formats();
const ExportFormat& export_format(const std::string& name);

/// The files that export_result() writes: first the format's own, then what it loads.
/// @param output path of the format's own file; empty: OUT with the format's ending
std::vector<std::string> export_outputs(const std::string& prefix, const ExportFormat& format,
                                        const std::string& output);

/// Writes a comparison in a format; all files of it or none.
/// @param prefix OUT of the comparison
/// @returns export_outputs()
/// @throws as read_exported_result(), read_exported_molecule(), write_script(), write_pdb(); InputError (an output that
///         is an input, or is there), IoError
std::vector<std::string> export_result(const std::string& prefix, const ExportFormat& format, const std::string& output,
                                       const ExportOptions& options);

}  // namespace espdiff
