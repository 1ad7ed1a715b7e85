// dcd_frames.cpp: reads PSF atoms and seeks to one frame of a DCD file.
#include "dcd_frames.h"

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "base/text/system_message.h"
#include "io/molecules/elements.h"

namespace espdiff_bench {
namespace {

using espdiff::FormatError;
using espdiff::InputError;
using espdiff::IoError;
using espdiff::Molecule;

std::ifstream open(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(path, espdiff::system_message(errno));
  return in;
}

std::string element_of(double mass, const std::string& name, const std::string& residue) {
  struct Element {
    const char* symbol;
    double mass;
  };
  constexpr Element kElements[] = {{"H", 1.008},  {"C", 12.011}, {"N", 14.007},
                                   {"O", 15.999}, {"P", 30.974}, {"S", 32.06}};
  for (const Element& element : kElements) {
    if (std::fabs(mass - element.mass) < 0.1) return element.symbol;
  }
  return espdiff::element_from_atom_name(name, residue);
}

/// One line of a PSF's atom section: serial, segment, residue number, residue name, atom name, type, charge, mass.
void add_atom(Molecule& molecule, const std::string& line, const std::string& path, long line_number) {
  std::istringstream fields(line);
  std::string serial, segment, number, residue, name, type;
  double charge = 0, mass = 0;
  if (!(fields >> serial >> segment >> number >> residue >> name >> type >> charge >> mass)) {
    throw FormatError(path, line_number, "not an atom of a PSF file: " + line);
  }
  // An insertion code may follow the number ("52A").
  char* end = nullptr;
  const auto residue_number = static_cast<std::int32_t>(std::strtol(number.c_str(), &end, 10));
  if (end == number.c_str())
    throw FormatError(path, line_number, "the residue number '" + number + "' is not a number");
  const espdiff::Residue here{residue, segment, residue_number, *end != '\0' ? *end : ' '};
  const auto same = [&](const espdiff::Residue& r) {
    return r.name == here.name && r.chain == here.chain && r.number == here.number &&
           r.insertion_code == here.insertion_code;
  };
  if (molecule.residues.empty() || !same(molecule.residues.back())) molecule.residues.push_back(here);
  espdiff::Atom atom;
  atom.name = name;
  atom.element = element_of(mass, name, residue);
  atom.residue = static_cast<std::int32_t>(molecule.residues.size() - 1);
  molecule.radii.push_back(espdiff::element_radius(atom.element));
  molecule.charges.push_back(static_cast<float>(charge));
  molecule.atoms.push_back(atom);
  molecule.positions.push_back({});
}

/// Reads a DCD file's records: a 4-byte length, the content, the length again.
class DcdFile {
 public:
  explicit DcdFile(const std::string& path) : path_(path), in_(open(path)) {
    in_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(in_.tellg());
    in_.seekg(0);
    read_header();
  }

  std::size_t n_atoms() const { return n_atoms_; }
  std::size_t n_frames() const { return static_cast<std::size_t>((size_ - first_frame_) / frame_bytes()); }

  /// [axis][atom] of one frame.
  std::vector<std::vector<float>> frame(std::size_t index) {
    if (index >= n_frames()) {
      throw InputError(path_ + ": there is no frame " + std::to_string(index) + "; the file has " +
                       std::to_string(n_frames()) + ", counted from 0");
    }
    in_.seekg(static_cast<std::streamoff>(first_frame_ + index * frame_bytes()));
    if (has_cell_) expect_record(kCellBytes);
    std::vector<std::vector<float>> axes(3, std::vector<float>(n_atoms_));
    for (auto& axis : axes) {
      const std::vector<char> content = expect_record(4 * n_atoms_);
      std::memcpy(axis.data(), content.data(), content.size());
    }
    return axes;
  }

 private:
  static constexpr std::uint64_t kCellBytes = 48, kMarks = 8;

  std::uint64_t frame_bytes() const {
    return (has_cell_ ? kCellBytes + kMarks : 0) + (has_fourth_axis_ ? 4 : 3) * (4 * n_atoms_ + kMarks);
  }

  [[noreturn]] void refuse(const std::string& what) const { throw FormatError(path_, 0, what); }

