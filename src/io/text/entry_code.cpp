// entry_code.cpp: the codes of PDB entries, which newcomers give in place of files.
#include "io/text/entry_code.h"

#include <algorithm>
#include <cctype>

namespace espdiff {

bool is_entry_code(const std::string& text) {
  const auto are_alphanumeric = [&](std::size_t first) {
    return std::all_of(text.begin() + static_cast<std::ptrdiff_t>(first), text.end(),
                       [](unsigned char c) { return std::isalnum(c) != 0; });
  };
  if (text.size() == 4) return std::isdigit(static_cast<unsigned char>(text[0])) != 0 && are_alphanumeric(1);
  return text.size() == 12 && text.rfind("pdb_", 0) == 0 && are_alphanumeric(4);
}

std::string entry_advice(const std::string& text) {
  if (!is_entry_code(text)) return {};
  return "there is no such file, and entries are not fetched; download " + text +
         ".cif from the Protein Data Bank (rcsb.org, pdbe.org or pdbj.org) and give that file";
}

}  // namespace espdiff
