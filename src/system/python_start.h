// python_start.h: PDB2PQR started without what it loads and does not use, and without what takes it long.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

/// The words that run a program, before its arguments. One of Python, by its first line, is run by its own interpreter,
/// which loads two packages when they are first used instead of at the start: `requests`, by which PDB2PQR fetches
/// entries by their codes, and `pkg_resources`, by which PROPKA finds its files. They take half of the
/// time in which it loads. Norms, products and distances of vectors of three are computed without NumPy's questions
/// about them. Another program is run as it is.
std::vector<std::string> words_to_start(const std::string& program);

}  // namespace espdiff
