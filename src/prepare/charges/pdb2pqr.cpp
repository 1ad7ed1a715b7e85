// pdb2pqr.cpp: writes PDB2PQR's input, runs it or takes its output from the cache, and reads what it wrote.
#include "prepare/charges/pdb2pqr.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <tuple>

#include "align/chain_links.h"
#include "align/protonation.h"
#include "align/residue_names.h"
#include "base/error.h"
#include "base/formatted.h"
#include "base/molecule/input_options.h"
#include "base/molecule/water.h"
#include "io/files/read_input.h"
#include "io/files/run_program.h"
#include "io/files/sha256.h"
#include "io/files/temporary_folder.h"
#include "io/molecules/select_atoms.h"
#include "io/molecules/write_pdb.h"
#include "io/structures/structure_file.h"
#include "io/text/text_cursor.h"
#include "prepare/charges/cache.h"
#include "prepare/charges/caps.h"
#include "prepare/charges/closed_chains.h"
#include "prepare/charges/ligand.h"
#include "prepare/charges/modified_residues.h"
#include "prepare/charges/open_babel.h"
#include "prepare/charges/separate_atoms.h"
#include "system/python_start.h"

namespace espdiff {

const char* const kPdb2pqrRemedy = "install it (Debian: pdb2pqr; PyPI: pdb2pqr)";

namespace {

constexpr double kTimeLimitSeconds = 3600;
/// Of the file it writes: a line for each of the most atoms that are read.
constexpr std::uintmax_t kMostBytes = std::uintmax_t{512} << 20;

/// Chains with one character for PDB2PQR, a character for each of their pieces, and numbers that fit its columns.
class Renumbering {
 public:
  explicit Renumbering(const Molecule& molecule) : original_(molecule.residues) {
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
    const std::vector<std::size_t> pieces = pieces_of_chains(molecule);
    std::map<std::pair<std::string, std::size_t>, char> names;
    std::set<char> taken;
    std::set<std::string> renumbered;
    for (const Residue& residue : original_) {
      constexpr std::int32_t kLow = -999, kHigh = 9999;
      if (residue.insertion_code != ' ' || residue.number < kLow || residue.number > kHigh)
        renumbered.insert(residue.chain);
      if (residue.chain.size() == 1 && names.emplace(std::pair(residue.chain, 0), residue.chain[0]).second)
        taken.insert(residue.chain[0]);
    }
    for (std::size_t r = 0; r < original_.size(); ++r) {
      const std::pair piece(original_[r].chain, pieces[r]);
      if (names.count(piece) > 0) continue;
      const auto free =
          std::find_if(letters.begin(), letters.end(), [&](char letter) { return taken.count(letter) == 0; });
      if (free == letters.end())
        throw InputError(molecule.name +
                         ": has more than 62 chains, which a PDB file cannot distinguish; select some (" +
                         option("select", "//A") + ")");
      names[piece] = *free;
      taken.insert(*free);
    }
    std::map<std::string, std::int32_t> last;
    for (std::size_t r = 0; r < original_.size(); ++r) {
      Residue residue = original_[r];
      if (renumbered.count(residue.chain) > 0) {
        residue.number = ++last[residue.chain];
        residue.insertion_code = ' ';
      }
      residue.chain = std::string(1, names.at({residue.chain, pieces[r]}));
      index_.emplace(std::tuple(residue.chain, residue.number), r);
      residues_.push_back(residue);
    }
  }

  const std::vector<Residue>& residues() const { return residues_; }
  const std::vector<Residue>& originals() const { return original_; }
  /// The number of the original of a residue in the output; -1 where there is none.
  std::ptrdiff_t original(const Residue& residue) const {
    const auto found = index_.find({residue.chain, residue.number});
    return found == index_.end() ? -1 : static_cast<std::ptrdiff_t>(found->second);
  }

