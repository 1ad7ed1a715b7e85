// read_gemmi.cpp: from gemmi's structures to ours: alternate locations, elements, file order.
#include "io/structures/formats/read_gemmi.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gemmi/cif.hpp>    // for read_memory
#include <gemmi/mmcif.hpp>  // for make_structure
#include <gemmi/numb.hpp>   // for as_number
#include <gemmi/pdb.hpp>    // for read_pdb_from_memory
#include <limits>
#include <set>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/memory.h"
#include "io/molecules/molecule_builder.h"
#include "io/structures/call_gemmi.h"
#include "io/structures/formats/build_assembly.h"
#include "io/structures/formats/pdb_text.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

struct ChosenAtom {
  std::size_t copy;  // of an assembly
  const gemmi::Chain* chain;
  const gemmi::Residue* residue;
  const gemmi::Atom* atom;
};

float occupancy(const gemmi::Atom& atom) { return std::isfinite(atom.occ) ? atom.occ : 0.0F; }

/// Residues of different name at one place (a mutation in part of the crystal): every atom of theirs has a location, or
/// those of one, where the other has locations of the same names, and the atoms that they share (as 1EJG's PRO/SER 22).
bool are_alternatives(const gemmi::Residue& a, const gemmi::Residue& b) {
  if (a.seqid != b.seqid) return false;
  const auto has_location = [](const gemmi::Atom& atom) { return atom.has_altloc(); };
  const auto are_located = [&](const gemmi::Residue& residue) {
    return std::all_of(residue.atoms.begin(), residue.atoms.end(), has_location);
  };
  if (are_located(a) && are_located(b)) return true;
  return (are_located(a) || are_located(b)) && std::any_of(a.atoms.begin(), a.atoms.end(), [&](const gemmi::Atom& own) {
           return own.has_altloc() && std::any_of(b.atoms.begin(), b.atoms.end(), [&](const gemmi::Atom& other) {
                    return other.has_altloc() && other.name == own.name;
                  });
         });
}

/// The location of highest mean occupancy among residues [begin, end), the first on ties; '\0' when there is none.
char best_location(const gemmi::Residue* begin, const gemmi::Residue* end) {
  struct Sum {
    char location;
    double occupancy;
    int n;
  };
  std::vector<Sum> sums;
  for (const gemmi::Residue* residue = begin; residue != end; ++residue) {
    for (const gemmi::Atom& atom : residue->atoms) {
      if (!atom.has_altloc()) continue;
      auto found = std::find_if(sums.begin(), sums.end(), [&](const Sum& sum) { return sum.location == atom.altloc; });
      if (found == sums.end()) found = sums.insert(sums.end(), {atom.altloc, 0, 0});
      found->occupancy += occupancy(atom);
      ++found->n;
    }
  }
  const auto best = std::max_element(sums.begin(), sums.end(), [](const Sum& a, const Sum& b) {
    constexpr double kTie = 1e-6;  // occupancies are given with two decimals
    return a.occupancy / a.n + kTie < b.occupancy / b.n;
  });
  return best == sums.end() ? '\0' : best->location;
}

/// Keeps one atom of each name that has locations, and all atoms of names that have none (but not twice at one place).
void choose_atoms(std::size_t copy, const gemmi::Chain& chain, const gemmi::Residue& residue, char best,
                  std::vector<ChosenAtom>& chosen) {
  std::unordered_map<std::string, const gemmi::Atom*> of_name;  // the choice, for names with locations
  for (const gemmi::Atom& atom : residue.atoms) {
    if (atom.has_altloc()) of_name.emplace(atom.name, nullptr);
  }
  for (const gemmi::Atom& atom : residue.atoms) {
    const auto found = of_name.find(atom.name);
    if (found == of_name.end()) continue;
    const gemmi::Atom*& choice = found->second;
    const bool is_best = atom.altloc == best;
    const bool choice_is_best = choice != nullptr && choice->altloc == best;
    const bool more = choice == nullptr || occupancy(atom) > occupancy(*choice);
    if (is_best ? !choice_is_best : !choice_is_best && more) choice = &atom;
  }
  std::set<std::tuple<std::string, double, double, double>> seen;
  for (const gemmi::Atom& atom : residue.atoms) {
    const auto found = of_name.find(atom.name);
    const bool keep = found == of_name.end() ? seen.emplace(atom.name, atom.pos.x, atom.pos.y, atom.pos.z).second
                                             : found->second == &atom;
    if (keep) chosen.push_back({copy, &chain, &residue, &atom});
  }
}

