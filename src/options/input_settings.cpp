// input_settings.cpp: the rows of the settings that say which atoms are compared and where their charges come from.
#include "options/input_settings.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "base/molecule/surface_parts.h"
#include "base/text/printable.h"
#include "options/cause_settings.h"
#include "options/options.h"
#include "options/settings.h"

namespace espdiff {
namespace {

using Rows = RowsOf<CompareOptions>;

/// A list of files; setting it again adds to it.
Setting ligand_row() {
  Setting row = Rows::parsed(
      "ligand", kChargeGroup,
      [](CompareOptions& o, const std::string& text) {
        std::istringstream list(text);
        for (std::string path; std::getline(list, path, ',');) {
          if (!path.empty()) o.input.charges.ligands.push_back(path);
        }
      },
      [](const CompareOptions& o) {
        std::string text;
        for (const std::string& path : o.input.charges.ligands) text += (text.empty() ? "" : ",") + path;
        return text;
      },
      "MOL2 file of a ligand in the structures, with its hydrogens, for which PDB2PQR assigns charges (PEOE), or its "
      "definition in the Chemical Component Dictionary (.cif), whose bonds Open Babel takes; may be given several "
      "times");
  row.is_list = row.is_file = true;
  return row;
}

void add_structure_rows(std::vector<Setting>& all) {
  const char* const group = kStructureGroup;
  all.push_back(of_surface(Rows::text(
      "select", group, [](auto& o) -> auto& { return o.input.both.select; },
      "Atoms of both files that make surface and charges, in gemmi's syntax: //A is chain A, //A/10-20, (HEM), "
      "//A;polymer; several, separated by blanks, add up. Default: all")));
  all.push_back(Rows::text(
      "source-select", group, [](auto& o) -> auto& { return o.input.source.select; },
      "The same, of the source's file alone"));
  all.push_back(Rows::text(
      "target-select", group, [](auto& o) -> auto& { return o.input.target.select; },
      "The same, of the target's file alone"));
  all.push_back(of_surface(Rows::text(
      "leave-out", group, [](auto& o) -> auto& { return o.input.leave_out; },
      "Atoms to leave out of both states, such as ligands without charges: (SO4,GOL)")));
  all.push_back(of_surface(Rows::text(
      "assembly", group, [](auto& o) -> auto& { return o.input.assembly; },
      "Biological assembly to build from the entry (REMARK 350, _pdbx_struct_assembly), by its name, such as 1. "
      "Default: the atoms of the file")));
  all.push_back(of_surface(Rows::choice(
      "radii", group, {"auto", "file", "element"},
      [](CompareOptions& o, const std::string& text) {
        o.input.radii = text == "file"      ? RadiiChoice::kFile
                        : text == "element" ? RadiiChoice::kElement
                                            : RadiiChoice::kAuto;
      },
      [](const CompareOptions& o) {
        return o.input.radii == RadiiChoice::kFile      ? "file"
               : o.input.radii == RadiiChoice::kElement ? "element"
                                                        : "auto";
      },
      "Radii of the compared surfaces: the files' (file), Bondi's (element), or the files' if all states have them "
      "from "
      "one force field and Bondi's otherwise (auto). The dielectric boundary always takes the force field's")));
}

void add_charge_rows(std::vector<Setting>& all) {
  const char* const group = kChargeGroup;
  all.push_back(of_surface(Rows::word(
      "force-field", group, {"auto", "parse", "amber", "charmm", "tyl06", "peoepb", "swanson"},
      [](auto& o) -> auto& { return o.input.charges.force_field; },
      "Charges and radii for structures without charges, assigned by PDB2PQR; auto: PARSE, or AMBER where there are "
      "nucleotides")));
  all.push_back(of_surface(Rows::number(
      "ph", group, {0, 14}, [](auto& o) -> auto& { return o.input.charges.ph; },
      "pH at which PROPKA chooses protonation states")));
  all.push_back(of_surface(ligand_row()));
  all.push_back(of_surface(Rows::choice(
      "ligands", group, {"auto", "files"},
      [](CompareOptions& o, const std::string& text) { o.input.charges.ligands_auto = text == "auto"; },
      [](const CompareOptions& o) { return o.input.charges.ligands_auto ? "auto" : "files"; },
      "Ligands without a MOL2 file: hydrogens and charges by Open Babel (auto), or refused (files)")));
  all.push_back(Rows::boolean(
      "same-protonation", group, [](auto& o) -> auto& { return o.input.charges.same_protonation; },
      "Residues of the target take the protonation states of the source's residues they pair with"));
  all.push_back(of_surface(Rows::boolean(
      "cache", group, [](auto& o) -> auto& { return o.input.charges.use_cache; },
      "Reuse prepared structures from the cache (XDG_CACHE_HOME), by their content")));
  all.push_back(of_surface(Rows::file(
      "topology", group, [](auto& o) -> auto& { return o.input.both.topology; },
      "PSF or Amber prmtop with the charges of both files' atoms, in their order")));
  all.push_back(Rows::file(
      "source-topology", group, [](auto& o) -> auto& { return o.input.source.topology; },
      "The same, for the source alone"));
  all.push_back(Rows::file(
      "target-topology", group, [](auto& o) -> auto& { return o.input.target.topology; },
      "The same, for the target alone"));
  all.push_back(of_surface(Rows::file(
      "charges-from", group, [](auto& o) -> auto& { return o.input.charges_from; },
      "PQR file of another state of the molecule; states without charges take its charges and radii, atom by atom")));
}

/// Letters, digits and `_`, `-`, `.`: a name is part of columns, of JSON's keys and of Tcl's words.
void check_patch_name(const std::string& name, const std::string& text) {
  constexpr std::size_t kLongest = 40;
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const bool good = !name.empty() && is_letter(name.front()) && std::all_of(name.begin(), name.end(), [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
  });
  if (!good || name.size() > kLongest)
    throw InputError(option("patch") + ": the name '" + printable(name) + "' of '" + printable(text) +
                     "' is not a letter followed by letters, digits, _, - and . (at most " + std::to_string(kLongest) +
                     " in all)");
  if (name == kRegionPart)
    throw InputError(option("patch") + ": the name 'region' is that of " + option("region") + "; take another one");
}

PatchRequest parse_patch(const std::string& text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos || text.find_first_not_of(' ', sign + 1) == std::string::npos)
    throw InputError(option("patch") + ": '" + printable(text) + "' is not NAME=SELECTION, such as site=//A/8-12");
  PatchRequest patch{text.substr(0, sign), text.substr(sign + 1)};
  check_patch_name(patch.name, text);
  return patch;
}

/// A list of named selections; setting it again adds to it.
Setting patch_row() {
  Setting row = Rows::parsed(
      "patch", kRegionGroup,
      [](CompareOptions& o, const std::string& text) {
        for (PatchRequest& patch : parse_patches(text)) o.input.patches.push_back(std::move(patch));
      },
      [](const CompareOptions& o) {
        std::string text;
        for (const PatchRequest& patch : o.input.patches)
          text += (text.empty() ? "" : "|") + patch.name + "=" + patch.selection;
        return text;
      },
      "A name, and residues of the source (of an ensemble: of the template) in gemmi's syntax, whose surface is "
      "measured as a whole; numbers are named after it. Instead of residues OUT.json:N, significant patch N of "
      "an earlier ensemble. Several may be given");
  row.is_list = row.is_named = true;
  return row;
}

void add_region_rows(std::vector<Setting>& all) {
  const char* const group = kRegionGroup;
  all.push_back(Rows::text(
      "region", group, [](auto& o) -> auto& { return o.input.region; },
      "Residues of the source for which metrics and certificate are reported as well, in gemmi's syntax"));
  all.push_back(Rows::number(
      "region-within", group, {0, 1000}, [](auto& o) -> auto& { return o.input.region_within_A; },
      "The region is the source's residues with an atom within this distance of other atoms (of), Angstrom"));
  all.push_back(Rows::text(
      "of", group, [](auto& o) -> auto& { return o.input.region_of; },
      "Atoms that the region is near to, such as a ligand or another chain; they need not be compared"));
  all.push_back(patch_row());
  add_cause_settings(all);
}

}  // namespace