 private:
  const std::vector<Residue> original_;
  std::vector<Residue> residues_;
  std::map<std::tuple<std::string, std::int32_t>, std::size_t> index_;
};

/// The molecule without water and, where states are given, without the hydrogens of chains, which are added again.
Molecule without_water(const Molecule& molecule, bool without_hydrogens) {
  const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms_of_residues(molecule));
  std::vector<bool> keep;
  for (const Atom& atom : molecule.atoms) {
    const auto r = static_cast<std::size_t>(atom.residue);
    const bool is_hydrogen = atom.element == "H" || atom.element == "D";
    const bool drop = is_hydrogen && is_polymer(kinds[r]) && (without_hydrogens || atom.element == "D");
    keep.push_back(!drop && !is_water_name(molecule.residues[r].name));
  }
  return keep_atoms(molecule, keep);
}

bool has_kind(const Molecule& molecule, ResidueKind kind) {
  const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms_of_residues(molecule));
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

/// The name of a group. PROPKA knows metals by the PDB's names of them, and ends with an error at CHARMM's (ZN2, CAL).
std::string propka_name(const LeftOutResidue& group) {
  static const std::map<std::string, const char*> names = {{"mg", "MG"}, {"ca", "CA"}, {"zn", "ZN"}, {"na", "NA"},
                                                           {"mn", "MN"}, {"k", "K"},   {"cd", "CD"}};
  const auto found = group.atoms.size() == 1 ? names.find(lower_case(group.atoms[0].element)) : names.end();
  return found == names.end() ? group.residue.name : found->second;
}

/// The molecule followed by the groups beside its chains that were left out of it, without those of a residue that it
/// has a part of, and without hydrogens, which PROPKA does not look at.
Molecule with_left_out_groups(const Molecule& molecule) {
  std::set<ResidueKey> own;
  for (const Residue& residue : molecule.residues) own.insert(key_of(residue));
  Molecule groups, whole = molecule;
  for (const LeftOutResidue& left : molecule.left_out) {
    if (own.count(key_of(left.residue)) > 0) continue;
    groups.residues.push_back(left.residue);
    groups.residues.back().name = propka_name(left);
    for (std::size_t i = 0; i < left.atoms.size(); ++i) {
      if (left.atoms[i].element == "H" || left.atoms[i].element == "D") continue;
      groups.atoms.push_back(left.atoms[i]);
      groups.atoms.back().residue = static_cast<std::int32_t>(groups.residues.size() - 1);
      groups.atoms.back().hetero = true;
      groups.positions.push_back(left.positions[i]);
    }
  }
  const std::vector<ResidueKind> kinds = residue_kinds(groups, atoms_of_residues(groups));
  std::vector<std::int32_t> place(kinds.size(), -1);
  for (std::size_t r = 0; r < kinds.size(); ++r) {
    if (kinds[r] != ResidueKind::kOther) continue;
    place[r] = static_cast<std::int32_t>(whole.residues.size());
    whole.residues.push_back(groups.residues[r]);
  }
  for (std::size_t i = 0; i < groups.size(); ++i) {
    Atom atom = groups.atoms[i];
    atom.residue = place[static_cast<std::size_t>(atom.residue)];
    if (atom.residue < 0) continue;
    whole.atoms.push_back(atom);
    whole.positions.push_back(groups.positions[i]);
    whole.radii.push_back(0);
  }
  return whole;
}

/// Atoms of a residue follow each other, also the hydrogens that a ligand got.
Molecule by_residue(const Molecule& molecule) {
  std::vector<std::size_t> order(molecule.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return molecule.atoms[a].residue < molecule.atoms[b].residue; });
  Molecule sorted;
  sorted.name = molecule.name;
  sorted.residues = molecule.residues;
  for (const std::size_t i : order) {
    sorted.atoms.push_back(molecule.atoms[i]);
    sorted.positions.push_back(molecule.positions[i]);
  }
  return sorted;
}

/// The PDB file that PDB2PQR reads.
std::string pdb_text(Molecule molecule, const Renumbering& renumbering, const std::vector<std::string>& states) {
  molecule.residues = renumbering.residues();
  for (std::size_t r = 0; r < states.size(); ++r) {
    // Disulfides follow from the geometry.
    if (!states[r].empty() && states[r] != "CYX" && states[r] != "CYS") molecule.residues[r].name = states[r];
  }
  std::ostringstream text;
  write_pdb(text, molecule, std::vector<double>(molecule.size(), 0), {});
  return text.str();
}

std::string upper_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  return text;
}

/// The program's arguments but the files.
std::vector<std::string> arguments(const ChargeOptions& options, const std::string& force_field, bool with_propka) {
  std::vector<std::string> words{"--ff=" + upper_case(force_field), "--keep-chain"};
  if (!with_propka) return words;
  words.insert(words.end(), {"--titration-state-method=propka", "--with-ph=" + formatted(options.ph)});
  return words;
}

/// The version of a program by its file, so that a new one does not take outputs of an old one from the cache.
std::string identity_of(const std::string& program) {
  std::error_code ignored;
  namespace fs = std::filesystem;
  return program + " " + std::to_string(fs::file_size(program, ignored)) + " " +
         std::to_string(fs::last_write_time(program, ignored).time_since_epoch().count());
}

/// PROPKA takes no such chain.
struct PropkaError : InputError {
  using InputError::InputError;
};

/// A residue has an atom by a name that PDB2PQR does not know.
struct UnknownAtomError : UnchargedError {
  using UnchargedError::UnchargedError;
  std::string atom = "all their names";  ///< "HX1 of TYR 2 of chain B", where the log names it
};

constexpr const char *kPropkaMark = "does not seem to contain any", *kUnknownAtomMark = "Found gap";

