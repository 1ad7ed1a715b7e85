// relabel.cpp: finds members by name, and their frames among those of the file.
#include "ensemble/relabel.h"

#include <string>

#include "base/error.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/frames/replicate_request.h"
#include "frames/frame_range.h"

namespace espdiff {
namespace {

/// A replicate's place in the file.
struct Found {
  std::size_t replicate = 0, first_frame = 0;
};

Found find_replicate(const EnsembleFile& file, const std::string& name) {
  std::vector<Found> found;
  std::string all;
  std::size_t first = 0;
  for (std::size_t r = 0; r < file.plan().replicates.size(); ++r) {
    const EnsembleReplicate& replicate = file.plan().replicates[r];
    const std::string whole = replicate.group + "/" + replicate.name;
    if (name == replicate.name || name == whole) found.push_back({r, first});
    if (r < 10) all += (all.empty() ? "" : ", ") + whole;
    first += replicate.n_frames;
  }
  if (found.size() == 1) return found.front();
  if (file.plan().replicates.size() > 10) all += ", ...";
  throw InputError(option("group") + ": " + file.path() + (found.empty() ? " has no" : " has more than one") +
                   " replicate '" + name + "'; it has " + all);
}

/// The member, and its frames among all of the file.
std::pair<EnsembleReplicate, std::vector<std::size_t>> take_member(const EnsembleFile& file,
                                                                   const ReplicateRequest& request) {
  const std::string& text = request.files.front();
  const std::size_t at = text.rfind('@');
  const std::string name = text.substr(0, at);
  const Found found = find_replicate(file, name);
  EnsembleReplicate member = file.plan().replicates[found.replicate];
  FrameSet set;
  set.n_frames = static_cast<int>(member.n_frames);
  set.what = option("group");
  set.of = name;
  std::vector<std::size_t> frames;
  for (const int f : parse_frames(at == std::string::npos ? "all" : text.substr(at + 1), set))
    frames.push_back(found.first_frame + static_cast<std::size_t>(f));
  member.group = request.group;
  member.name = text;
  member.n_frames = frames.size();
  return {std::move(member), std::move(frames)};
}

}  // namespace

void relabel(EnsembleFile& file, const std::vector<ReplicateRequest>& members) {
  EnsemblePlan plan = file.plan();
  plan.replicates.clear();
  std::vector<std::size_t> frames;
  std::vector<std::string> taken(file.plan().n_frames());
  for (const ReplicateRequest& request : members) {
    auto [member, own] = take_member(file, request);
    if (own.size() < 2)
      throw InputError(option("group") + ": " + member.name + " is one frame; a replicate needs two or more");
    for (const std::size_t f : own) {
      if (!taken[f].empty())
        throw InputError(option("group") + ": " + file.plan().name_of(f) + " is in " + taken[f] + " and in " +
                         member.name + "; a frame counts once");
      taken[f] = member.name;
    }
    frames.insert(frames.end(), own.begin(), own.end());
    plan.replicates.push_back(std::move(member));
  }
  const std::vector<std::string> groups = plan.groups();
  if (groups.size() > 2)
    throw InputError(option("group") + ": there are " + std::to_string(groups.size()) +
                     " groups; two are compared at a time, and one is described alone");
  std::size_t n_grouped = 0;  // a group's members stand together
  for (std::size_t r = 0; r + 1 < plan.replicates.size(); ++r)
    n_grouped += plan.replicates[r].group != plan.replicates[r + 1].group ? 1U : 0U;
  if (n_grouped + 1 != groups.size())
    throw InputError(option("group") + ": name the members of " + groups.front() + " at once");
  file.choose(std::move(plan), std::move(frames));
}

}  // namespace espdiff
