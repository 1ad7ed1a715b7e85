// read_dx.h: grids from OpenDX text files.
#pragma once

#include <string>
#include <string_view>

#include "base/types.h"

namespace espdiff {

/// The unit in parentheses behind the word "potential" in a comment or name, up to a comma: "POTENTIAL (kT/e)" as APBS
/// writes, "PME potential (kT/e, T=300K)" as PMEPot does. Unknown when there is none, or no unit of a potential.
PotentialUnit find_potential_unit(std::string_view text);

/// The same of a DX file, from its first lines alone; unknown also when it is absent or unreadable.
PotentialUnit potential_unit_of_file(const std::string& path);

/// The title, at most 60 characters of it, if it names another quantity than a potential, in the words of APBS, VMD,
/// Gaussian and others: "CHARGE DENSITY (e/A^3)", "LAPLACIAN OF POTENTIAL", "occupancy"; empty otherwise.
std::string title_of_other_quantity(std::string_view title);

/// Reads an OpenDX scalar field on a regular grid: gridpositions (any axes) and one text array, z fastest in the file.
/// The unit is find_potential_unit() of a comment or of the field's name. `path` is for messages. Takes about 30 ns a
/// value.
/// @throws FormatError (fewer or more values than promised, not finite, counts, axes)
/// @throws InputError (binary or vector arrays)
Grid read_dx(const std::string& path, std::string_view text);

}  // namespace espdiff