/// The atom that a log says it knows no bond of, in a record of the PDB file, whose numbers have five digits.
std::optional<std::size_t> unknown_atom(const std::string& log, const Molecule& given) {
  const std::string before = "for atom ";
  constexpr std::size_t kSerial = 6, kName = 12, kEnd = 16, kSerials = 100000;
  const std::size_t at = log.find(before, log.find(kUnknownAtomMark));
  if (at == std::string::npos || log.size() < at + before.size() + kEnd) return std::nullopt;
  const std::string record = log.substr(at + before.size(), kEnd);
  std::string name = record.substr(kName);
  name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
  const long serial = std::strtol(record.substr(kSerial, kName - kSerial - 1).c_str(), nullptr, 10);
  for (auto i = static_cast<std::size_t>(std::max(serial - 1, 0L)); i < given.size(); i += kSerials) {
    if (given.atoms[i].name == name) return i;
  }
  return std::nullopt;
}

[[noreturn]] void refuse_unknown_atom(const std::string& log, const Molecule& given) {
  const std::optional<std::size_t> atom = unknown_atom(log, given);
  const Residue residue = atom ? given.residues[static_cast<std::size_t>(given.atoms[*atom].residue)] : Residue();
  const std::string selection = atom ? atom_selection(residue, {given.atoms[*atom].name}) : "(...)",
                    name = atom ? given.atoms[*atom].name + " of " + residue_in_words(residue) : "an atom of the file";
  Message remedy = "; name it as the PDB does, leave it out (" + option("leave-out", selection) +
                   "), or give charges (" + option("topology", "FILE") + " of a PSF or prmtop, or a PQR)";
  if (atom) remedy.set_next({"", {{"leave-out", selection}}});
  UnknownAtomError error(
      given.name,
      "has no charges, and PDB2PQR cannot prepare it: " + name + " is none of its residue's atoms by this name", remedy,
      residue);
  if (atom) error.atom = name;
  throw error;
}

/// The reason in a log, in our words. A text that is not known may name files that are gone, and is not passed on.
std::string reason_in(const std::string& log) {
  static const std::vector<std::pair<const char*, const char*>> known = {
      {kPropkaMark, "PROPKA cannot use it, such as a peptide of few residues"},
      // Its message of that cannot be formatted.
      {"Unknown format code 'i'", "more than a tenth of the heavy atoms of its residues are missing"},
      {"missing too many", "more than a tenth of the heavy atoms of its residues are missing"},
      {"does not contain any", "no residue of it is known to the force field"},
      {"Unable to debump", "atoms overlap, and moving them apart failed"},
      {"while trying to debump", "atoms overlap, and moving them apart failed"},
      {"Too many chains", "it has more chains than PDB2PQR has names for"},
      {"non-integer charge", "the sum of the charges is not a whole number"},
      {"noninteger", "the sum of the charges is not a whole number"},
      {"Found no known", "no residue of it is known to the force field"},
      {"No biomolecule heavy atoms", "no residue of it is known to the force field"},
      {"Too few atoms present", "a residue has too few atoms to place the missing ones by"}};
  for (const auto& [mark, words] : known) {
    if (log.find(mark) != std::string::npos) return words;
  }
  return "its reason is not known here, and pdb2pqr30 prints it when it is run on the file";
}

/// The residues that a log names between some words, as "DA B 12".
/// @param numbered [residue] as the program got it
std::vector<Residue> residues_in(const std::string& log, const std::string& before, const std::string& after,
                                 const Molecule& given, const std::vector<Residue>& numbered) {
  std::vector<Residue> found;
  std::set<std::size_t> seen;
  for (std::size_t at = log.find(after); at != std::string::npos; at = log.find(after, at + 1)) {
    const std::size_t begin = log.rfind(before, at);
    if (begin == std::string::npos) continue;
    std::istringstream words(log.substr(begin + before.size(), at - begin - before.size()));
    std::string name, chain;
    std::int32_t number = 0;
    if (!(words >> name >> chain >> number)) continue;
    for (std::size_t r = 0; r < numbered.size(); ++r) {
      if (numbered[r].chain == chain && numbered[r].number == number && seen.insert(r).second)
        found.push_back(given.residues[r]);
    }
  }
  return found;
}

/// The residues that a reason is about.
std::vector<Residue> blamed_residues(const std::string& log, const Molecule& given,
                                     const std::vector<Residue>& numbered) {
  std::vector<Residue> blamed = residues_in(log, "residue ", " in structure!", given, numbered);
  return blamed.empty() ? residues_in(log, "Residue ", " has non-integer charge", given, numbered) : blamed;
}

/// " (DA 1 of chain B, DT 11 of chain B)"
std::string in_parentheses(const std::vector<Residue>& residues) {
  constexpr std::size_t kMostNamed = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(residues.size(), kMostNamed); ++i)
    text += (text.empty() ? " (" : ", ") + residue_in_words(residues[i]);
  if (residues.size() > kMostNamed) text += " and " + std::to_string(residues.size() - kMostNamed) + " more";
  return text.empty() ? text : text + ")";
}