/// Of residues at one place the one with the best location, and the atoms without one that the others hold for all.
void choose_residue(std::size_t copy, const gemmi::Chain& chain, const gemmi::Residue* begin, const gemmi::Residue* end,
                    char best, std::vector<ChosenAtom>& chosen) {
  const auto has_best = [best](const gemmi::Residue& residue) {
    return std::any_of(residue.atoms.begin(), residue.atoms.end(),
                       [best](const gemmi::Atom& atom) { return atom.altloc == best; });
  };
  const gemmi::Residue* const kept = end - begin > 1 ? std::find_if(begin, end, has_best) : begin;
  for (const gemmi::Residue* residue = begin; residue != end; ++residue) {
    if (residue == kept) {
      choose_atoms(copy, chain, *kept, best, chosen);
      continue;
    }
    for (const gemmi::Atom& atom : residue->atoms) {
      if (!atom.has_altloc() && kept->find_atom(atom.name, '*') == nullptr)
        chosen.push_back({copy, &chain, kept, &atom});
    }
  }
}

/// One conformation of the model, by serial number, which is file order (gemmi gathers the atoms of a chain's residue).
/// The chains of an assembly follow each other instead: their copies share serial numbers.
std::vector<ChosenAtom> choose_conformation(const gemmi::Model& model, bool is_assembly) {
  std::vector<ChosenAtom> chosen;
  for (const gemmi::Chain& chain : model.chains) {
    const std::size_t copy = is_assembly ? static_cast<std::size_t>(&chain - model.chains.data()) : 0;
    const gemmi::Residue* const end = chain.residues.data() + chain.residues.size();
    for (const gemmi::Residue* begin = chain.residues.data(); begin != end;) {
      const gemmi::Residue* group_end = begin + 1;
      while (group_end != end && are_alternatives(*begin, *group_end)) ++group_end;
      const char best = best_location(begin, group_end);
      choose_residue(copy, chain, begin, group_end, best, chosen);
      begin = group_end;
    }
  }
  std::stable_sort(chosen.begin(), chosen.end(), [](const ChosenAtom& a, const ChosenAtom& b) {
    return std::tie(a.copy, a.atom->serial) < std::tie(b.copy, b.atom->serial);
  });
  return chosen;
}

AtomEntry make_entry(const ChosenAtom& chosen) {
  AtomEntry entry;
  entry.name = chosen.atom->name;
  if (chosen.atom->element != gemmi::El::X) entry.element = chosen.atom->element.name();
  entry.residue_name = chosen.residue->name;
  entry.chain = chosen.chain->name;
  entry.residue_number = chosen.residue->seqid.num.has_value() ? *chosen.residue->seqid.num : 0;
  entry.insertion_code = chosen.residue->seqid.has_icode() ? chosen.residue->seqid.icode : ' ';
  entry.hetero = chosen.residue->het_flag == 'H';
  entry.position = {chosen.atom->pos.x, chosen.atom->pos.y, chosen.atom->pos.z};
  // A whole column of zeros says nothing; see knows_places().
  entry.b_factor = chosen.atom->b_iso;
  entry.occupancy = chosen.atom->occ;
  entry.has_alternates = chosen.atom->altloc != '\0';
  return entry;
}

// ---- mmCIF ----

/// gemmi keeps each word as a string, in a vector that doubles, and then makes atoms of them.
constexpr double kBytesOfCifWord = 2.5 * sizeof(std::string);

std::size_t count_words(const std::string& text) {
  std::size_t n = 0;
  bool is_inside = false;
  for (const char c : text) {
    const bool is_blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    n += !is_blank && !is_inside ? 1 : 0;
    is_inside = !is_blank;
  }
  return n;
}

