// input_settings.cpp: the rows of the settings that say which atoms are compared and where their charges come from.
#include "options/input_settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/molecule/surface_parts.h"
#include "base/text/printable.h"
#include "options/options.h"
#include "options/settings.h"

namespace espdiff {
namespace {

/// A setting that is a text; `at` finds it in the options.
template <typename At>
Setting text_row(const std::string& name, const char* group, At at, const std::string& help, bool is_file = false) {
  Setting row{name, group, SettingKind::kText, {}, help, false, nullptr, nullptr};
  row.set = [at](CompareOptions& o, const std::string& text) { at(o.input) = text; };
  row.get = [at](const CompareOptions& o) { return at(o.input); };
  row.is_file = is_file;
  return row;
}

template <typename At>
Setting boolean_row(const std::string& name, const char* group, At at, const std::string& help) {
  Setting row{name, group, SettingKind::kBoolean, {}, help, false, nullptr, nullptr};
  row.set = [name, at](CompareOptions& o, const std::string& text) {
    if (text != "0" && text != "1") refuse_value(name, text, "0 or 1");
    at(o.input) = text == "1";
  };
  row.get = [at](const CompareOptions& o) { return at(o.input) ? "1" : "0"; };
  return row;
}

template <typename At>
Setting number_row(const std::string& name, const char* group, double low, double high, const char* accepted, At at,
                   const std::string& help) {
  Setting row{name, group, SettingKind::kNumber, {}, help, false, nullptr, nullptr};
  row.set = [=](CompareOptions& o, const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    if (!whole || !std::isfinite(value) || value < low || value > high) refuse_value(name, text, accepted);
    at(o.input) = value;
  };
  row.get = [at](const CompareOptions& o) {
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof text, at(o.input)).ptr);
  };
  return row;
}

