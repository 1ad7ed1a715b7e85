// page_molecule.h: the backbones of both structures, which the page draws as ribbons.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "page/page_arrays.h"

namespace espdiff {

/// `backbone` of the record, of the residues with a C-alpha (nucleic acids: a phosphorus), in file order: `source` and
/// `target`, each with `chains` (residues of each unbroken stretch), `points` (positions in the target's frame) and
/// `sides` (unit vectors from C to O, in which a ribbon is wide; 0 where there is none). A structure that is not there
/// any more, or has changed, is no error: `molecule_because` then says why nothing is drawn.
/// @param prefix OUT, of a comparison
/// @throws FormatError (OUT.json is damaged)
void add_backbones(nlohmann::ordered_json& page, PageArrays& arrays, const std::string& prefix);

/// The same of an ensemble's template, which the record's plan has.
/// @param record OUT.json
void add_template_backbone(nlohmann::ordered_json& page, PageArrays& arrays, const nlohmann::ordered_json& record);

}  // namespace espdiff
