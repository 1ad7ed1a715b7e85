// write_cif.cpp: loops of the CIF 1.1 syntax (S. Hall and others, International Tables for Crystallography G, 2.2).
#include "io/molecules/write_cif.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/formatted.h"

namespace espdiff {
namespace {

std::string upper_case(std::string text) {
  for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return text;
}

/// Printable ASCII of a text.
std::string ascii_of(std::string text) {
  for (char& c : text) c = c < ' ' || c > '~' ? '?' : c;
  return text;
}

/// A bare word could be taken for something else.
bool needs_quotes(const std::string& text) {
  const std::string word = upper_case(text);
  const bool is_reserved = word.rfind("DATA_", 0) == 0 || word.rfind("SAVE_", 0) == 0 || word == "LOOP_" ||
                           word == "STOP_" || word == "GLOBAL_" || word == "?" || word == ".";
  const bool has_special = text.find_first_of(" \t'\"#") != std::string::npos;
  return is_reserved || has_special || std::string("_$[];#").find(text[0]) != std::string::npos;
}

std::string number_or_unknown(double value) { return std::isfinite(value) ? formatted("%.5g", value) : "?"; }

/// [residue] position in the sequence of its chain, from 1; 0 where it has no atom of an ATOM record.
std::vector<int> sequence_numbers(const Molecule& molecule) {
  std::vector<int> numbers(molecule.residues.size(), 0);
  std::map<std::string, int> last;
  for (const Atom& atom : molecule.atoms) {
    const auto residue = static_cast<std::size_t>(atom.residue);
    if (!atom.hetero && numbers[residue] == 0) numbers[residue] = ++last[molecule.residues[residue].chain];
  }
  return numbers;
}

void write_loop(std::ostream& out, const CifLoop& loop) {
  if (loop.rows.empty()) return;
  out << "#\nloop_\n";
  for (const std::string& item : loop.items) out << loop.category << '.' << cif_name(item) << '\n';
  for (const std::vector<std::string>& row : loop.rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      out << (i > 0 ? " " : "") << (row[i].empty() ? "?" : cif_value(row[i]));
    out << '\n';
  }
}

void write_atoms(std::ostream& out, const Molecule& molecule, const std::vector<double>& values) {
  const std::vector<int> sequence = sequence_numbers(molecule);
  out << "#\nloop_\n";
  for (const char* item :
       {"group_PDB", "id", "type_symbol", "label_atom_id", "label_alt_id", "label_comp_id", "label_asym_id",
        "label_entity_id", "label_seq_id", "pdbx_PDB_ins_code", "Cartn_x", "Cartn_y", "Cartn_z", "occupancy",
        "B_iso_or_equiv", "auth_seq_id", "auth_asym_id", "pdbx_PDB_model_num"})
    out << "_atom_site." << item << '\n';
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const Atom& atom = molecule.atoms[i];
    const auto r = static_cast<std::size_t>(atom.residue);
    const Residue& residue = molecule.residues[r];
    const std::string chain = cif_value(residue.chain.empty() ? "A" : residue.chain);
    const Vec3d& p = molecule.positions[i];
    out << (atom.hetero ? "HETATM " : "ATOM ") << i + 1 << ' '
        << (atom.element.empty() ? "?" : cif_value(upper_case(atom.element))) << ' ' << cif_value(atom.name) << " . "
        << cif_value(residue.name) << ' ' << chain << (atom.hetero ? " 2 " : " 1 ")
        << (atom.hetero || sequence[r] == 0 ? "." : std::to_string(sequence[r])) << ' '
        << (residue.insertion_code == ' ' ? "?" : cif_value(std::string(1, residue.insertion_code))) << ' '
        << formatted("%.3f %.3f %.3f 1.00 ", p.x, p.y, p.z) << number_or_unknown(values[i]) << ' ' << residue.number
        << ' ' << chain << " 1\n";
  }
}

}  // namespace

std::string cif_name(const std::string& text) {
  std::string name = text;
  for (char& c : name) {
    const bool is_word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    c = is_word ? c : '_';
  }
  return name.empty() ? "_" : name;
}

std::string cif_value(const std::string& given) {
  const std::string text = ascii_of(given);
  if (text.empty()) return "?";
  if (!needs_quotes(text)) return text;
  for (const char quote : {'\'', '"'}) {
    if (text.find(quote) == std::string::npos) return quote + text + quote;
  }
  return "\n;" + text + "\n;";  // a text field begins on a line of its own
}

void write_cif(std::ostream& out, const std::string& block, const Molecule& molecule, const std::vector<double>& values,
               const std::vector<std::string>& notes, const std::vector<CifLoop>& loops) {
  if (values.size() != molecule.size())
    throw InputError(molecule.name + ": " + std::to_string(values.size()) + " values for " +
                     std::to_string(molecule.size()) + " atoms");
  out << "data_" << cif_name(block) << '\n';
  for (const std::string& note : notes) out << "# " << ascii_of(note) << '\n';
  out << "_entry.id " << cif_name(block) << '\n';
  const bool has_ligands =
      std::any_of(molecule.atoms.begin(), molecule.atoms.end(), [](const Atom& atom) { return atom.hetero; });
  out << "#\nloop_\n_entity.id\n_entity.type\n1 polymer\n" << (has_ligands ? "2 non-polymer\n" : "");
  write_atoms(out, molecule, values);
  for (const CifLoop& loop : loops) write_loop(out, loop);
  out << "#\n";
}

}  // namespace espdiff