/// "PDB2PQR v3.5.2"
std::string version_in(const std::string& log) {
  const std::size_t at = log.find("PDB2PQR v");
  if (at == std::string::npos) return "PDB2PQR";
  return log.substr(at, std::min(log.find_first_of(": \n", at + 9), log.size()) - at);
}

/// Runs the program. The output's first line is a remark with the program's version.
/// @param given the atoms of the PDB file, in its order  @param numbered [residue] by the names of that file
std::string run_pdb2pqr(const std::string& program, const Molecule& given, const std::vector<Residue>& numbered,
                        const std::string& pdb, const std::string& ligand, const std::vector<std::string>& options,
                        const Progress& progress) {
  const TemporaryFolder folder;
  ProgramCall call;
  call.words = words_to_start(program);
  call.words.insert(call.words.end(), options.begin(), options.end());
  if (!ligand.empty()) call.words.push_back("--ligand=" + folder.write("ligand.mol2", ligand));
  call.words.insert(call.words.end(), {folder.write("input.pdb", pdb), folder.file("output.pqr")});
  call.folder = folder.path();
  call.time_limit_s = kTimeLimitSeconds;
  call.while_running = [&] {
    progress.check_cancelled();
    std::error_code missing;
    const auto n_bytes = std::filesystem::file_size(folder.file("output.pqr"), missing);
    if (!missing && n_bytes > kMostBytes)
      throw DeviceError(given.name + ": PDB2PQR wrote more than " + std::to_string(kMostBytes >> 20) +
                        " MB and was ended");
  };
  const ProgramResult result = run_program(call);
  std::error_code ignored;
  const std::string log = result.output + result.messages;
  if (result.status != 0 || !std::filesystem::exists(folder.file("output.pqr"), ignored)) {
    if (log.find(kUnknownAtomMark) != std::string::npos) refuse_unknown_atom(log, given);
    const std::vector<Residue> blamed = blamed_residues(log, given, numbered);
    const Message lack = "has no charges, and PDB2PQR cannot prepare it: " + reason_in(log) + in_parentheses(blamed),
                  remedy = "; complete or mend the structure, leave atoms out (" + option("leave-out", "(...)") +
                           "), or give charges (" + option("topology", "FILE") + " of a PSF or prmtop, or a PQR)";
    if (log.find(kPropkaMark) != std::string::npos) throw PropkaError(given.name + ": " + lack + remedy);
    if (blamed.empty()) throw InputError(given.name + ": " + lack + remedy);
    throw UnchargedError(given.name, lack, remedy, blamed.front());
  }
  return "REMARK " + version_in(log) + "\n" + read_input(folder.file("output.pqr")).content;
}

/// Residues of a molecule by their numbers and the places of their atoms: PDB2PQR gives a chain another letter where a
/// second one follows under its name, such as an arginine that is bound as a ligand.
class PlacedResidues {
 public:
  explicit PlacedResidues(const Molecule& molecule, const std::vector<Residue>& numbered) : molecule_(molecule) {
    for (std::size_t i = 0; i < molecule.size(); ++i)
      atoms_[{numbered[static_cast<std::size_t>(molecule.atoms[i].residue)].number, molecule.atoms[i].name}].push_back(
          i);
  }
  /// -1 where no atom lies where the original has one of its name.
  std::ptrdiff_t original(const Molecule& output, const std::vector<std::size_t>& atoms) const {
    constexpr double kSamePlace_A = 0.01;
    for (const std::size_t i : atoms) {
      const auto found = atoms_.find(
          {output.residues[static_cast<std::size_t>(output.atoms[i].residue)].number, output.atoms[i].name});
      if (found == atoms_.end()) continue;
      for (const std::size_t own : found->second) {
        if (norm(molecule_.positions[own] - output.positions[i]) < kSamePlace_A) return molecule_.atoms[own].residue;
      }
    }
    return -1;
  }

 private:
  const Molecule& molecule_;
  std::map<std::pair<std::int32_t, std::string>, std::vector<std::size_t>> atoms_;
};

/// The atoms of an output under their original chains, numbers and names, without those of groups that were left out.
/// @param before the molecule without these groups
Molecule read_output(const std::string& output, const Molecule& before, const Renumbering& renumbering) {
  const TemporaryFolder folder;
  Molecule molecule = read_structure(folder.write("output.pqr", output), {1, true, true, {}});
  molecule.name = before.name;
  std::vector<bool> is_own(molecule.residues.size(), true), keep;
  const PlacedResidues placed(before, renumbering.residues());
  const auto atoms = atoms_of_residues(molecule);
  for (std::size_t r = 0; r < molecule.residues.size(); ++r) {
    std::ptrdiff_t original = renumbering.original(molecule.residues[r]);
    if (original < 0) original = placed.original(molecule, atoms[r]);
    if (original < 0) continue;
    is_own[r] = static_cast<std::size_t>(original) < before.residues.size();
    molecule.residues[r] = renumbering.originals()[static_cast<std::size_t>(original)];
  }
  for (const Atom& atom : molecule.atoms) keep.push_back(is_own[static_cast<std::size_t>(atom.residue)]);
  return std::find(keep.begin(), keep.end(), false) == keep.end() ? molecule : keep_atoms(molecule, keep);
}

