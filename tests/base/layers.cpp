// layers.cpp: no room includes a room above it: reads every include of src/, cuda/, vmdplugin/ and python/src/.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
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
    {"base/text", {"system", "base"}},
    {"base/molecule", {"system", "base"}},
    {"io/text", {"system", "base"}},
    {"io/files", {"system", "base", "io/text"}},
    {"io/molecules", {"system", "base", "io/text", "io/files"}},
    {"io/structures", {"system", "base", "io/text", "io/files", "io/molecules"}},
    {"io/structures/formats", {"system", "base", "io/text", "io/files", "io/molecules", "io/structures"}},
    {"io/vtk", {"system", "base", "io/text", "io/files"}},
    {"io/grids", {"system", "base", "io/text", "io/files", "io/vtk"}},
    {"io/frames", {"system", "base", "io/text", "io/files", "io/molecules", "io/structures"}},
    {"align/geometry", {"base"}},
    {"align", {"base", "align/geometry"}},
    {"statistics/surface", {"base"}},
    {"statistics", {"base", "statistics/surface"}},
    {"prepare/charges", {"system", "base", "align", "io"}},
    {"prepare", {"system", "base", "align", "io", "prepare/charges"}},
    {"engine", {"system", "base"}},
    {"cuda/device", {"base", "engine"}},
    {"cuda/surface/mesh", {"base", "engine", "cuda/device"}},
    {"cuda/surface/density", {"base", "engine", "cuda/device", "cuda/surface/mesh"}},
    {"cuda/surface", {"base", "engine", "cuda/device", "cuda/surface/mesh", "cuda/surface/density"}},
    {"cuda/deform", {"base", "engine", "cuda/device", "cuda/surface"}},
    {"cuda/morph", {"base", "engine", "cuda/device", "cuda/surface"}},
    {"cuda/certificate", {"base", "engine", "cuda/device", "cuda/surface"}},
    {"cuda/potential", {"system", "base", "engine", "cuda/device", "cuda/surface"}},
    {"cuda/potential/pb/multigrid", {"system", "base", "engine", "cuda/device", "cuda/surface", "cuda/potential"}},
    {"cuda/potential/pb",
     {"system", "base", "engine", "cuda/device", "cuda/surface", "cuda/potential", "cuda/potential/pb/multigrid"}},
    {"cuda",
     {"base", "engine", "cuda/device", "cuda/surface", "cuda/deform", "cuda/morph", "cuda/certificate",
      "cuda/potential"}},
    {"causes", {"base", "align"}},
    {"field", {"base", "io", "align", "engine"}},
    {"field/kinds", {"base", "io", "align", "engine", "field"}},
    {"options", {"base", "align", "causes", "engine", "field"}},
    {"motions", {"base", "align", "causes", "engine", "field", "options"}},
    {"mapping", {"base", "align", "causes", "engine", "field", "options", "motions"}},
    {"certificate", {"base", "align", "causes", "engine", "field", "options", "motions", "mapping"}},
    {"input_checks", {"base", "align", "causes", "engine", "field", "options", "motions", "mapping", "certificate"}},
    {"compare/stages",
     {"base", "align", "causes", "engine", "field", "options", "motions", "mapping", "certificate", "input_checks"}},
    {"compare",
     {"base", "align", "causes", "engine", "field", "options", "motions", "mapping", "certificate", "input_checks",
      "compare/stages"}},
    {"potential", {"base", "align", "engine", "io", "pair", "prepare"}},
    {"plot", {"base", "io"}},
    {"scene", {"base", "io", "plot"}},
    {"view/surface", {"system", "base", "io", "plot", "scene"}},
    {"view/drawings", {"system", "base", "io", "plot", "scene", "view/surface"}},
    {"view", {"system", "base", "io", "plot", "scene", "view/surface", "view/drawings"}},
    {"view/window", {"system", "base", "io", "plot", "scene", "view", "view/surface", "view/drawings"}},
    {"verify", {"base", "io"}},
    {"report/records", {"base", "align", "causes", "engine", "field", "io", "pair", "prepare", "potential"}},
    {"report/sections",
     {"base", "align", "causes", "engine", "field", "io", "pair", "prepare", "potential", "report/records"}},
    {"report",
     {"base", "align", "causes", "engine", "field", "io", "pair", "prepare", "potential", "report/records",
      "report/sections"}},
    {"complementarity", {"base", "align", "engine", "field", "io", "pair", "prepare", "potential", "report"}},
    {"page", {"base", "io", "plot", "scene", "report"}},
    {"export", {"base", "io", "plot", "report"}},
    {"frames", {"base", "io", "prepare"}},
    {"trajectory",
     {"base", "align", "engine", "field", "io", "pair", "prepare", "potential", "plot", "report", "frames"}},
    {"matrix", {"system", "base", "align", "engine", "field", "io", "pair", "prepare", "potential", "report"}},
    {"ensemble/frames",
     {"system", "base", "align", "causes", "engine", "field", "io", "statistics", "pair", "prepare", "potential",
      "report", "frames", "trajectory", "matrix"}},
    {"ensemble/file",
     {"system", "base", "align", "causes", "engine", "field", "io", "statistics", "pair", "prepare", "potential",
      "report", "frames", "trajectory", "matrix", "ensemble/frames"}},
    {"ensemble/result",
     {"system", "base", "align", "causes", "engine", "field", "io", "statistics", "pair", "prepare", "potential",
      "report", "frames", "trajectory", "matrix", "ensemble/frames", "ensemble/file"}},
    {"ensemble",
     {"system", "base", "align", "causes", "engine", "field", "io", "statistics", "pair", "prepare", "potential",
      "report", "frames", "trajectory", "matrix", "ensemble/frames", "ensemble/file", "ensemble/result"}},
    {"study",
     {"base", "align", "engine", "field", "io", "pair", "prepare", "potential", "report", "complementarity", "frames",
      "trajectory", "matrix", "ensemble"}},
    {"cli/modules",
     {"system", "base", "align", "engine", "field", "io", "statistics", "pair", "prepare", "potential", "scene", "view",
      "verify", "report", "frames", "trajectory", "matrix", "ensemble"}},
    {"cli/words",
     {"system",    "base",       "align",  "engine",   "field", "io",     "statistics", "pair",   "prepare",
      "potential", "plot",       "scene",  "view",     "page",  "export", "verify",     "report", "complementarity",
      "frames",    "trajectory", "matrix", "ensemble", "study"}},
    {"cli",
     {"system",    "base",       "align",  "engine",   "field", "io",       "statistics", "pair",   "prepare",
      "potential", "plot",       "scene",  "view",     "page",  "export",   "verify",     "report", "complementarity",
      "frames",    "trajectory", "matrix", "ensemble", "study", "cli/words"}},
    {"cli/commands",
     {"system",    "base",       "align",  "engine",   "field", "io",     "statistics", "pair",   "prepare",
      "potential", "plot",       "scene",  "view",     "page",  "export", "verify",     "report", "complementarity",
      "frames",    "trajectory", "matrix", "ensemble", "study", "cli",    "cli/words"}},
    {"vmdplugin/bridge", {"system", "base", "engine", "io"}},
    {"vmdplugin/values", {"study and below", "vmdplugin/bridge"}},
    {"vmdplugin/objects", {"study and below", "plot", "scene", "vmdplugin/bridge", "vmdplugin/values"}},
    {"vmdplugin/commands",
     {"study and below", "plot", "page", "scene", "vmdplugin/bridge", "vmdplugin/values", "vmdplugin/objects"}},
    {"vmdplugin", {"system", "base", "vmdplugin/bridge", "vmdplugin/commands"}},
    {"python/src/boundary", {"base", "engine"}},
    {"python/src/states", {"study and below", "python/src/boundary"}},
    {"python/src/results", {"study and below", "plot", "page", "python/src/boundary", "python/src/states"}},
    {"python/src",
     {"study and below", "plot", "page", "cli", "python/src/boundary", "python/src/states", "python/src/results"}},
};