std::map<std::string, ChemicalFormula> formulas_of(gemmi::cif::Block& block) {
  std::map<std::string, ChemicalFormula> formulas;
  for (const auto row : block.find("_chem_comp.", {"id", "formula"})) {
    if (auto formula = parse_formula(row.str(1))) formulas.emplace(row.str(0), std::move(*formula));
  }
  return formulas;
}

/// Parses the file and keeps the atoms only, so that a mistake elsewhere in it does no harm.
/// @param formulas receives those of the file's residues
gemmi::cif::Document parse_atom_site(const std::string& path, const std::string& text, bool with_assemblies,
                                     std::map<std::string, ChemicalFormula>& formulas) {
  require_memory(kBytesOfCifWord * static_cast<double>(count_words(text)), path);
  gemmi::cif::Document document = call_gemmi(
      path, "not valid CIF: ", [&] { return gemmi::cif::read_memory(text.data(), text.size(), path.c_str()); });
  if (!document.blocks.empty()) formulas = formulas_of(document.blocks.front());
  for (gemmi::cif::Block& block : document.blocks) {
    std::vector<gemmi::cif::Item> kept;  // not erase(): assigning items loses their line numbers
    const auto keep = [&](const char* prefix) {
      for (gemmi::cif::Item& item : block.items) {
        if (item.has_prefix(prefix)) kept.push_back(std::move(item));
      }
    };
    keep("_atom_site.");  // first
    if (with_assemblies) {
      keep("_pdbx_struct_assembly");
      keep("_pdbx_struct_oper_list");
    }
    block.items = std::move(kept);
  }
  return document;
}

/// Line of a table's row, where the file has one row a line and no comments between (all known writers); otherwise the
/// table's.
long row_line(const std::string& text, const gemmi::cif::Item& item, std::size_t row, const std::string& value) {
  const long first = item.line_number > 0 ? item.line_number : 0;
  if (item.type != gemmi::cif::ItemType::Loop) return first;
  for (long guess : {first + static_cast<long>(item.loop.tags.size() + row),
                     first + 1 + static_cast<long>(item.loop.tags.size() + row)}) {
    TextCursor cursor(text, value);
    for (long i = 1; i < guess; ++i) cursor.rest_of_line();
    const auto words = split_words(cursor.rest_of_line());
    if (words.size() == item.loop.tags.size() && std::find(words.begin(), words.end(), value) != words.end())
      return guess;
  }
  return first;
}

/// Two other kinds of CIF have no atoms of a macromolecule.
void refuse_other_kinds(const std::string& path, const std::string& text) {
  if (text.find("_atom_site_fract_x") != std::string::npos)
    throw InputError(
        path + ": is the CIF of a crystal of small molecules, whose atoms lie in fractions of its cell; `obabel " +
        path + " -O " + std::filesystem::path(path).replace_extension(".mol2").string() +
        "` writes them with charges; give that");
  if (text.find("_chem_comp_atom.") != std::string::npos)
    throw InputError(path +
                     ": describes chemical components (_chem_comp_atom), no structure; give a structure that "
                     "contains them, with this file for their bonds (" +
                     option("ligand", "FILE") + "), or a MOL2 file: `obabel LIGAND.sdf -O LIGAND.mol2` writes one");
}

void check_atom_site(const std::string& path, const std::string& text, gemmi::cif::Block& block) {
  if (block.items.empty()) refuse_other_kinds(path, text);
  for (const char* column : {"id", "type_symbol", "label_asym_id", "Cartn_x", "Cartn_y", "Cartn_z", "auth_seq_id"}) {
    // PyMOL writes no numbers of authors.
    const bool has_other = column == std::string_view("auth_seq_id") && block.find_values("_atom_site.label_seq_id");
    if (!has_other && !block.find_values(std::string("_atom_site.") + column)) {
      throw InputError(path + ": mmCIF without the column _atom_site." + column +
                       (block.items.empty() ? " (no atoms at all)" : "") +
                       "; give a macromolecular mmCIF with coordinates");
    }
  }
  gemmi::cif::Table table = block.find("_atom_site.", {"Cartn_x", "Cartn_y", "Cartn_z"});
  for (std::size_t row = 0; row < table.length(); ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string& value = table[static_cast<int>(row)][axis];
      if (std::isfinite(gemmi::cif::as_number(value))) continue;
      throw FormatError(path, row_line(text, block.items.front(), row, value),
                        std::string("_atom_site.Cartn_") + "xyz"[axis] + " of atom " + std::to_string(row + 1) +
                            " is " + in_quotes(value) + "; a finite number was expected");
    }
  }
}

