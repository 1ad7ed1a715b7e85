// layers.cpp: no room includes a room above it: reads every include of src/, cuda/ and vmdplugin/.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;
using Rooms = std::map<std::string, std::set<std::string>>;

/// What each room may include besides itself; only rooms below it.
const Rooms kAllowed = {
    {"system", {}},
    {"base", {"system"}},
    {"io", {"system", "base"}},
    {"align", {"base"}},
    {"statistics", {"base"}},
    {"prepare", {"system", "base", "align", "io"}},
    {"engine", {"base"}},
    {"cuda/device", {"base", "engine"}},
    {"cuda/surface", {"base", "engine", "cuda/device"}},
    {"cuda/deform", {"base", "engine", "cuda/device", "cuda/surface"}},
    {"cuda/morph", {"base", "engine", "cuda/device", "cuda/surface"}},
    {"cuda/certificate", {"base", "engine", "cuda/device", "cuda/surface"}},
    {"cuda/potential", {"system", "base", "engine", "cuda/device", "cuda/surface"}},
    {"cuda",
     {"base", "engine", "cuda/device", "cuda/surface", "cuda/deform", "cuda/morph", "cuda/certificate",
      "cuda/potential"}},
    {"causes", {"base", "align"}},
    {"field", {"base", "io", "align", "engine"}},
    {"field/kinds", {"base", "io", "align", "engine", "field"}},
    {"compare", {"base", "align", "causes", "engine", "field"}},
    {"potential", {"base", "align", "engine", "io", "compare", "prepare"}},
    {"plot", {"base", "io"}},
    {"view", {"system", "base", "io", "plot"}},
    {"verify", {"base", "io"}},
    {"report", {"base", "align", "causes", "engine", "field", "io", "compare", "prepare", "potential"}},
    {"page", {"base", "io", "plot", "report"}},
    {"export", {"base", "io", "plot", "report"}},
    {"trajectory", {"base", "align", "engine", "field", "io", "compare", "prepare", "potential", "plot", "report"}},
    {"matrix", {"system", "base", "align", "engine", "field", "io", "compare", "prepare", "potential", "report"}},
    {"ensemble",
     {"system", "base", "align", "causes", "engine", "field", "io", "statistics", "compare", "prepare", "potential",
      "report", "trajectory", "matrix"}},
    {"study",
     {"base", "align", "engine", "field", "io", "compare", "prepare", "potential", "report", "trajectory", "matrix",
      "ensemble"}},
    {"cli", {"system", "base", "align", "engine", "field",  "io",     "statistics", "compare", "prepare",  "potential",
             "plot",   "view", "page",  "export", "verify", "report", "trajectory", "matrix",  "ensemble", "study"}},
    {"vmdplugin",
     {"system", "base", "align", "engine", "field", "io", "statistics", "compare", "prepare", "potential", "plot",
      "report", "page", "trajectory", "matrix", "ensemble", "study"}},
    {"python/src",
     {"base", "align", "engine", "field", "io", "statistics", "compare", "prepare", "potential", "report", "trajectory",
      "matrix", "ensemble", "study", "plot", "page", "cli"}},
};

std::string quoted_include(const std::string& line) {
  const std::string start = "#include \"";
  if (line.compare(0, start.size(), start) != 0) return "";
  return line.substr(start.size(), line.find('"', start.size()) - start.size());
}

/// The room of a file that is included as "room/file" or "cuda/room/file"; empty for a file of the same folder.
std::string room_of(const std::string& include) {
  const std::size_t slash = include.rfind('/');
  return slash == std::string::npos ? "" : include.substr(0, slash);
}

/// Checks one file; returns how many includes of other rooms it has.
int check_file(const fs::path& file, const std::string& room) {
  std::ifstream in(file);
  int n = 0;
  for (std::string line; std::getline(in, line);) {
    const std::string include = quoted_include(line);
    const std::string other = room_of(include);
    if (other.empty() || other == room) continue;
    ++n;
    INFO(file.string(), " includes ", include);
    CHECK(kAllowed.at(room).count(other) == 1);
  }
  return n;
}

}  // namespace

TEST_SUITE_BEGIN("layers");

TEST_CASE("rooms include only rooms below them") {
  const fs::path root = ESPDIFF_SOURCE_DIR;
  int n_files = 0, n_includes = 0;
  for (const auto& [room, allowed] : kAllowed) {
    const bool is_at_top = room.compare(0, 4, "cuda") == 0 || room == "vmdplugin" || room == "python/src";
    const fs::path folder = is_at_top ? root / room : root / "src" / room;
    if (!fs::is_directory(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp" && extension != ".cu") continue;
      ++n_files;
      n_includes += check_file(entry.path(), room);
    }
  }
  CHECK(n_files > 40);
  CHECK(n_includes > 40);
}

TEST_CASE("only src/system calls POSIX") {
  const std::regex posix(
      "#include <(csignal|dirent|dlfcn|fcntl|glob|poll|pthread|pwd|signal|spawn|sys/.*|termios|unistd)");
  int n_in_system = 0;
  for (const char* folder : {"src", "cuda", "vmdplugin", "python/src"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ESPDIFF_SOURCE_DIR) / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp" && extension != ".cu") continue;
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);) {
        if (!std::regex_search(line, posix)) continue;
        INFO(entry.path().string(), ": ", line);
        const bool is_in_system = entry.path().parent_path().filename() == "system";
        n_in_system += is_in_system ? 1 : 0;
        CHECK(is_in_system);
      }
    }
  }
  CHECK(n_in_system > 10);
}

TEST_CASE("every folder of src has a rule") {
  for (const auto& entry : fs::directory_iterator(fs::path(ESPDIFF_SOURCE_DIR) / "src")) {
    if (!entry.is_directory()) continue;
    INFO(entry.path().string());
    CHECK(kAllowed.count(entry.path().filename().string()) == 1);
  }
}

TEST_CASE("every source file states its purpose in its first line") {
  for (const char* folder : {"src", "cuda", "vmdplugin", "python/src"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ESPDIFF_SOURCE_DIR) / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp" && extension != ".cu") continue;
      std::ifstream in(entry.path());
      std::string line;
      std::getline(in, line);
      INFO(entry.path().string());
      CHECK(line.find("// " + entry.path().filename().string() + ": ") == 0);
    }
  }
}

TEST_CASE("only the command line writes options with dashes; other messages name them") {
  const std::regex spelled("\"[^\"]*--[a-z]");
  int n_lines = 0;
  for (const char* folder : {"src", "cuda", "vmdplugin", "python/src"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ESPDIFF_SOURCE_DIR) / folder)) {
      const std::string extension = entry.path().extension().string();
      if (entry.path().parent_path().filename() == "cli") continue;
      if (entry.path().filename() == "pdb2pqr.cpp" || entry.path().filename() == "open_babel.cpp")
        continue;  // other programs' options
      if (extension != ".h" && extension != ".cpp" && extension != ".cu") continue;
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line); ++n_lines) {
        if (line.find("--") != std::string::npos)
          CHECK_MESSAGE(!std::regex_search(line, spelled), entry.path().string(), ": ", line,
                        "; name it by option() of base/message.h");
      }
    }
  }
  CHECK(n_lines > 10000);
}

TEST_SUITE_END();