/// Rooms that rows name together: the stages of a comparison, and all that a front end may call.
const Rooms kTogether = {
    {"pair", {"options", "motions", "mapping", "certificate", "input_checks", "compare"}},
    {"study and below",
     {"system", "base", "align", "engine", "field", "io", "statistics", "pair", "prepare", "potential", "report",
      "frames", "trajectory", "matrix", "ensemble", "study"}},
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

/// Whether a room is among those allowed: by its name, by that of the folder it is in, or by that of several together.
bool is_among(const std::set<std::string>& allowed, const std::string& other) {
  for (std::string folder = other; !folder.empty();
       folder.resize(folder.find('/') == std::string::npos ? 0 : folder.rfind('/'))) {
    if (allowed.count(folder) == 1) return true;
  }
  for (const auto& [name, rooms] : kTogether) {
    if (allowed.count(name) == 1 && is_among(rooms, other)) return true;
  }
  return false;
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
    CHECK(is_among(kAllowed.at(room), other));
  }
  return n;
}

}  // namespace

TEST_SUITE_BEGIN("layers");

TEST_CASE("rooms include only rooms below them") {
  const fs::path root = ESPDIFF_SOURCE_DIR;
  int n_files = 0, n_includes = 0;
  for (const auto& [room, allowed] : kAllowed) {
    const fs::path folder = fs::is_directory(root / "src" / room) ? root / "src" / room : root / room;
    CHECK_MESSAGE(fs::is_directory(folder), folder.string());
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

TEST_CASE("every folder of sources has a rule") {
  const fs::path root = ESPDIFF_SOURCE_DIR;
  for (const char* const top : {"src", "cuda", "vmdplugin", "python/src"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const fs::path folder = entry.path().parent_path();
      if (!entry.is_regular_file() || folder == root / "src") continue;
      INFO(entry.path().string());
      CHECK(kAllowed.count(fs::relative(folder, top == std::string("src") ? root / top : root).generic_string()) == 1);
    }
  }
}

TEST_CASE("no folder holds more files than one can survey") {
  std::map<std::string, int> n_files;
  for (const char* folder : {"src", "cuda", "tcl", "vmdplugin", "python", "page", "shaders", "exports", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ESPDIFF_SOURCE_DIR) / folder)) {
      if (entry.is_regular_file()) ++n_files[entry.path().parent_path().string()];
    }
  }
  for (const auto& folder : n_files) CHECK_MESSAGE(folder.second <= 25, folder.first);
  CHECK(n_files.size() > 40);
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

TEST_CASE("every test is in a program") {
  const fs::path tests = fs::path(ESPDIFF_SOURCE_DIR) / "tests";
  std::ifstream in(tests / "CMakeLists.txt");
  const std::string lists{std::istreambuf_iterator<char>(in), {}};
  int n_files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(tests)) {
    const std::string file = entry.path().lexically_relative(tests).string(), room = file.substr(0, file.find('/'));
    const std::string extension = entry.path().extension().string();
    if (extension != ".cpp" && extension != ".cu") continue;
    if (room == "fuzz" || room == "cuda_emulator" || room == "install") continue;  // with rules of their own
    CHECK_MESSAGE(lists.find(file) != std::string::npos, file, " is not in tests/CMakeLists.txt");
    ++n_files;
  }
  CHECK(n_files > 200);
}

TEST_CASE("only the command line writes options with dashes; other messages name them") {
  const std::regex spelled("\"[^\"]*--[a-z]");
  int n_lines = 0;
  for (const char* folder : {"src", "cuda", "vmdplugin", "python/src"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ESPDIFF_SOURCE_DIR) / folder)) {
      const std::string extension = entry.path().extension().string();
      if (entry.path().string().find("/src/cli/") != std::string::npos) continue;
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
