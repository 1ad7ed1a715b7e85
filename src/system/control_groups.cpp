// control_groups.cpp: reads /proc/self/cgroup, and limits of processor time.
#include "system/control_groups.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <thread>

namespace espdiff {
namespace {

/// Processors whose time a group may take; 0 for no limit.
double processors_of(const ControlGroup& group) {
  double time = 0, period = 0;
  if (group.is_version_2) {
    std::ifstream file(group.folder + "/cpu.max");  // "max 100000" without a limit
    return file >> time >> period && time > 0 && period > 0 ? time / period : 0;
  }
  std::ifstream(group.folder + "/cpu.cfs_quota_us") >> time;  // -1 without a limit
  std::ifstream(group.folder + "/cpu.cfs_period_us") >> period;
  return time > 0 && period > 0 ? time / period : 0;
}

}  // namespace

std::vector<ControlGroup> control_groups(const std::string& controller, const std::string& group_file,
                                         const std::string& mount) {
  std::vector<ControlGroup> all;
  std::ifstream groups(group_file);
  for (std::string line; std::getline(groups, line);) {
    // "0::/path" in version 2, "4:cpu,memory:/path" in version 1.
    const std::size_t controllers = line.find(':'), path = line.find(':', controllers + 1);
    if (path == std::string::npos) continue;
    const std::string names = "," + line.substr(controllers + 1, path - controllers - 1) + ",";
    const bool is_version_2 = names == ",,";
    if (!is_version_2 && names.find("," + controller + ",") == std::string::npos) continue;
    const std::string root = is_version_2 ? mount : mount + "/" + controller;
    for (std::string group = line.substr(path + 1);; group.erase(group.find_last_of('/'))) {
      while (!group.empty() && group.back() == '/') group.pop_back();
      all.push_back({root + group, is_version_2});
      if (group.find('/') == std::string::npos) break;
    }
  }
  return all;
}

int usable_processors(const std::string& group_file, const std::string& mount) {
  double n = std::max(1U, std::thread::hardware_concurrency());
  for (const ControlGroup& group : control_groups("cpu", group_file, mount)) {
    const double limit = processors_of(group);
    if (limit > 0) n = std::min(n, std::ceil(limit));
  }
  return std::max(1, static_cast<int>(n));
}

}  // namespace espdiff
