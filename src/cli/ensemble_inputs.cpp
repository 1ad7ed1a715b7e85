// ensemble_inputs.cpp: reads groups, lists and charges, and loads frames.
#include "cli/ensemble_inputs.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "align/pair_atoms.h"
#include "align/superpose.h"
#include "base/error.h"
#include "base/version.h"
#include "cli/map_options.h"
#include "cli/options.h"
#include "compare/settings.h"
#include "ensemble/medoid.h"
#include "io/read_csv.h"
#include "io/sha256.h"
#include "io/structure_file.h"
#include "prepare/load_state.h"
#include "prepare/surface_radii.h"
#include "prepare/take_charges.h"
#include "trajectory/frame_range.h"

namespace espdiff::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMedoidOf = "medoid:";

/// "wild_1" of "runs/wild_1.pdb.gz".
std::string name_of_file(const std::string& path) {
  const std::string name = fs::path(path).filename().string();
  return name.substr(0, name.find('.'));
}

std::string sha256_of_molecule(const Molecule& molecule) {
  Sha256 sum;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    sum.update(molecule.atoms[i].name.data(), molecule.atoms[i].name.size());
    sum.update(&molecule.atoms[i].residue, sizeof molecule.atoms[i].residue);
    sum.update(&molecule.positions[i], sizeof molecule.positions[i]);
    sum.update(&molecule.radii[i], sizeof molecule.radii[i]);
  }
  return sum.finish();
}

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

EnsembleInputs::EnsembleInputs(const EnsembleInputArguments& arguments, const CompareOptions& options,
                               const Progress& progress)
    : a_(arguments), options_(options), progress_(progress) {
  plan_.version = kVersion;
  plan_.settings = setting_texts(options);
  plan_.settings.emplace_back("frames", a_.frames);
  if (a_.groups.empty() == a_.list.empty())
    throw InputError(a_.list.empty()
                         ? "no group was given; name one or two by " + option("group") + ", or a " + option("list") +
                               " of them"
                         : option("group") + " and " + option("list") + " exclude each other; leave one out");
  if (a_.list.empty()) {
    read_groups();
  } else {
    read_list();
  }
  count_frames();
  check_replicates(plan_.replicates);
  read_references();
}

void EnsembleInputs::read_groups() {
  for (const std::vector<std::string>& group : a_.groups) {
    if (group.size() < 2)
      throw InputError(option("group") + " takes a name and one file or more, each a replicate; '" + group.front() +
                       "' stands alone");
    if (fs::exists(group.front()))
      throw InputError(option("group") + ": '" + group.front() +
                       "' is a file; the first word is the group's name, such as wild");
    for (std::size_t i = 1; i < group.size(); ++i)
      plan_.replicates.push_back({group.front(), name_of_file(group[i]), {group[i]}, {}, 0});
  }
}

void EnsembleInputs::read_list() {
  const CsvTable table = read_csv(a_.list);
  const std::size_t group = table.require("group"), structure = table.require("structure");
  const int replicate = table.find("replicate"), charges = table.find("charges");
  const fs::path folder = fs::path(a_.list).parent_path();
  const auto path_of = [&](const std::string& text) { return (folder / text).string(); };
  for (const auto& row : table.rows) {
    const std::string file = path_of(row[structure]);
    const std::string name = replicate < 0 ? name_of_file(file) : row[static_cast<std::size_t>(replicate)];
    auto found = std::find_if(plan_.replicates.begin(), plan_.replicates.end(), [&](const EnsembleReplicate& r) {
      return r.group == row[group] && r.name == name && replicate >= 0;
    });
    if (found == plan_.replicates.end()) {
      plan_.replicates.push_back({row[group], name, {}, {}, 0});
      found = plan_.replicates.end() - 1;
    }
    found->files.push_back(file);
    if (charges >= 0 && !row[static_cast<std::size_t>(charges)].empty())
      charge_files_[row[group]] = path_of(row[static_cast<std::size_t>(charges)]);
  }
  // Groups stand together, in order of their first rows.
  const std::vector<std::string> names = plan_.groups();
  std::stable_sort(plan_.replicates.begin(), plan_.replicates.end(), [&](const auto& x, const auto& y) {
    return std::find(names.begin(), names.end(), x.group) < std::find(names.begin(), names.end(), y.group);
  });
}

