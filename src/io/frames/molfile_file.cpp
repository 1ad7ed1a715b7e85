// molfile_file.cpp: calls VMD's readers, and checks what they give.
#include "io/frames/molfile_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "io/files/read_input.h"
#include "io/frames/molfile_abi.h"
#include "io/molecules/molecule_builder.h"
#include "system/standard_streams.h"

namespace espdiff {
namespace {

std::string by_reader(const std::string& path, const MolfileReader& reader) {
  return path + ": VMD's reader for " + reader.type + " files";
}

/// @returns the reader's handle, never null
void* open_with(const std::string& path, const MolfileReader& reader, int& n_atoms) {
  const QuietOutput quiet;
  void* const handle = reader.functions->open_file_read(path.c_str(), reader.type.c_str(), &n_atoms);
  if (handle == nullptr)
    throw FormatError(path, 0,
                      "VMD's reader for " + reader.type +
                          " files cannot open it; is it complete, and of the kind that its name says?");
  return handle;
}

/// The text of a field, which a reader may fill to its end.
template <std::size_t N>
std::string text_of(const char (&field)[N]) {
  const std::string text(field, strnlen(field, N));
  const std::size_t begin = text.find_first_not_of(' ');
  return begin == std::string::npos ? std::string() : text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

AtomEntry entry_of(const molfile::AtomRecord& atom, int flags) {
  AtomEntry entry;
  entry.name = text_of(atom.name);
  entry.residue_name = text_of(atom.resname);
  entry.residue_number = atom.resid;
  const std::string chain = text_of(atom.chain), segment = text_of(atom.segid), code = text_of(atom.insertion);
  entry.chain = chain.empty() || chain == "X" ? segment : chain;
  if ((flags & molfile::kHasInsertion) != 0 && !code.empty()) entry.insertion_code = code[0];
  return entry;
}

}  // namespace

MolfileFrames::MolfileFrames(std::string path, const MolfileReader& reader, std::size_t n_atoms,
                             const Progress& progress)
    : path_(std::move(path)), reader_(reader), n_atoms_(n_atoms) {
  require_regular_file(path_);
  if (reader_.functions->read_next_timestep == nullptr)
    throw InputError(by_reader(path_, reader_) + " reads no coordinates; give a trajectory or a structure");
  open();
  try {
    // Every frame is read: asked to skip one, some readers continue behind the end of the file.
    while (next()) {
      ++n_frames_;
      progress.check_cancelled();
    }
  } catch (...) {
    close();
    throw;
  }
  close();
  if (n_frames_ == 0) throw FormatError(path_, 0, "there are no frames");
}

MolfileFrames::~MolfileFrames() { close(); }

void MolfileFrames::open() {
  int n_atoms = molfile::kUnknownAtoms;
  handle_ = open_with(path_, reader_, n_atoms);
  at_ = 0;
  if (n_atoms == molfile::kUnknownAtoms || static_cast<std::size_t>(n_atoms) == n_atoms_) return;
  close();
  throw InputError(path_ + ": has " + std::to_string(n_atoms) + " atoms in each frame, and the structure has " +
                   std::to_string(n_atoms_) + "; give the structure or topology that it was made with");
}

void MolfileFrames::close() {
  if (handle_ == nullptr) return;
  const QuietOutput quiet;
  reader_.functions->close_file_read(std::exchange(handle_, nullptr));
}

bool MolfileFrames::next() {
  frame_.positions.resize(n_atoms_);
  molfile::Timestep step;
  step.coords = reinterpret_cast<float*>(frame_.positions.data());
  int status = 0;
  {
    const QuietOutput quiet;
    status = reader_.functions->read_next_timestep(handle_, static_cast<int>(n_atoms_), &step);
  }
  ++at_;
  if (status != molfile::kSuccess) return false;
  frame_.cell.reset();
  if (step.a > 1 && step.b > 1 && step.c > 1)
    frame_.cell = UnitCell{{step.a, step.b, step.c}, {step.alpha, step.beta, step.gamma}};
  return true;
}

const CoordinateFrame& MolfileFrames::frame(int number) {
  if (number == held_) return frame_;
  held_ = -1;
  if (handle_ == nullptr || at_ > number) {
    close();
    open();
  }
  bool is_there = true;
  while (is_there && at_ <= number) is_there = next();
  if (!is_there)
    throw FormatError(path_, 0, "frame " + std::to_string(number) + " cannot be read; was the file changed?");
  held_ = number;
  return frame_;
}

Molecule read_molfile_atoms(const std::string& path, const MolfileReader& reader) {
  require_regular_file(path);
  if (reader.functions->read_structure == nullptr)
    throw InputError(by_reader(path, reader) + " knows no atoms' names; give the structure or topology first");
  int n_atoms = 0;
  void* const handle = open_with(path, reader, n_atoms);
  if (n_atoms > static_cast<int>(kMostAtoms)) {
    const QuietOutput quiet;
    reader.functions->close_file_read(handle);
    throw InputError(path + ": has " + std::to_string(n_atoms) + " atoms, and at most " + std::to_string(kMostAtoms) +
                     " are read");
  }
  std::vector<molfile::AtomRecord> atoms(static_cast<std::size_t>(std::max(0, n_atoms)));
  int flags = 0, status = molfile::kError;
  {
    const QuietOutput quiet;
    if (!atoms.empty()) status = reader.functions->read_structure(handle, &flags, atoms.data());
    reader.functions->close_file_read(handle);
  }
  if (status != molfile::kSuccess)
    throw FormatError(path, 0, "VMD's reader for " + reader.type + " files finds no atoms; is it complete?");
  MoleculeBuilder builder(path, {1, true, true, {}});
  for (const molfile::AtomRecord& atom : atoms) builder.add(entry_of(atom, flags));
  Molecule molecule = builder.finish();
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    if (!std::isfinite(atoms[i].charge) || !std::isfinite(atoms[i].radius) || atoms[i].radius < 0)
      throw FormatError(path, 0, "atom " + std::to_string(i) + " has a charge or radius that cannot be");
    if ((flags & molfile::kHasCharge) != 0) molecule.charges.push_back(atoms[i].charge);
    if ((flags & molfile::kHasRadius) != 0) molecule.radii[i] = atoms[i].radius;
  }
  if ((flags & molfile::kHasRadius) != 0) molecule.radii_origin = ValueOrigin::kFile;
  return molecule;
}

}  // namespace espdiff