Setting choice_row(const std::string& name, const char* group, std::vector<std::string> choices,
                   const std::function<void(InputOptions&, const std::string&)>& set,
                   const std::function<std::string(const InputOptions&)>& get, const std::string& help) {
  Setting row{name, group, SettingKind::kChoice, choices, help, false, nullptr, nullptr};
  std::string list;
  for (std::size_t i = 0; i < choices.size(); ++i)
    list += (i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ") + choices[i];
  row.set = [=](CompareOptions& o, const std::string& text) {
    if (std::find(choices.begin(), choices.end(), text) == choices.end()) refuse_value(name, text, list);
    set(o.input, text);
  };
  row.get = [get](const CompareOptions& o) { return get(o.input); };
  return row;
}

/// A list of files; setting it again adds to it.
Setting ligand_row() {
  Setting row{"ligand",
              kChargeGroup,
              SettingKind::kText,
              {},
              "MOL2 file of a ligand in the structures, with its hydrogens, for which PDB2PQR assigns charges (PEOE); "
              "may be given several times",
              false,
              nullptr,
              nullptr};
  row.set = [](CompareOptions& o, const std::string& text) {
    std::istringstream list(text);
    for (std::string path; std::getline(list, path, ',');) {
      if (!path.empty()) o.input.charges.ligands.push_back(path);
    }
  };
  row.get = [](const CompareOptions& o) {
    std::string text;
    for (const std::string& path : o.input.charges.ligands) text += (text.empty() ? "" : ",") + path;
    return text;
  };
  row.is_list = row.is_file = true;
  return row;
}

void add_structure_rows(std::vector<Setting>& all) {
  const char* const group = kStructureGroup;
  all.push_back(of_surface(text_row(
      "select", group, [](auto& o) -> auto& { return o.both.select; },
      "Atoms of both files that make surface and charges, in gemmi's syntax: //A is chain A, //A/10-20, (HEM), "
      "//A;polymer; several, parted by blanks, add up. Default: all")));
  all.push_back(text_row(
      "source-select", group, [](auto& o) -> auto& { return o.source.select; },
      "The same, of the source's file alone"));
  all.push_back(text_row(
      "target-select", group, [](auto& o) -> auto& { return o.target.select; },
      "The same, of the target's file alone"));
  all.push_back(of_surface(text_row(
      "leave-out", group, [](auto& o) -> auto& { return o.leave_out; },
      "Atoms to leave out of both states, such as ligands without charges: (SO4,GOL)")));
  all.push_back(of_surface(text_row(
      "assembly", group, [](auto& o) -> auto& { return o.assembly; },
      "Biological assembly to build from the entry (REMARK 350, _pdbx_struct_assembly), by its name, such as 1. "
      "Default: the atoms of the file")));
  all.push_back(of_surface(choice_row(
      "radii", group, {"auto", "file", "element"},
      [](InputOptions& o, const std::string& text) {
        o.radii = text == "file" ? RadiiChoice::kFile : text == "element" ? RadiiChoice::kElement : RadiiChoice::kAuto;
      },
      [](const InputOptions& o) {
        return o.radii == RadiiChoice::kFile ? "file" : o.radii == RadiiChoice::kElement ? "element" : "auto";
      },
      "Radii of the compared surfaces: the files' (file), Bondi's (element), or the files' if all states have them "
      "from "
      "one force field and Bondi's otherwise (auto). The dielectric boundary always takes the force field's")));
}

void add_charge_rows(std::vector<Setting>& all) {
  const char* const group = kChargeGroup;
  all.push_back(of_surface(choice_row(
      "force-field", group, {"auto", "parse", "amber", "charmm", "tyl06", "peoepb", "swanson"},
      [](InputOptions& o, const std::string& text) { o.charges.force_field = text; },
      [](const InputOptions& o) { return o.charges.force_field; },
      "Charges and radii for structures without charges, assigned by PDB2PQR; auto: PARSE, or AMBER where there are "
      "nucleotides")));
  all.push_back(of_surface(number_row(
      "ph", group, 0, 14, "a pH from 0 to 14", [](auto& o) -> auto& { return o.charges.ph; },
      "pH at which PROPKA chooses protonation states")));
  all.push_back(of_surface(ligand_row()));
  all.push_back(of_surface(choice_row(
      "ligands", group, {"auto", "files"},
      [](InputOptions& o, const std::string& text) { o.charges.ligands_auto = text == "auto"; },
      [](const InputOptions& o) { return o.charges.ligands_auto ? "auto" : "files"; },
      "Ligands without a MOL2 file: hydrogens and charges by Open Babel (auto), or refused (files)")));
  all.push_back(boolean_row(
      "same-protonation", group, [](auto& o) -> auto& { return o.charges.same_protonation; },
      "Residues of the target take the protonation states of the source's residues they pair with"));
  all.push_back(of_surface(boolean_row(
      "cache", group, [](auto& o) -> auto& { return o.charges.use_cache; },
      "Reuse prepared structures from the cache (XDG_CACHE_HOME), by their content")));
  all.push_back(of_surface(text_row(
      "topology", group, [](auto& o) -> auto& { return o.both.topology; },
      "PSF or Amber prmtop with the charges of both files' atoms, in their order", true)));
  all.push_back(text_row(
      "source-topology", group, [](auto& o) -> auto& { return o.source.topology; }, "The same, for the source alone",
      true));
  all.push_back(text_row(
      "target-topology", group, [](auto& o) -> auto& { return o.target.topology; }, "The same, for the target alone",
      true));
  all.push_back(of_surface(text_row(
      "charges-from", group, [](auto& o) -> auto& { return o.charges_from; },
      "PQR file of another state of the molecule; states without charges take its charges and radii, atom by atom",
      true)));
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
  Setting row{
      "patch",
      kRegionGroup,
      SettingKind::kText,
      {},
      "A name, and residues of the source (of an ensemble: of the template) in gemmi's syntax, whose surface is "
      "measured as a whole; numbers are named after it. Instead of residues OUT.json:N, significant patch N of "
      "an earlier ensemble. Several may be given",
      false,
      nullptr,
      nullptr};
  row.set = [](CompareOptions& o, const std::string& text) {
    for (PatchRequest& patch : parse_patches(text)) o.input.patches.push_back(std::move(patch));
  };
  row.get = [](const CompareOptions& o) {
    std::string text;
    for (const PatchRequest& patch : o.input.patches)
      text += (text.empty() ? "" : "|") + patch.name + "=" + patch.selection;
    return text;
  };
  row.is_list = row.is_named = true;
  return row;
}

void add_region_rows(std::vector<Setting>& all) {
  const char* const group = kRegionGroup;
  all.push_back(text_row(
      "region", group, [](auto& o) -> auto& { return o.region; },
      "Residues of the source for which metrics and certificate are reported as well, in gemmi's syntax"));
  all.push_back(number_row(
      "region-within", group, 0, 1000, "a distance from 0 to 1000 Angstrom",
      [](auto& o) -> auto& { return o.region_within_A; },
      "The region is the source's residues with an atom within this distance of other atoms (of), Angstrom"));
  all.push_back(text_row(
      "of", group, [](auto& o) -> auto& { return o.region_of; },
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
