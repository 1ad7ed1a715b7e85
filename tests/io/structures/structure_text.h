// structure_text.h: molecules read from texts, and the errors of reading them.
#pragma once

#include <numeric>
#include <string>
#include <vector>

#include "io/structures/structure_file.h"
#include "support/test_data.h"

namespace espdiff_test {

/// The molecule in a file of this name and text.
inline espdiff::Molecule structure_of(const std::string& file_name, const std::string& text,
                                      const espdiff::StructureOptions& options = {}) {
  const ScratchFolder scratch;
  return espdiff::read_structure(scratch.write(file_name, text), options);
}

/// The message that such a file is refused with, without the scratch folder's name.
inline std::string structure_error(const std::string& file_name, const std::string& text) {
  const std::string message = message_of([&] { structure_of(file_name, text); });
  const std::size_t name = message.find(file_name);
  return name == std::string::npos ? message : message.substr(name);
}

inline double sum(const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace espdiff_test
