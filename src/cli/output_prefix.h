// output_prefix.h: where the results of a pair go, and how they are found again.
#pragma once

#include <string>

namespace espdiff::cli {

/// Whether a result lies at a prefix, or a part of one.
bool has_result(const std::string& prefix);

/// @throws InputError (a result lies there, or the picture, if one is named), with `--overwrite` as the next command
void refuse_existing(const std::string& prefix, const std::string& picture = "");

/// A prefix that no result has: the given one, or PREFIX_2, PREFIX_3, ...
std::string free_prefix(const std::string& prefix);

/// A state's structure as it was typed.
struct StateFile {
  std::string path;
  int model = 1;
};

/// The prefix of OUT.json, OUT.vtp and OUT.residues.csv.
/// @param given  as typed: a prefix, one of the files that will be written (x of `x.json`, `x.png`), a folder (an
/// existing one,
///               or a name with a slash at its end), which is made if it is missing; or empty for the working folder
/// @param overwrite  whether a result of this name may be replaced; otherwise a name that was not typed is
/// free_prefix()
/// @param source, target  the structures, whose names without folder and ending make SOURCE_TARGET in a folder, with
/// the number of a model that is not the first: 1d3z_1d3z-model2
std::string output_prefix(const std::string& given, bool overwrite, const StateFile& source, const StateFile& target);

/// The file that a verb writes where none is named: "1ake.pqr" of data/1ake.pdb.gz, in the working folder.
std::string output_file(const std::string& input, const std::string& ending);

/// The prefix of a result that is named by it or by one of its files: OUT of OUT, OUT.json, OUT.vtp.
std::string result_prefix(const std::string& given);

/// The surface of a result that is named by its prefix or by one of its files: OUT, OUT.json, OUT.vtp.
std::string surface_of_result(const std::string& given);

}  // namespace espdiff::cli
