// field_kinds.h: all kinds of fields, and fields by request.
#pragma once

#include <string>
#include <vector>

#include "field/field.h"

namespace espdiff {

/// All kinds, in the order of the list in src/CMakeLists.txt, from which the build makes this function.
const std::vector<FieldKind>& field_kinds();

/// Reads "NAME", "NAME=KIND", "NAME=KIND:ARGUMENT" or "KIND:ARGUMENT", several separated by `|`. The name of the first
/// and the last is the kind's.
/// @throws InputError (form, name, no such kind)
std::vector<FieldRequest> parse_fields(const std::string& text);

/// @param taken names of patches, beside which columns stand
/// @throws InputError (a name twice, or taken)
void check_fields(const std::vector<FieldRequest>& requests, const std::vector<std::string>& taken = {});

/// @throws InputError (no such kind)
const FieldKind& kind_of(const FieldRequest& request);

/// Makes the fields; reads their files. @throws InputError, IoError, FormatError
std::vector<Field> make_fields(const std::vector<FieldRequest>& requests);

std::vector<FieldDescription> describe(const std::vector<Field>& fields);

/// The files that a request names. @returns none for kinds that read none
std::vector<std::string> files_of(const FieldRequest& request);

}  // namespace espdiff
