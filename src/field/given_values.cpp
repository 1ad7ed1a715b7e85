// given_values.cpp: finds a molecule's atoms again, and their values.
#include "field/given_values.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "field/field.h"

namespace espdiff {

GivenValues::GivenValues(const Molecule& molecule) : molecule_name_(molecule.name), positions_(molecule.positions) {
  for (std::size_t i = 0; i < molecule.size(); ++i) places_[key_of(molecule, i)].push_back(i);
}

GivenValues::Key GivenValues::key_of(const Molecule& molecule, std::size_t atom) {
  const Residue& residue = molecule.residues[static_cast<std::size_t>(molecule.atoms[atom].residue)];
  return {residue.chain, residue.number, residue.insertion_code, molecule.atoms[atom].name};
}

void GivenValues::add(const std::string& name, std::vector<float> values) {
  if (values.size() != positions_.size())
    throw InputError("field " + name + ": there are " + std::to_string(values.size()) + " values for the " +
                     std::to_string(positions_.size()) + " atoms of " + molecule_name_);
  if (!arrays_.emplace(name, std::move(values)).second)
    throw InputError("field " + name + ": " + molecule_name_ + " was given two arrays of that name; leave one out");
}

std::vector<std::string> GivenValues::names() const {
  std::vector<std::string> all;
  for (const auto& [name, values] : arrays_) all.push_back(name);
  return all;
}

std::vector<float> GivenValues::values_of(const std::string& name, const Molecule& molecule) const {
  const auto array = arrays_.find(name);
  if (array == arrays_.end()) {
    std::string list;
    for (const std::string& other : names()) list += (list.empty() ? "" : ", ") + other;
    throw InputError(molecule_name_ + " was given no values '" + name + "'" +
                     (list.empty() ? std::string() : "; it was given: " + list));
  }
  std::vector<float> values;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const auto found = places_.find(key_of(molecule, i));
    if (found == places_.end()) {
      values.push_back(kNoValue);
      continue;
    }
    const auto nearer = [&](std::size_t a, std::size_t b) {
      return norm(positions_[a] - molecule.positions[i]) < norm(positions_[b] - molecule.positions[i]);
    };
    values.push_back(array->second[*std::min_element(found->second.begin(), found->second.end(), nearer)]);
  }
  give_to_hydrogens(molecule, values);
  return values;
}

std::string GivenValues::bytes() const {
  std::string all;
  for (const auto& [name, values] : arrays_) {
    all += name + "\n";
    const std::size_t at = all.size();
    all.resize(at + values.size() * sizeof(float));
    if (!values.empty()) std::memcpy(&all[at], values.data(), values.size() * sizeof(float));
  }
  return all;
}

}  // namespace espdiff
