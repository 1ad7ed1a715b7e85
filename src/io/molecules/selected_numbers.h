// selected_numbers.h: the residue numbers in a selection: lists and negative numbers, which gemmi 0.5 does not read.
#pragma once

#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Residues from one number to another, both included; a code of '*' stands for any insertion code.
struct SelectedNumbers {
  int first, last;
  char first_code = ' ', last_code = ' ';

  bool has(const Residue& residue) const;
};

/// A selection without its residue numbers, as gemmi can read it, and the numbers, any of which a residue must have.
struct SplitSelection {
  std::string rest;
  std::vector<SelectedNumbers> numbers;  ///< empty: all
};

/// Takes the numbers out of "//A/26,27,30-40/CA": 26; 10-20; 10- (and all above), *-10 (and all below); -3 and -3--1
/// (below zero); 10.A, 10A (with an insertion code), 10.* (with any or none); several of them, separated by commas.
/// @throws InputError with the option's name and the part that cannot be read
SplitSelection split_numbers(const std::string& selection, const std::string& option_name);

}  // namespace espdiff
