// frame_files.cpp: finds the file of a frame; completes charges and radii.
#include "trajectory/frame_files.h"

#include <algorithm>
#include <utility>

#include "align/pair_atoms.h"
#include "base/error.h"
#include "io/structure_file.h"

namespace espdiff {
namespace {

std::string name_of(const Molecule& molecule, std::size_t atom) {
  const Atom& a = molecule.atoms[atom];
  const Residue& residue = molecule.residues[static_cast<std::size_t>(a.residue)];
  return a.name + " of " + residue.name + " " + (residue.chain.empty() ? "" : residue.chain + " ") +
         std::to_string(residue.number);
}

/// The first atom without a partner.
template <typename AtomOf>
std::string first_unpaired(const Molecule& molecule, const AtomPairing& pairing, AtomOf atom_of) {
  std::vector<bool> is_paired(molecule.size(), false);
  for (const auto& pair : pairing.pairs) is_paired[atom_of(pair)] = true;
  const auto first = std::find(is_paired.begin(), is_paired.end(), false);
  return first == is_paired.end() ? std::string()
                                  : name_of(molecule, static_cast<std::size_t>(first - is_paired.begin()));
}

}  // namespace

FrameFiles::FrameFiles(std::vector<std::string> paths) : paths_(std::move(paths)) {
  if (paths_.empty()) throw InputError("no file of frames was given");
  first_.push_back(0);
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    load(i);
    first_.push_back(first_.back() + file_->n_models());
    sha256_.push_back(file_->sha256());
  }
}

std::size_t FrameFiles::file_of(int frame) const {
  return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), frame) - first_.begin()) - 1;
}

void FrameFiles::load(std::size_t file) {
  if (file_ != nullptr && loaded_ == file) return;
  file_ = nullptr;  // frees the old text first
  cells_.reset();
  file_ = std::make_unique<StructureFile>(paths_[file]);
  if (file < sha256_.size()) file_->require_unchanged(sha256_[file]);
  loaded_ = file;
}

std::string FrameFiles::name(int frame) const {
  const std::size_t file = file_of(frame);
  return paths_[file] + ", model " + std::to_string(frame - first_[file] + 1);
}

Molecule FrameFiles::read(int frame, StructureOptions options) {
  const std::size_t file = file_of(frame);
  load(file);
  options.model = frame - first_[file] + 1;
  return file_->read(options);
}

std::optional<UnitCell> FrameFiles::cell(int frame) {
  const std::size_t file = file_of(frame);
  load(file);
  if (!cells_) cells_ = file_->unit_cells();
  return cells_->at(static_cast<std::size_t>(frame - first_[file]));
}

void take_values(Molecule& frame, const Molecule& molecule, const std::string& name) {
  if (!frame.charges.empty()) return;
  const AtomPairing pairing = pair_atoms(molecule, frame, PairOthers::kByNumber);
  if (pairing.pairs.size() != frame.size() || pairing.pairs.size() != molecule.size()) {
    const std::string missing = first_unpaired(molecule, pairing, [](const auto& pair) { return pair.first; });
    const std::string extra = first_unpaired(frame, pairing, [](const auto& pair) { return pair.second; });
    throw InputError(name + " has no charges and radii, and cannot take those of " + molecule.name + ": " +
                     (missing.empty() ? "" : "it lacks " + missing) + (missing.empty() || extra.empty() ? "" : ", ") +
                     (extra.empty() ? "" : extra + " is not in " + molecule.name) + " (" +
                     std::to_string(frame.size()) + " and " + std::to_string(molecule.size()) +
                     " atoms); give frames and source of the same atoms, or frames as PQR");
  }
  frame.charges.assign(frame.size(), 0);
  for (const auto& [from, to] : pairing.pairs) {
    frame.charges[to] = molecule.charges[from];
    frame.radii[to] = molecule.radii[from];
  }
  frame.radii_origin = molecule.radii_origin;
}

}  // namespace espdiff
