// replicate_request.cpp: replicates from groups of files, and from a list.
#include "ensemble/frames/replicate_request.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "io/files/read_csv.h"
#include "io/frames/open_structure.h"
#include "prepare/load_state.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

/// "wild_1" of "runs/wild_1.pdb.gz".
std::string name_of_file(const std::string& path) {
  const std::string name = fs::path(path).filename().string();
  return name.substr(0, name.find('.', 1));  // a hidden file's first dot is part of its name
}

/// run1/md.dcd and run2/md.dcd become "run1/md" and "run2/md".
void tell_apart(std::vector<ReplicateRequest>& replicates) {
  std::map<std::pair<std::string, std::string>, int> count;
  for (const ReplicateRequest& r : replicates) ++count[{r.group, r.name}];
  for (ReplicateRequest& r : replicates) {
    const std::string folder = fs::path(r.files.front()).parent_path().filename().string();
    if (count[{r.group, r.name}] > 1 && !folder.empty()) r.name = folder + "/" + r.name;
  }
}

}  // namespace

std::vector<ReplicateRequest> replicates_of_groups(const std::vector<std::vector<std::string>>& groups) {
  std::vector<ReplicateRequest> replicates;
  for (const std::vector<std::string>& group : groups) {
    if (group.size() < 2)
      throw InputError(option("group") + " takes a name and one file or more, each a replicate; '" +
                       (group.empty() ? std::string() : group.front()) + "' stands alone");
    if (fs::exists(group.front()))
      throw InputError(option("group") + ": '" + group.front() +
                       "' is a file; the first word is the group's name, such as wild");
    const bool has_topology = std::any_of(group.begin() + 2, group.end(), has_coordinates_alone);
    for (std::size_t i = has_topology ? 2 : 1; i < group.size(); ++i) {
      replicates.push_back({group.front(), name_of_file(group[i]), {group[i]}, {}, {}, {}, {}, 0});
      if (has_topology) replicates.back().topology = group[1];
    }
  }
  tell_apart(replicates);
  return replicates;
}

std::vector<ReplicateRequest> replicates_of_list(const std::string& path, std::map<std::string, std::string>& charges) {
  const CsvTable table = read_csv(path);
  const std::size_t group = table.require("group"), structure = table.require("structure");
  const int replicate = table.find("replicate"), topology = table.find("topology"), charge = table.find("charges"),
            maps = table.find("maps");
  const fs::path folder = fs::path(path).parent_path();
  const auto path_in = [&](const std::vector<std::string>& row, int column) {
    const std::string text = column < 0 ? std::string() : row[static_cast<std::size_t>(column)];
    return text.empty() ? text : (folder / text).string();
  };
  std::vector<ReplicateRequest> replicates;
  for (const auto& row : table.rows) {
    const std::string file = path_in(row, static_cast<int>(structure));
    const std::string name = replicate < 0 ? name_of_file(file) : row[static_cast<std::size_t>(replicate)];
    auto found = std::find_if(replicates.begin(), replicates.end(), [&](const ReplicateRequest& r) {
      return r.group == row[group] && r.name == name && replicate >= 0;
    });
    if (found == replicates.end()) {
      replicates.push_back({row[group], name, {}, path_in(row, topology), {}, {}, {}, 0});
      found = replicates.end() - 1;
    }
    found->files.push_back(file);
    if (const std::string pattern = path_in(row, maps); !pattern.empty()) {
      if (!found->maps.empty() && found->maps != pattern)
        throw InputError(path + ": replicate " + name + " of " + row[group] +
                         " has two patterns in its column maps; its frames are counted through all its files");
      found->maps = pattern;
    }
    if (const std::string given = path_in(row, charge); !given.empty()) charges[row[group]] = given;
  }
  return replicates;
}

}  // namespace espdiff