/// Paths of the files that describe a residue.
std::vector<std::string> used_files(const std::vector<Mol2File>& ligands, const std::vector<std::int32_t>& ligand_of) {
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < ligands.size(); ++i) {
    if (std::find(ligand_of.begin(), ligand_of.end(), static_cast<std::int32_t>(i)) != ligand_of.end())
      paths.push_back(ligands[i].path);
  }
  return paths;
}

/// Residues of three heavy atoms or more, which ions and what is no molecule by its names do not have.
std::vector<std::size_t> ligand_residues(const Molecule& molecule) {
  constexpr std::size_t kFewest = 3;
  std::vector<std::size_t> n_heavy(molecule.residues.size(), 0), ligands;
  for (const Atom& atom : molecule.atoms) {
    const auto r = static_cast<std::size_t>(atom.residue);
    if (atom.element != "H" && atom.element != "D" && ++n_heavy[r] == kFewest) ligands.push_back(r);
  }
  return ligands;
}

void require_residues(const Molecule& molecule, bool ligands_auto) {
  const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms_of_residues(molecule));
  if (std::any_of(kinds.begin(), kinds.end(), is_polymer)) return;
  if (molecule.residues.empty())
    throw InputError(molecule.name + ": has water only, and nothing that PDB2PQR could charge; give another structure");
  std::string names;
  std::set<std::string> seen;
  constexpr std::size_t kMostShown = 4;
  for (const Residue& residue : molecule.residues) {
    if (!seen.insert(residue.name).second || seen.size() > kMostShown) continue;
    if (!names.empty()) names += ", ";
    names += (residue.name.empty() ? "an unnamed residue" : "") + residue_in_words(residue);
  }
  const bool is_there = !find_open_babel().empty(),
             would_help = (!is_there || !ligands_auto) && !ligand_residues(molecule).empty();
  Message remedy = "; ";
  if (would_help)
    remedy += "let Open Babel charge ligands" +
              (is_there ? std::string() : ", which is not there: " + std::string(kOpenBabelRemedy)) + " (" +
              option("ligands", "auto") + "), ";
  remedy += "give a PQR, or charges (" + option("topology", "FILE") + " or " + option("charges-from", "FILE") + ")";
  if (would_help) remedy.set_next({is_there ? "" : "apt install openbabel && ", {{"ligands", "auto"}}});
  throw UnchargedError(molecule.name,
                       "has no charges, and no amino acids or nucleotides that PDB2PQR could charge, only " + names,
                       remedy, molecule.residues.front());
}

}  // namespace

std::string find_pdb2pqr() {
  const char* const named = std::getenv("ESPDIFF_PDB2PQR");
  if (named != nullptr && *named != '\0') return find_program(named);
  const std::string program = find_program("pdb2pqr30");
  return program.empty() ? find_program("pdb2pqr") : program;
}

namespace {

/// One run of PDB2PQR, or its output from the cache.
class Run {
 public:
  Run(std::string program, const ChargeOptions& options, const std::string& force_field, bool with_propka,
      const Progress& progress)
      : program_(std::move(program)),
        options_(options),
        words_(arguments(options, force_field, with_propka)),
        progress_(progress) {}

  /// @param ligand content of a MOL2 file; may be empty
  Molecule operator()(const Molecule& molecule, const std::vector<std::string>& states, const std::string& ligand) {
    const Molecule prepared = run_once(molecule, states, ligand);
    const std::vector<ClosedChain> closed = closed_chains(molecule);
    if (closed.empty()) return prepared;
    const std::vector<std::size_t> order = from_the_middle(closed, molecule.residues.size());
    std::vector<std::string> states_in_order;
    if (!states.empty()) {
      for (const std::size_t r : order) states_in_order.push_back(states[r]);
    }
    return without_ends(prepared, run_once(in_order(molecule, order), states_in_order, ligand), molecule, closed);
  }
  /// The runs that follow give residues their usual states.
  void drop_propka(const std::string& force_field) { words_ = arguments(options_, force_field, false); }
  bool all_from_cache() const { return all_from_cache_; }
  const std::string& version() const { return version_; }

