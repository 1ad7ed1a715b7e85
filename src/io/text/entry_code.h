// entry_code.h: the codes of PDB entries, which newcomers give in place of files.
#pragma once

#include <string>

namespace espdiff {

/// Whether a text is the code of a PDB entry: a digit and three letters or digits (1ake), or pdb_ and eight.
bool is_entry_code(const std::string& text);

/// What to do where a file was expected and the code of an entry was given; empty for other texts.
std::string entry_advice(const std::string& text);

}  // namespace espdiff
