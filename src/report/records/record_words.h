// record_words.h: what a record says, in words; shared by the short answer and the whole table.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace espdiff {

class Record;

/// A state's file as it was given, with its model unless that is the first: "1d3z.pdb, model 2".
/// @param side "source" or "target"
std::string input_in_words(const Record& record, const std::string& side);
/// "4844 atoms, by sequence alignment (2 of 315 residues substituted)". @pre atoms are paired
std::string paired_in_words(const Record& record);
/// Labels and texts: which chains were compared, unless there is one of one name; how they moved against one another;
/// and copies, of which one may be meant.
std::vector<std::pair<std::string, std::string>> chains_in_words(const Record& record);
/// "Poisson-Boltzmann, 0.15 mol/l (charges without explicit water in a periodic cell)"
std::string potential_in_words(const Record& record);
/// The mean absolute difference of the whole surface: "about 0.3555, at most 0.5329 kT/e"
std::string whole_surface_in_words(const Record& record);
/// "94.2 % of the source's surface and 93.6 % of the target's"
std::string trusted_in_words(const Record& record);
/// "13.9 %", the share of the trusted area on side chains that turned; empty below 1 %.
std::string turned_share_in_words(const Record& record);
/// The same with the difference without it, and the side chains' names.
std::string turned_in_words(const Record& record);
/// "; the sign of the difference is not known (region): ..." for readings whose interval spans zero; otherwise empty.
std::string unknown_signs(const Record& record);
/// The sentences on the causes of a reading, an entry of the record's causes; the last one is the check of their sum.
std::vector<std::string> causes_in_words(const Record& reading);

}  // namespace espdiff
