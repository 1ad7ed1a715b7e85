// ensemble_inputs.cpp: counts and loads the frames of an ensemble, and chooses its template.
#include "ensemble/frames/ensemble_inputs.h"

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "align/geometry/superpose.h"
#include "align/pair_atoms.h"
#include "base/error.h"
#include "base/molecule/backbone_trace.h"
#include "base/units.h"
#include "base/version.h"
#include "ensemble/frames/medoid.h"
#include "ensemble/frames/template_choice.h"
#include "frames/frame_range.h"
#include "frames/frame_state.h"
#include "io/files/sha256.h"
#include "io/structures/structure_file.h"
#include "mapping/map_recipe.h"
#include "options/settings.h"
#include "prepare/load_state.h"
#include "prepare/surface_radii.h"
#include "prepare/take_charges.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMedoidOf = "medoid:";

}  // namespace

EnsembleInputs::EnsembleInputs(const EnsembleRequest& request, const CompareOptions& options, const Progress& progress)
    : request_(request), options_(options), progress_(progress), replicates_(request.replicates) {
  plan_.version = kVersion;
  for (auto& [name, text] : setting_texts(options)) {
    const bool changes_values = name != "patch" && name != "causes" && name != "field";
    if (changes_values) plan_.settings.emplace_back(std::move(name), std::move(text));
  }
  plan_.settings.emplace_back("frames", request_.frames);
  name_replicates();
  const bool are_files = std::none_of(replicates_.begin(), replicates_.end(),
                                      [](const ReplicateRequest& r) { return static_cast<bool>(r.read); });
  if (are_files)
    plan_.sources = FrameSources{request_.charges, "", request_.plugins, request_.potential, request_.structure};
  count_frames();
  check_replicates(plan_.replicates);
  find_maps();
}

EnsembleInputs::~EnsembleInputs() = default;

/// Groups stand together, in order of their first replicates.
void EnsembleInputs::name_replicates() {
  for (const ReplicateRequest& r : replicates_)
    plan_.replicates.push_back({r.group, r.name, r.files, {}, 0, r.topology, {}});
  const std::vector<std::string> names = plan_.groups();
  const auto by_group = [&](const auto& x, const auto& y) {
    return std::find(names.begin(), names.end(), x.group) < std::find(names.begin(), names.end(), y.group);
  };
  std::stable_sort(plan_.replicates.begin(), plan_.replicates.end(), by_group);
  std::stable_sort(replicates_.begin(), replicates_.end(), by_group);
}

OpenStructure EnsembleInputs::opener_of(const std::string& topology) {
  if (topology.empty())
    return [](const std::string& path) {
      if (has_coordinates_alone(path))
        throw InputError(path + ": a trajectory or topology has no structure of its own; name the structure or " +
                         "topology of its atoms first in the group, then the trajectories");
      return open_structure(path);
    };
  auto& opener = openers_[topology];
  if (opener == nullptr) opener = std::make_unique<TrajectoryOpener>(topology, request_.plugins, progress_);
  return [known = opener.get()](const std::string& path) { return known->open(path); };
}

void EnsembleInputs::count_frames() {
  for (std::size_t i = 0; i < replicates_.size(); ++i) {
    const ReplicateRequest& asked = replicates_[i];
    EnsembleReplicate& replicate = plan_.replicates[i];
    progress_.report("read " + replicate.name, 0.0);
    if (asked.read) {
      refuse_options_of_files(options_.input, StateRole::kOnly,
                              "replicate " + asked.name + " of " + asked.group +
                                  " comes from no file; choose its atoms where its frames come from");
      replicate.files = {asked.origin};
      replicate.sha256 = {asked.sha256};
      chosen_.emplace_back(asked.n_frames);
      std::iota(chosen_.back().begin(), chosen_.back().end(), 0);
    } else {
      const FrameFiles files(asked.files, opener_of(asked.topology));
      FrameSet set;
      set.n_frames = files.n_frames();
      set.incomplete = files.incomplete();
      for (const std::string& path : asked.files) replicate.sha256.push_back(sha256_of_file(path));
      if (!asked.topology.empty()) replicate.topology_sha256 = sha256_of_file(asked.topology);
      chosen_.push_back(parse_frames(request_.frames, set));
    }
    replicate.n_frames = chosen_.back().size();
  }
}