  std::uint32_t read_mark() {
    std::uint32_t mark = 0;
    in_.read(reinterpret_cast<char*>(&mark), sizeof mark);
    if (!in_) refuse("the file ends early");
    return mark;
  }
  std::vector<char> read_record() {
    const std::uint32_t length = read_mark();
    if (length > size_) refuse("a record of " + std::to_string(length) + " bytes is longer than the file");
    std::vector<char> content(length);
    in_.read(content.data(), static_cast<std::streamsize>(length));
    if (!in_ || read_mark() != length) refuse("a record's end is not where its length says");
    return content;
  }
  std::vector<char> expect_record(std::uint64_t length) {
    std::vector<char> content = read_record();
    if (content.size() != length) {
      refuse("a record has " + std::to_string(content.size()) + " bytes instead of " + std::to_string(length));
    }
    return content;
  }

  void read_header() {
    const std::vector<char> header = read_record();
    if (header.size() != 84 || std::memcmp(header.data(), "CORD", 4) != 0) {
      refuse("not a little-endian DCD file with 4-byte record marks");
    }
    const auto word = [&](std::size_t i) {
      std::int32_t value = 0;
      std::memcpy(&value, header.data() + 4 + 4 * i, sizeof value);
      return value;
    };
    if (word(8) != 0) refuse("files with fixed atoms are not read");
    const bool charmm = word(19) != 0;
    has_cell_ = charmm && word(10) != 0;
    has_fourth_axis_ = charmm && word(11) != 0;
    read_record();  // titles
    const std::vector<char> count = expect_record(4);
    std::int32_t n = 0;
    std::memcpy(&n, count.data(), sizeof n);
    if (n <= 0) refuse("the header gives " + std::to_string(n) + " atoms");
    n_atoms_ = static_cast<std::size_t>(n);
    first_frame_ = static_cast<std::uint64_t>(in_.tellg());
  }

  std::string path_;
  std::ifstream in_;
  std::uint64_t size_ = 0, first_frame_ = 0;
  std::size_t n_atoms_ = 0;
  bool has_cell_ = false, has_fourth_axis_ = false;
};

}  // namespace

Molecule read_psf(const std::string& path) {
  std::ifstream in = open(path);
  std::string line;
  long line_number = 0, n_atoms = -1;
  Molecule molecule;
  molecule.name = path;
  molecule.radii_origin = espdiff::ValueOrigin::kElement;
  while (std::getline(in, line)) {
    ++line_number;
    if (line_number == 1 && line.rfind("PSF", 0) != 0) throw FormatError(path, 1, "not a PSF file");
    if (n_atoms < 0) {
      if (line.find("!NATOM") == std::string::npos) continue;
      n_atoms = std::strtol(line.c_str(), nullptr, 10);
      if (n_atoms <= 0) throw FormatError(path, line_number, "no number of atoms before !NATOM");
      continue;
    }
    if (static_cast<long>(molecule.size()) == n_atoms) break;
    add_atom(molecule, line, path, line_number);
  }
  if (n_atoms < 0) throw FormatError(path, line_number, "there is no !NATOM section");
  if (static_cast<long>(molecule.size()) != n_atoms) {
    throw FormatError(
        path, line_number,
        "the file ends after " + std::to_string(molecule.size()) + " of " + std::to_string(n_atoms) + " atoms");
  }
  return molecule;
}

Molecule read_frame(const Molecule& psf, const std::string& dcd_path, std::size_t frame) {
  DcdFile file(dcd_path);
  if (file.n_atoms() != psf.size()) {
    throw FormatError(dcd_path, 0,
                      "has " + std::to_string(file.n_atoms()) + " atoms, the PSF file " + std::to_string(psf.size()));
  }
  const auto axes = file.frame(frame);
  Molecule molecule = psf;
  molecule.name = dcd_path + ", frame " + std::to_string(frame);
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    molecule.positions[i] = {static_cast<double>(axes[0][i]), static_cast<double>(axes[1][i]),
                             static_cast<double>(axes[2][i])};
  }
  return molecule;
}

}  // namespace espdiff_bench