/// A column that gemmi insists on and the file lacks.
struct MissingColumn {
  const char* name;
  const char* value;  ///< in every row, where there is no other column to take it from
  const char* other;
};

void add_missing_columns(gemmi::cif::Block& block) {
  for (const MissingColumn& missing : {MissingColumn{"label_alt_id", ".", nullptr},
                                       {"occupancy", "1", nullptr},
                                       {"B_iso_or_equiv", "0", nullptr},
                                       {"auth_seq_id", ".", "label_seq_id"}}) {
    const std::string tag = std::string("_atom_site.") + missing.name;
    if (block.find_values(tag)) continue;
    std::vector<std::string> column;
    if (missing.other != nullptr) {
      const gemmi::cif::Column other = block.find_values(std::string("_atom_site.") + missing.other);
      column.assign(other.begin(), other.end());
    }
    const auto value_of = [&](std::size_t row) { return row < column.size() ? column[row] : missing.value; };
    gemmi::cif::Item& first = block.items.front();
    if (first.type != gemmi::cif::ItemType::Loop) {
      block.items.emplace_back(tag, value_of(0));  // one atom, as pairs of tag and value
      continue;
    }
    const std::size_t width = first.loop.tags.size();
    std::vector<std::string> values;
    values.reserve(first.loop.values.size() / width * (width + 1));
    for (std::size_t i = 0; i < first.loop.values.size(); ++i) {
      values.push_back(std::move(first.loop.values[i]));
      if ((i + 1) % width == 0) values.push_back(value_of(i / width));
    }
    first.loop.values = std::move(values);
    first.loop.tags.push_back(tag);
  }
}

/// A residue's number, with an insertion code behind it perhaps; or unknown, as of water.
void check_residue_numbers(const std::string& path, const std::string& text, gemmi::cif::Block& block) {
  gemmi::cif::Column column = block.find_values("_atom_site.auth_seq_id");
  for (int row = 0; row < column.length(); ++row) {
    const std::string& value = column[row];
    if (gemmi::cif::is_null(value)) continue;
    const std::string raw = gemmi::cif::as_string(value);
    const bool has_code = !raw.empty() && (raw.back() < '0' || raw.back() > '9');
    long long number = 0;
    if (parse_integer(std::string_view(raw).substr(0, raw.size() - (has_code ? 1 : 0)), number) &&
        std::abs(number) <= std::numeric_limits<int>::max())
      continue;
    throw FormatError(path, row_line(text, block.items.front(), static_cast<std::size_t>(row), value),
                      "_atom_site.auth_seq_id of atom " + std::to_string(row + 1) + " is " + in_quotes(value) +
                          "; an integer below 2^31 in size was expected");
  }
}

/// gemmi converts these without a look at their size.
void check_integers(const std::string& path, const std::string& text, gemmi::cif::Block& block) {
  for (const char* const name : {"id", "label_seq_id", "pdbx_PDB_model_num", "pdbx_formal_charge"}) {
    gemmi::cif::Column column = block.find_values(std::string("_atom_site.") + name);
    for (int row = 0; row < column.length(); ++row) {
      const std::string& value = column[row];
      constexpr std::size_t kShort = 9;  // digits that always fit
      if (value.size() <= kShort) continue;
      // What stands before anything else is converted first.
      const std::string raw = gemmi::cif::as_string(value);
      const std::size_t first = std::min(raw.find_first_of("0123456789"), raw.size());
      const std::size_t n_digits = std::min(raw.find_first_not_of("0123456789", first), raw.size()) - first;
      long long number = 0;
      if (n_digits <= kShort || (parse_integer(std::string_view(raw).substr(first, n_digits), number) &&
                                 number <= std::numeric_limits<int>::max()))
        continue;
      throw FormatError(path, row_line(text, block.items.front(), static_cast<std::size_t>(row), value),
                        std::string("_atom_site.") + name + " of atom " + std::to_string(row + 1) + " is " +
                            in_quotes(value) + "; an integer below 2^31 in size was expected");
    }
  }
}

