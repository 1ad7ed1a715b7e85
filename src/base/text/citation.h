// citation.h: how a work names the program that made its numbers.
#pragma once

#include <string>

namespace espdiff {

/// The entry of a list of references for the version that wrote a result, in the words of CITATION.cff.
inline std::string citation_of(const std::string& version) {
  return "espdiff developers. espdiff: electrostatic surface potential differences between molecules of different "
         "shape. Version " +
         version + ". Computer software.";
}

}  // namespace espdiff
