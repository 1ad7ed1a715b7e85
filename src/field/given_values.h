// given_values.h: values of atoms that come with a molecule instead of from files: VMD's fields, Python's arrays.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Arrays of a molecule's atoms by name. The molecule may lose, gain and reorder atoms afterwards, by a selection or a
/// preparation: atoms are found by chain, residue number, insertion code and name, and among several of one name by
/// their place.
class GivenValues {
 public:
  explicit GivenValues(const Molecule& molecule);

  /// @param values [atom] NaN where an atom has none. @throws InputError (another number of values, a name twice)
  void add(const std::string& name, std::vector<float> values);
  std::vector<std::string> names() const;
  /// [atom of `molecule`] NaN for atoms that have none; hydrogens take their neighbour's.
  /// @throws InputError (there is no such array, with those there are)
  std::vector<float> values_of(const std::string& name, const Molecule& molecule) const;
  /// Of names and values, for SHA-256.
  std::string bytes() const;

 private:
  using Key = std::tuple<std::string, std::int32_t, char, std::string>;
  static Key key_of(const Molecule& molecule, std::size_t atom);

  std::string molecule_name_;
  std::map<Key, std::vector<std::size_t>> places_;  ///< atoms of a name, in order
  std::vector<Vec3d> positions_;
  std::map<std::string, std::vector<float>> arrays_;
};

}  // namespace espdiff