std::vector<PatchRequest> parse_patches(const std::string& text) {
  std::vector<PatchRequest> patches;
  std::istringstream list(text);
  for (std::string entry; std::getline(list, entry, '|');) patches.push_back(parse_patch(entry));
  return patches;
}

std::vector<std::string> part_names(const InputOptions& options) {
  std::vector<std::string> names;
  if (options.has_region()) names.emplace_back(kRegionPart);
  for (const PatchRequest& patch : options.patches) names.push_back(patch.name);
  return names;
}

std::vector<std::string> part_names(const std::vector<std::pair<std::string, std::string>>& settings) {
  InputOptions options;
  for (const auto& [name, text] : settings) {
    if (name == "region") options.region = text;
    if (name == "of") options.region_of = text;
    if (name == "patch") options.patches = parse_patches(text);
  }
  return part_names(options);
}

void add_input_settings(std::vector<Setting>& all) {
  add_structure_rows(all);
  add_charge_rows(all);
  add_region_rows(all);
}

bool is_of_preparation(const Setting& setting) {
  const bool of_side = setting.name.rfind("source-", 0) == 0 || setting.name.rfind("target-", 0) == 0;
  if (of_side || setting.name == "radii" || setting.name == "same-protonation") return false;
  return setting.group == kStructureGroup || setting.group == kChargeGroup;
}

void check_input_options(const InputOptions& o) {
  const auto both = [](const char* a, const char* b) {
    throw InputError(option(a) + " and " + option(b) + " were given; leave one of them out");
  };
  if (!o.both.select.empty() && !o.source.select.empty()) both("select", "source-select");
  if (!o.both.select.empty() && !o.target.select.empty()) both("select", "target-select");
  if (!o.both.topology.empty() && !o.source.topology.empty()) both("topology", "source-topology");
  if (!o.both.topology.empty() && !o.target.topology.empty()) both("topology", "target-topology");
  const bool has_topology = !o.both.topology.empty() || !o.source.topology.empty() || !o.target.topology.empty();
  if (has_topology && !o.charges_from.empty()) both("topology", "charges-from");
  if (!o.region.empty() && !o.region_of.empty()) both("region", "of");
  if (o.region_of.empty() != (o.region_within_A == 0))
    throw InputError(option("region-within") + " and " + option("of") +
                     " belong together: the region is within a distance (above 0) of atoms");
  for (std::size_t i = 0; i < o.patches.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (o.patches[i].name == o.patches[j].name)
        throw InputError(option("patch") + ": the name " + o.patches[i].name + " is given twice; name each patch once");
    }
  }
}

}  // namespace espdiff