void EnsembleInputs::count_frames() {
  for (EnsembleReplicate& replicate : plan_.replicates) {
    progress_.report("read " + replicate.name, 0.0);
    const FrameFiles files(replicate.files);
    for (const std::string& path : replicate.files) replicate.sha256.push_back(sha256_of_file(path));
    chosen_.push_back(parse_frames(a_.frames, {files.n_frames()}));
    replicate.n_frames = chosen_.back().size();
  }
}

void EnsembleInputs::read_references() {
  const std::vector<std::string> names = plan_.groups();
  for (const std::string& text : a_.charges) {
    const std::size_t sign = text.find('=');
    const std::string name = text.substr(0, sign);
    if (sign == std::string::npos || std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(option("charges", text) + " is not GROUP=FILE with one of the groups, such as " + names.front() +
                       "=" + names.front() + ".pqr");
    charge_files_[name] = text.substr(sign + 1);
  }
  std::vector<PotentialFacts> facts;
  for (const std::string& name : names) {
    const EnsembleReplicate& first = plan_.replicates[plan_.replicates_of(name).front()];
    const auto given = charge_files_.find(name);
    const StructureFile file(given == charge_files_.end() ? first.files.front() : given->second);
    StateRequest request{a_.structure};
    Group group{load_for(a_.potential, true, file, request, options_.input, progress_)};
    group.is_prepared = group.reference.preparation.has_value();
    const bool own = given == charge_files_.end();
    plan_.charges.emplace_back(name, !own ? fs::path(given->second).filename().string() + " " + file.sha256()
                                     : group.is_prepared ? "PDB2PQR of the first frame"
                                                         : "its files");
    facts.push_back(facts_of(group.reference));
    facts.back().name = own ? "group " + name + " (" + first.files.front() + ")" : given->second;
    groups_.emplace(name, std::move(group));
  }
  potential_ = PotentialPlan(a_.potential, facts, options_.temperature_K);
  if (!potential_.computes())
    throw InputError("an ensemble needs a potential" +
                     (potential_.because().empty() ? std::string() : ", and " + potential_.because()) +
                     "; give charges (" + option("charges") + " GROUP=FILE.pqr, or PQR files)");
  plan_.potential = potential_.in_words();
  plan_.potential_unit = to_string(PotentialUnit::kKtPerE);
}

std::vector<std::string> EnsembleInputs::files() const {
  std::vector<std::string> all = {a_.list};
  for (const EnsembleReplicate& r : plan_.replicates) all.insert(all.end(), r.files.begin(), r.files.end());
  for (const auto& [group, file] : charge_files_) all.push_back(file);
  if (fs::exists(a_.template_text)) all.push_back(a_.template_text);
  return all;
}

LoadedState EnsembleInputs::load(std::size_t number) {
  const auto [replicate, place] = plan_.place_of(number);
  const EnsembleReplicate& r = plan_.replicates[replicate];
  if (open_ != replicate) {
    frames_ = nullptr;  // frees the old text first
    frames_ = std::make_unique<FrameFiles>(r.files);
    open_ = replicate;
  }
  const int chosen = chosen_[replicate][place];
  const auto [file, model] = frames_->file_of_frame(chosen);
  const std::string name = frames_->name(chosen);
  StructureOptions structure = a_.structure;
  structure.model = model;
  const Group& group = groups_.at(r.group);
  LoadedState state =
      load_frame(*file, structure, name, group.reference.molecule, group.is_prepared, options_.input, progress_);
  if (potential_.takes_everything() && state.everything.size() == 0) {
    state.everything = file->read({model, true, true});
    if (!group.reference.everything.charges.empty()) take_values(state.everything, group.reference.everything, name);
    state.everything.name = name;
  }
  if (!has_charges(state.molecule))
    throw InputError(name + " has no charges; give them by " + option("charges", r.group + "=FILE.pqr"));
  return state;
}

MapMaker EnsembleInputs::maker_of(const LoadedState& state) const { return potential_.map_of(state).maker(); }

/// @param group empty for all
std::size_t EnsembleInputs::medoid(const std::string& group, const Progress& progress) {
  std::size_t first = 0, n = 0;
  for (const EnsembleReplicate& r : plan_.replicates) {
    if (n == 0 && !group.empty() && r.group != group) first += r.n_frames;
    if (group.empty() || r.group == group) n += r.n_frames;
  }
  if (n == 0) throw InputError(option("template", kMedoidOf + group) + ": there is no group of this name");
  return first + find_medoid(
                     n, [&](std::size_t f) { return load(first + f).molecule; }, progress);
}

RigidTransform EnsembleInputs::onto(const Molecule& earlier) const {
  const Molecule& present = template_.molecule;
  return superpose(present.positions, earlier.positions, pair_atoms(present, earlier).pairs).transform;
}

void EnsembleInputs::choose_template(const std::string& text, const Progress& progress) {
  const std::size_t n = plan_.n_frames();
  const bool of_group = text.rfind(kMedoidOf, 0) == 0;
  if (text == "medoid" || of_group || is_number(text)) {
    const std::size_t number = is_number(text)
                                   ? std::stoul(text)
                                   : medoid(of_group ? text.substr(std::string(kMedoidOf).size()) : "", progress);
    if (number >= n)
      throw InputError(option("template", text) + ": there are " + std::to_string(n) +
                       " frames in all groups, numbered from 0");
    template_ = load(number);
    const std::string what = of_group ? "medoid of " : text == "medoid" ? "medoid: " : "";
    plan_.template_name = what + plan_.name_of(number);
  } else {
    const StructureFile file(text);
    StateRequest request{a_.structure};
    request.wants_charges = false;
    template_ = load_state(file, request, options_.input, progress);
    plan_.template_name = text;
  }
  template_map_ = nullptr;
  if (has_charges(template_.molecule) && !potential_.takes_everything()) template_map_ = maker_of(template_);
  set_surface_radii({&template_.molecule}, options_.input.radii);
  plan_.template_sha256 = sha256_of_molecule(template_.molecule);
}

CompareInput EnsembleInputs::source() const { return {&template_.molecule, nullptr, template_map_, {}}; }

CompareInput EnsembleInputs::frame(std::size_t number) {
  frame_ = load(number);
  CompareInput input{&frame_.molecule, nullptr, maker_of(frame_), {}};
  set_surface_radii({&frame_.molecule}, options_.input.radii);
  return input;
}

void add_ensemble_inputs(CLI::App& p, EnsembleInputArguments& a) {
  p.add_option("--group", a.groups,
               "A group: its name, then its replicates: structure files whose models are the frames (PDB, PQR, mmCIF). "
               "Give it twice to compare two groups, once to describe one")
      ->type_name("NAME FILE...")
      ->group("Groups");
  p.add_option("--list", a.list,
               "Table of the groups instead, comma-separated: group, structure, and optionally replicate (rows of one "
               "replicate follow each other) and charges. Paths are relative to the list")
      ->group("Groups");
  p.add_option("--charges", a.charges,
               "GROUP=FILE: a PQR file of the same atoms, whose charges and radii the frames of the group take. "
               "Without it, frames keep their own, or PDB2PQR makes them from the group's first frame")
      ->group("Groups");
  p.add_option("--frames", a.frames,
               "Frames of each replicate, from 0: all, begin:end or begin:step:end, as in `espdiff trajectory`")
      ->capture_default_str()
      ->group("Groups");
  p.add_option("--template", a.template_text,
               "The structure whose surface is mapped onto every frame. medoid: the frame nearest to all others (of at "
               "most 200, evenly spread); medoid:GROUP: among the group's frames; a number: that frame, counted from 0 "
               "through all groups; a structure file")
      ->capture_default_str()
      ->group("Groups");
  add_structure_options(p, a.structure);
  add_computed_map_options(p, a.potential);
}

}  // namespace espdiff::cli