 private:
  Molecule run_once(const Molecule& molecule, const std::vector<std::string>& states, const std::string& ligand) {
    const Molecule whole = by_residue(with_left_out_groups(molecule));
    const Renumbering renumbering(whole);
    const std::string pdb = pdb_text(whole, renumbering, states);
    std::string key = "1 " + identity_of(program_);
    for (const std::string& word : words_) key += " " + word;
    key = sha256_of(key + "\n" + sha256_of(ligand) + "\n" + pdb);
    std::optional<std::string> output = options_.use_cache ? find_in_cache(key) : std::nullopt;
    if (!output) {
      all_from_cache_ = false;
      output = run_pdb2pqr(program_, whole, renumbering.residues(), pdb, ligand, words_, progress_);
      if (options_.use_cache) keep_in_cache(key, *output);
    }
    const std::size_t begin = std::string("REMARK ").size();
    version_ = output->substr(begin, output->find('\n') - begin);
    return read_output(*output, molecule, renumbering);
  }

  std::string program_;
  const ChargeOptions& options_;
  std::vector<std::string> words_;
  const Progress& progress_;
  bool all_from_cache_ = true;
  std::string version_;
};

/// Appends the residues of `more` that `molecule` lacks.
void append(Molecule& molecule, const Molecule& more) {
  const auto same = [](const Residue& a, const Residue& b) {
    return a.chain == b.chain && a.number == b.number && a.insertion_code == b.insertion_code && a.name == b.name;
  };
  std::vector<std::int32_t> index;
  for (const Residue& residue : more.residues) {
    const bool there = std::any_of(molecule.residues.begin(), molecule.residues.end(),
                                   [&](const Residue& other) { return same(residue, other); });
    index.push_back(there ? -1 : static_cast<std::int32_t>(molecule.residues.size()));
    if (!there) molecule.residues.push_back(residue);
  }
  for (std::size_t i = 0; i < more.size(); ++i) {
    Atom atom = more.atoms[i];
    atom.residue = index[static_cast<std::size_t>(atom.residue)];
    if (atom.residue < 0) continue;
    molecule.atoms.push_back(atom);
    molecule.positions.push_back(more.positions[i]);
    molecule.radii.push_back(more.radii[i]);
    molecule.charges.push_back(more.charges[i]);
  }
}

/// PDB2PQR takes one ligand: the first run has the first one, each further ligand gets its charges in a run beside it.
Molecule run_with_ligands(Run& run, const Molecule& molecule, const std::vector<std::string>& states,
                          const std::vector<Mol2File>& ligands) {
  const std::vector<std::int32_t> ligand_of = ligands_of_residues(molecule, ligands);
  std::vector<std::int32_t> present;
  for (const std::int32_t ligand : ligand_of) {
    if (ligand >= 0 && std::find(present.begin(), present.end(), ligand) == present.end()) present.push_back(ligand);
  }
  Molecule result;
  for (std::size_t k = 0; k < std::max<std::size_t>(present.size(), 1); ++k) {
    std::vector<bool> keep, keep_residue;
    for (const std::int32_t ligand : ligand_of) keep_residue.push_back(ligand < 0 || ligand == present[k]);
    for (const Atom& atom : molecule.atoms) keep.push_back(keep_residue[static_cast<std::size_t>(atom.residue)]);
    std::vector<std::string> kept_states;
    for (std::size_t r = 0; r < states.size(); ++r) {
      if (keep_residue[r]) kept_states.push_back(states[r]);
    }
    const std::string content = present.empty() ? "" : ligands[static_cast<std::size_t>(present[k])].content;
    const Molecule prepared = run(keep_atoms(molecule, keep), kept_states, content);
    if (k == 0) {
      result = prepared;
    } else {
      append(result, prepared);
    }
  }
  return result;
}

/// Gives heavy atoms what their file says of how well their places are known; those that were added have nothing.
void take_knowledge(const Molecule& before, Molecule& after) {
  using Name = std::tuple<std::string, std::int32_t, char, std::string>;
  const auto name_of = [](const Molecule& m, const Atom& atom) {
    const Residue& r = m.residues[static_cast<std::size_t>(atom.residue)];
    return Name(r.chain, r.number, r.insertion_code, atom.name);
  };
  std::map<Name, const Atom*> known;
  for (const Atom& atom : before.atoms) known.emplace(name_of(before, atom), &atom);
  for (Atom& atom : after.atoms) {
    const auto found = known.find(name_of(after, atom));
    if (found == known.end()) continue;
    atom.b_factor = found->second->b_factor;
    atom.occupancy = found->second->occupancy;
    atom.has_alternates = found->second->has_alternates;
  }
}

/// The molecule without hydrogens, so that PDB2PQR places them, and PROPKA's run, whatever their names. Protons of
/// acids are in the residues' names.
Molecule without_hydrogens(const Molecule& molecule, const std::string& reason, Preparation& done) {
  Molecule bare = without_water(molecule, true);
  if (bare.size() == molecule.size()) return bare;
  done.notes.push_back("the file's " + std::to_string(molecule.size() - bare.size()) +
                       " hydrogens were placed anew, since " + reason +
                       (done.propka ? "; PROPKA decides the protonation" : ""));
  return bare;
}

/// The molecule without the residues of some sources.
Molecule without_sources(const Molecule& molecule, const std::vector<GroupSource>& sources,
                         const std::function<bool(GroupSource)>& drops) {
  std::vector<bool> keep;
  for (const Atom& atom : molecule.atoms) keep.push_back(!drops(sources[static_cast<std::size_t>(atom.residue)]));
  return keep_atoms(molecule, keep);
}

/// Additives and torn residues.
bool is_left_out(GroupSource source) { return source == GroupSource::kAdditive || source == GroupSource::kTorn; }

bool is_in_chain(GroupSource source) {
  return source == GroupSource::kNone || source == GroupSource::kPhosphate || source == GroupSource::kModified ||
         source == GroupSource::kCap;
}

/// The program that charges a molecule of ligands and nothing of a chain; empty for others, which need PDB2PQR.
std::string source_of_ligands(const Molecule& molecule, const std::vector<GroupSource>& sources) {
  if (std::any_of(sources.begin(), sources.end(), is_in_chain)) return {};
  std::string source;
  for (const std::size_t r : ligand_residues(molecule)) {
    if (sources[r] == GroupSource::kOpenBabel) return "Open Babel";
    if (sources[r] == GroupSource::kHaem) source = "CHARMM22's charges of haem";
  }
  return source;
}

/// What PDB2PQR charges. The groups that get charges otherwise become left out, so that PROPKA sees them.
/// @param states [residue] or empty; those of the groups are taken out
Molecule set_aside(const Molecule& molecule, const std::vector<GroupSource>& sources,
                   std::vector<std::string>& states) {
  Molecule chains = without_sources(with_bare_caps(with_known_residues(molecule, sources), sources), sources,
                                    [](GroupSource s) { return !is_in_chain(s); });
  const auto atoms = atoms_of_residues(molecule);
  std::vector<std::string> kept;
  for (std::size_t r = 0; r < sources.size(); ++r) {
    if (is_in_chain(sources[r])) {
      if (!states.empty()) kept.push_back(states[r]);
      continue;
    }
    LeftOutResidue group{molecule.residues[r], {}, {}, 0};
    for (const std::size_t i : atoms[r]) {
      group.atoms.push_back(molecule.atoms[i]);
      group.positions.push_back(molecule.positions[i]);
    }
    chains.left_out.push_back(std::move(group));
  }
  states = std::move(kept);
  return chains;
}

/// Chains that were several molecules to PDB2PQR.
void note_pieces(const Molecule& molecule, std::vector<std::string>& notes) {
  const std::vector<std::size_t> pieces = pieces_of_chains(molecule);
  std::map<std::string, std::pair<std::size_t, std::string>> begins;  // of each chain: its pieces, and where they begin
  for (std::size_t r = 0; r < pieces.size(); ++r) {
    auto& [n, text] = begins[molecule.residues[r].chain];
    if (pieces[r] == n) continue;
    n = pieces[r];
    text += (text.empty() ? "" : ", ") + residue_in_words(molecule.residues[r]);
  }
  for (const auto& [chain, begin] : begins) {
    if (begin.first > 0)
      notes.push_back((chain.empty() ? "the chain" : "chain " + chain) + " has " + std::to_string(begin.first + 1) +
                      " molecules, each with ends of its own; those after the first begin with " + begin.second);
  }
}

}  // namespace