struct ParsedCif {
  gemmi::Structure structure;
  std::map<std::string, ChemicalFormula> formulas;
  std::size_t n_operations = 0;  ///< of the assembly
};

ParsedCif parse_mmcif(const std::string& path, const std::string& text, const std::string& assembly = "") {
  ParsedCif parsed;
  gemmi::cif::Document document = parse_atom_site(path, text, !assembly.empty(), parsed.formulas);
  if (document.blocks.empty()) throw InputError(path + ": CIF without a data block; give an mmCIF with coordinates");
  check_atom_site(path, text, document.blocks.front());
  check_residue_numbers(path, text, document.blocks.front());
  check_integers(path, text, document.blocks.front());
  if (!assembly.empty()) parsed.n_operations = check_operations(path, document.blocks.front(), assembly);
  add_missing_columns(document.blocks.front());
  // gemmi 0.6 takes the document for itself; 0.5 only looks at it.
  parsed.structure =
      call_gemmi(path, "the mmCIF cannot be read: ", [&] { return gemmi::make_structure(std::move(document)); });
  return parsed;
}

}  // namespace

Molecule read_pdb(const std::string& path, const AtomModel& model, const std::string& remarks,
                  const StructureOptions& options) {
  constexpr double kBytesOfLine = 600;  // a copy of the line, gemmi's atom, and what it is chosen by
  require_memory(kBytesOfLine * static_cast<double>(model.size()), path);
  MoleculeBuilder builder(path, options);
  const CheckedPdb checked = check_pdb(path, model, builder);
  const std::string text = remarks + checked.text;
  gemmi::Structure structure = call_gemmi(
      path, "the PDB cannot be read: ", [&] { return gemmi::read_pdb_from_memory(text.data(), text.size(), path); });
  const bool is_assembly = !options.assembly.empty();
  if (is_assembly && !structure.models.empty())
    build_assembly(path, structure, options.assembly, check_biomt(path, remarks, options.assembly),
                   structure.models.front());
  const auto line_of = [&](const gemmi::Atom& atom) -> const AtomLine& {
    return checked.lines.at(static_cast<std::size_t>(atom.serial) - 1);
  };
  for (const ChosenAtom& chosen : choose_conformation(structure.models.front(), is_assembly)) {
    const AtomLine& line = line_of(*chosen.atom);
    AtomEntry entry = make_entry(chosen);
    entry.residue_name = pdb_residue_name(line_of(chosen.residue->atoms.front()));
    if (!is_assembly) entry.chain = pdb_chain_name(line);
    entry.hetero = line.is_hetatm();
    entry.line = line.number;
    if (!has_pdb_element(line)) entry.element.clear();  // gemmi's guess does not know the residue
    builder.add(entry);
  }
  return builder.finish();
}

Molecule read_mmcif(const std::string& path, const std::string& text, const StructureOptions& options) {
  const bool is_assembly = !options.assembly.empty();
  ParsedCif parsed = parse_mmcif(path, text, options.assembly);
  gemmi::Structure& structure = parsed.structure;
  const int n_models = static_cast<int>(structure.models.size());
  if (options.model < 1 || options.model > n_models) {
    throw InputError(n_models == 0 ? path + ": has no atoms; give a structure with atoms"
                                   : path + ": model " + std::to_string(options.model) +
                                         " was asked for, but the file has models 1 to " + std::to_string(n_models));
  }
  MoleculeBuilder builder(path, options);
  gemmi::Model& model = structure.models[static_cast<std::size_t>(options.model) - 1];
  if (is_assembly) build_assembly(path, structure, options.assembly, parsed.n_operations, model);
  for (const ChosenAtom& chosen : choose_conformation(model, is_assembly)) {
    const AtomEntry entry = make_entry(chosen);
    if (builder.wants(entry.residue_name, entry.hetero)) builder.add(entry);
  }
  Molecule molecule = builder.finish();
  molecule.formulas = std::move(parsed.formulas);
  return molecule;
}

int count_mmcif_models(const std::string& path, const std::string& text) {
  return static_cast<int>(parse_mmcif(path, text).structure.models.size());
}

}  // namespace espdiff
