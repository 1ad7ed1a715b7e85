// next_command.h: the one command that most likely helps after an error or an answer that is not trusted.
#pragma once

#include <string>
#include <vector>

#include "base/message.h"

namespace espdiff::cli {

/// What was typed behind the program's name, word by word.
using TypedWords = std::vector<std::string>;

/// The words with other options: those that were typed earlier get the new values.
TypedWords with_options(TypedWords words, const std::vector<NamedOption>& options);

/// The words without the options that need a potential or charges: settings of computed potentials, causes, such
/// fields, patches and metrics.
TypedWords without_potential(TypedWords words);

/// Source and target in each other's place, with their options (--source-model); unchanged if one was not typed.
TypedWords exchanged(TypedWords words, const std::string& a, const std::string& b);

/// "espdiff a.pdb b.pdb --ligands auto", as a shell takes it.
std::string as_typed(const TypedWords& words);

/// What NextCommand::before says, and the words: "apt install openbabel && espdiff a.pdb b.pdb --ligands auto". Where
/// it gives up the potential, what needs one goes, too; names that are left out are added to those that were typed.
/// Empty where what was typed to be left out is no list of names.
std::string next_command(const TypedWords& words, const NextCommand& next);

}  // namespace espdiff::cli