void require_charges(const Molecule& molecule, const ChargeOptions& options) {
  Molecule before = without_water(molecule, false);
  Preparation unused;
  rename_residues(before, unused);
  const std::vector<Mol2File> ligands = read_ligands(options.ligands);
  const std::vector<std::int32_t> ligand_of = ligands_of_residues(before, ligands);
  require_known_names(before, group_sources(before, ligand_of, options), ligand_of,
                      force_field_for(molecule, nullptr, options.force_field));
}

std::string force_field_for(const Molecule& molecule, const Molecule* source, const std::string& asked) {
  if (asked != "auto") return asked;
  const bool has_own = has_kind(molecule, ResidueKind::kNucleotide),
             has_source = source != nullptr && has_kind(*source, ResidueKind::kNucleotide);
  if (has_own && source != nullptr && !has_source && has_kind(*source, ResidueKind::kAminoAcid))
    throw InputError(molecule.name +
                     ": has nucleotides, which get charges of AMBER, and the source has none and charges of PARSE; "
                     "take one force field for both (" +
                     option("force-field", "amber") + ")");
  return has_own || has_source ? "amber" : "parse";
}

Prepared prepare_molecule(const Molecule& molecule, const ChargeOptions& options,
                          const std::vector<std::string>& states, const Progress& progress) {
  const auto begun = std::chrono::steady_clock::now();
  const std::string program = find_pdb2pqr();
  Prepared prepared;
  Preparation& done = prepared.preparation;
  done.force_field = force_field_for(molecule, nullptr, options.force_field);
  if (has_kind(molecule, ResidueKind::kNucleotide) && done.force_field == "amber")
    done.notes.emplace_back("force field AMBER, since PARSE has no DNA");
  Molecule before = without_water(molecule, !states.empty());
  require_all_atoms(before);
  const bool titrates = has_kind(before, ResidueKind::kAminoAcid), with_propka = states.empty() && titrates;
  done.propka = titrates;
  const std::string misplaced = misplaced_hydrogens(before);
  if (!misplaced.empty()) before = without_hydrogens(before, misplaced, done);
  require_separate_atoms(before);
  std::vector<std::string> kept_states;
  for (std::size_t r = 0; r < states.size(); ++r) {
    if (!is_water_name(molecule.residues[r].name)) kept_states.push_back(states[r]);
  }
  rename_residues(before, done);
  const std::vector<Mol2File> ligands = read_ligands(options.ligands);
  const std::vector<std::int32_t> ligand_of = ligands_of_residues(before, ligands);
  const std::vector<GroupSource> sources = group_sources(before, ligand_of, options);
  const std::string without_chains = source_of_ligands(before, sources);
  const bool is_alone = !without_chains.empty();
  if (!is_alone && program.empty())
    throw DeviceError(molecule.name + ": has no charges, and PDB2PQR, which assigns them, is not there; " +
                      kPdb2pqrRemedy);
  if (!is_alone) require_residues(before, options.ligands_auto);
  if (!titrates && !is_alone)
    done.notes.emplace_back("no PROPKA, since there are no amino acids, which are all that it titrates");
  require_known_names(before, sources, ligand_of, done.force_field);
  Groups groups = charge_groups(before, sources, options, progress);
  Run run(program, options, done.force_field, with_propka, progress);
  const Molecule chains = set_aside(before, sources, kept_states);
  const Molecule given = add_ligand_hydrogens(chains, ligands, ligands_of_residues(chains, ligands));
  const auto run_on = [&](const Molecule& atoms) {
    if (is_alone) return Molecule();
    try {
      return run_with_ligands(run, atoms, kept_states, ligands);
    } catch (const PropkaError&) {
      run.drop_propka(done.force_field);
      done.propka = false;
      done.notes.emplace_back("no PROPKA, which cannot use so short a chain: residues have their usual states at pH 7");
      return run_with_ligands(run, atoms, kept_states, ligands);
    }
  };
  try {
    prepared.molecule = run_on(given);
  } catch (const UnknownAtomError& error) {
    const Molecule bare = without_hydrogens(given, "PDB2PQR does not know " + error.atom, done);
    if (bare.size() == given.size()) throw;
    prepared.molecule = run_on(bare);
  }
  for (const ClosedChain& chain : closed_chains(given)) {
    const std::string& name = given.residues[chain.front()].chain;
    done.notes.push_back((name.empty() ? "the chain" : "chain " + name) + " is closed, and gets no charged ends");
  }
  note_pieces(given, done.notes);
  restore_residues(prepared.molecule, before, sources, groups.modified);
  charge_caps(prepared.molecule, before, sources, groups.modified, done.force_field);
  append(prepared.molecule, groups.charged);
  if (is_alone) prepared.molecule.radii_origin = ValueOrigin::kFile;
  prepared.molecule.name = molecule.name;
  take_knowledge(before, prepared.molecule);
  const std::size_t n_seen = with_left_out_groups(before).residues.size() - before.residues.size();
  before = without_sources(before, sources, is_left_out);
  prepared.molecule.left_out = molecule.left_out;
  prepared.molecule.left_out.insert(prepared.molecule.left_out.end(), groups.additives.begin(), groups.additives.end());
  done.groups = std::move(groups.lines);
  done.warnings.insert(done.warnings.end(), groups.warnings.begin(), groups.warnings.end());
  if (with_propka && done.propka && n_seen > 0)
    done.notes.push_back("PROPKA saw " + std::to_string(n_seen) + (n_seen == 1 ? " group" : " groups") +
                         " beside the chains that the molecule leaves out");
  done.program = is_alone ? without_chains : run.version();
  if (is_alone) done.force_field = "none";
  done.ph = options.ph;
  done.ligands = used_files(ligands, ligand_of);
  done.ligands.insert(done.ligands.end(), groups.definitions.begin(), groups.definitions.end());
  done.from_cache = !is_alone && run.all_from_cache();
  compare_with_input(before, prepared.molecule, done);
  done.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return prepared;
}

}  // namespace espdiff