/// Maps of other programs, for all frames or for none.
void EnsembleInputs::find_maps() {
  std::vector<std::string> patterns;
  for (const ReplicateRequest& asked : replicates_) patterns.push_back(asked.maps);
  maps_ = GivenMaps(request_.maps, plan_.replicates, patterns, chosen_, options_.temperature_K);
  if (!maps_.given()) {
    if (!request_.maps.unit.empty() || !request_.maps.array.empty())
      throw InputError(option(request_.maps.unit.empty() ? "map-array" : "map-unit") +
                       " is of given maps; name them by " + option("maps"));
    return;
  }
  if (request_.potential.potential != "auto")
    throw InputError(option("maps") + " gives the potentials, and " +
                     option("potential", request_.potential.potential) + " computes them; leave one out");
  plan_.potential = "maps";
  plan_.potential_unit = to_string(maps_.unit());
  for (const auto& entry : maps_.identity()) plan_.settings.push_back(entry);
}

/// The first frame of a group, or the file of its charges.
LoadedState EnsembleInputs::reference_of(const std::string& group, PotentialFacts& facts) {
  const std::size_t first = plan_.replicates_of(group).front();
  const ReplicateRequest& asked = replicates_[first];
  const auto given = request_.charges.find(group);
  const bool own = given == request_.charges.end();
  LoadedState state;
  std::string from = "its frames", file_name;
  if (own && asked.read) {
    state = asked.read(static_cast<std::size_t>(chosen_[first].front()), true);
    file_name = asked.origin;
  } else {
    file_name = own ? asked.files.front() : given->second;
    const auto file = own ? opener_of(asked.topology)(file_name) : open_structure(file_name);
    PotentialRequest potential = request_.potential;
    potential.is_required = true;
    state = load_for(potential, !maps_.given(), *file, {request_.structure}, options_.input, progress_);
    from = !own                ? fs::path(file_name).filename().string() + " " + file->sha256()
           : state.preparation ? "PDB2PQR of the first frame"
                               : "its files";
  }
  for (const ChargeFile& charges : state.charge_files)
    from += ", " + charges.use + " " + (charges.sha256.empty() ? sha256_of_file(charges.path) : charges.sha256);
  plan_.charges.emplace_back(group, from);
  facts = facts_of(state);
  facts.name = own ? "group " + group + " (" + file_name + ")" : file_name;
  return state;
}

void EnsembleInputs::load_references() {
  const std::vector<std::string> names = plan_.groups();
  for (const auto& [group, file] : request_.charges) {
    if (file.empty() || std::find(names.begin(), names.end(), group) == names.end())
      throw InputError(option("charges", file.empty() ? group : group + "=" + file) +
                       " is not GROUP=FILE with one of the groups, such as " + names.front() + "=" + names.front() +
                       ".pqr");
  }
  std::vector<PotentialFacts> facts(names.size());
  for (std::size_t g = 0; g < names.size(); ++g) references_.emplace(names[g], reference_of(names[g], facts[g]));
  if (maps_.given()) return;
  PotentialRequest asked = request_.potential;
  asked.averaged = true;
  potential_ = PotentialPlan(asked, facts, options_.temperature_K);
  if (!potential_.computes())
    throw InputError("an ensemble needs a potential" +
                     (potential_.because().empty() ? std::string() : ", and " + potential_.because()) +
                     "; give charges (" + option("charges") + " GROUP=FILE.pqr, or PQR files)");
  plan_.potential = potential_.in_words();
  const bool in_vacuum = std::any_of(references_.begin(), references_.end(), [&](const auto& reference) {
    return is_vacuum(potential_.map_of(reference.second).recipe());
  });
  plan_.potential_unit = to_string(PotentialUnit::kKtPerE) + (in_vacuum ? kInVacuum : "");
}

std::vector<std::string> EnsembleInputs::files() const {
  std::vector<std::string> all;
  for (const ReplicateRequest& r : replicates_) {
    all.insert(all.end(), r.files.begin(), r.files.end());
    all.push_back(r.topology);
  }
  for (const auto& [group, file] : request_.charges) all.push_back(file);
  for (const std::vector<std::string>& maps : maps_.files()) all.insert(all.end(), maps.begin(), maps.end());
  if (fs::exists(request_.template_text)) all.push_back(request_.template_text);
  return all;
}

