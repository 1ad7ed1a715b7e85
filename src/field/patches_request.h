// patches_request.h: which patches of a field are wanted, as text.
#pragma once

#include <string>
#include <vector>

#include "base/molecule/quantity.h"

namespace espdiff {

struct FieldRequest;

/// Reads "FIELD", "FIELD>T", "FIELD<T" or "FIELD>T<U", several separated by commas. Without a threshold the potential's
/// are 1 and -1 (kT/e).
/// @throws InputError (form, numbers, a field other than the potential without a threshold)
std::vector<PatchesRequest> parse_patches_of(const std::string& text);

/// "potential>1<-1", as parse_patches_of() reads it.
std::string to_string(const PatchesRequest& request);

/// @param fields that are compared besides the potential
/// @throws InputError (a field that is not compared, a field twice)
void check_patches_of(const std::vector<PatchesRequest>& requests, const std::vector<FieldRequest>& fields);

}  // namespace espdiff