LoadedState EnsembleInputs::load(std::size_t number) {
  const auto [replicate, place] = plan_.place_of(number);
  const ReplicateRequest& asked = replicates_[replicate];
  const LoadedState& reference = references_.at(asked.group);
  const int chosen = chosen_[replicate][place];
  LoadedState state;
  if (asked.read) {
    state = asked.read(static_cast<std::size_t>(chosen), potential_.takes_everything());
    if (!has_charges(state.molecule) && has_charges(reference.molecule))
      take_values(state.molecule, reference.molecule, state.molecule.name);
  } else {
    if (open_ != replicate) {
      frames_ = nullptr;  // frees the old text first
      frames_ = std::make_unique<FrameFiles>(asked.files, opener_of(asked.topology));
      open_ = replicate;
    }
    state = load_frame_state(*frames_, chosen, request_.structure, reference, potential_.takes_everything(),
                             options_.input, progress_);
  }
  if (!maps_.given() && !has_charges(state.molecule))
    throw InputError(state.molecule.name + " has no charges; give them by " +
                     option("charges", asked.group + "=FILE.pqr"));
  return state;
}

MapMaker EnsembleInputs::maker_of(const LoadedState& state) const { return potential_.map_of(state).maker(); }

/// @param group empty for all
std::size_t EnsembleInputs::medoid(const std::string& group, bool skip_errors, const Progress& progress) {
  std::size_t first = 0, n = 0;
  for (const EnsembleReplicate& r : plan_.replicates) {
    if (n == 0 && !group.empty() && r.group != group) first += r.n_frames;
    if (group.empty() || r.group == group) n += r.n_frames;
  }
  if (n == 0) throw InputError(option("template", kMedoidOf + group) + ": there is no group of this name");
  const auto read = [&](std::size_t f) {
    try {
      return load(first + f).molecule;
    } catch (const Error& error) {
      if (!skip_errors || error.error_class() == ErrorClass::kCancelled || error.error_class() == ErrorClass::kIo)
        throw Error(error.error_class(), plan_.name_of(first + f) + ": " + error.message());
      return Molecule();
    }
  };
  return first + find_medoid(n, read, progress);
}

RigidTransform EnsembleInputs::onto(const Molecule& earlier) const {
  const Molecule& present = template_.molecule;
  return superpose(present.positions, earlier.positions, pair_atoms(present, earlier).pairs).transform;
}

void EnsembleInputs::choose_template(const std::string& text, bool skip_errors, const Progress& progress) {
  const std::size_t n = plan_.n_frames();
  const bool of_group = text.rfind(kMedoidOf, 0) == 0;
  std::string chosen = text;
  if (text == "medoid" || of_group || is_number(text)) {
    const std::size_t number =
        is_number(text) ? std::stoul(text)
                        : medoid(of_group ? text.substr(std::string(kMedoidOf).size()) : "", skip_errors, progress);
    if (number >= n)
      throw InputError(option("template", text) + ": there are " + std::to_string(n) +
                       " frames in all groups, numbered from 0");
    template_ = load(number);
    chosen = std::to_string(number);
    const std::string what = of_group ? "medoid of " : text == "medoid" ? "medoid: " : "";
    plan_.template_name = what + plan_.name_of(number);
  } else {
    template_ = read_template(text, request_.structure, options_.input, progress);
    plan_.template_name = text;
  }
  if (plan_.sources) plan_.sources->template_text = chosen;
  template_map_ = nullptr;
  if (potential_.computes() && has_charges(template_.molecule) && !potential_.takes_everything())
    template_map_ = maker_of(template_);
  set_surface_radii({&template_.molecule}, options_.input.radii);
  plan_.template_sha256 = sha256_of_template(template_.molecule);
  plan_.template_backbone = to_text(backbone_trace(template_.molecule));
}

CompareInput EnsembleInputs::source() const { return {&template_.molecule, nullptr, template_map_, {}}; }

HeldInput EnsembleInputs::frame(std::size_t number) {
  struct Frame {
    LoadedState state;
    Grid map;  // where it is given
  };
  const auto held = std::make_shared<Frame>();
  held->state = load(number);
  CompareInput input{&held->state.molecule, nullptr, nullptr, {}};
  const auto [replicate, place] = plan_.place_of(number);
  input.fields.group = replicates_[replicate].group;
  input.fields.replicate = plan_.replicates[replicate].name;
  input.fields.frame = chosen_[replicate][place];
  if (maps_.given()) {
    held->map = maps_.read(replicate, place);
    input.map = &held->map;
  } else {
    input.make_map = maker_of(held->state);
  }
  set_frame_radii(template_.molecule, held->state.molecule, options_.input.radii);
  return {std::move(input), held};
}

}  // namespace espdiff
