// molfile_plugins.cpp: loads every plugin of a folder, as VMD does, and keeps those that read structures or
// coordinates.
#include "io/frames/molfile_plugins.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>

#include "base/error.h"
#include "io/files/file_kind.h"
#include "io/files/run_program.h"
#include "io/frames/molfile_abi.h"
#include "system/shared_library.h"
#include "system/standard_streams.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

/// What ends the names of topologies and trajectories. VMD has no reader of GROMACS' tpr; MDAnalysis has one.
constexpr const char* kEndings[] = {"dcd", "xtc",    "trr",  "nc",  "ncdf", "netcdf", "psf",    "prmtop",    "parm7",
                                    "top", "rst7",   "g96",  "crd", "trj",  "mdcrd",  "crdbox", "lammpstrj", "xyz",
                                    "h5",  "binpos", "coor", "dtr", "stk",  "car",    "cor",    "namdbin",   "tpr"};

std::string lower(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return text;
}

std::string ending_of(const std::string& path) {
  const std::string ending = lower(fs::path(path).extension().string());
  return ending.empty() ? ending : ending.substr(1);
}

/// A VMD whose plugins are part of its program has the folder without libraries.
bool has_libraries(const fs::path& folder) {
  std::error_code ignored;
  const fs::directory_iterator files(folder, ignored);
  return std::any_of(begin(files), end(files), [](const auto& file) { return file.path().extension() == ".so"; });
}

/// VMD's folder of plugins below its own folder; empty if there is none.
std::string plugins_below(const fs::path& vmd) {
  std::error_code ignored;
  std::vector<std::string> found;
  for (const auto& architecture : fs::directory_iterator(vmd / "plugins", ignored)) {
    const fs::path folder = architecture.path() / "molfile";
    if (has_libraries(folder)) found.push_back(folder.string());
  }
  std::sort(found.begin(), found.end());
  return found.empty() ? std::string() : found.front();
}

/// The folder that the script which starts VMD sets: `defaultvmddir="/usr/local/lib/vmd"`, or a default of VMDDIR.
std::string folder_in_launcher(const std::string& launcher) {
  constexpr std::size_t kMostLines = 200;
  std::ifstream script(launcher);
  std::string line;
  for (std::size_t n = 0; n < kMostLines && std::getline(script, line); ++n) {
    const bool names_it = line.find("defaultvmddir=") != std::string::npos || line.find("VMDDIR=") != std::string::npos;
    const std::size_t begin = line.find('/');
    if (!names_it || begin == std::string::npos) continue;
    const std::string folder = plugins_below(line.substr(begin, line.find_first_of("\"'} ;", begin) - begin));
    if (!folder.empty()) return folder;
  }
  return {};
}

/// Whether a plugin has this layout: each known version begins in the same way.
bool is_known(const molfile::PluginHead& head) {
  const bool version = std::find(std::begin(molfile::kVersions), std::end(molfile::kVersions), head.abiversion) !=
                       std::end(molfile::kVersions);
  return version && head.type != nullptr && std::strcmp(head.type, molfile::kPluginType) == 0;
}

int add_reader(void* readers, molfile::PluginHead* plugin) {
  if (plugin == nullptr || !is_known(*plugin)) return molfile::kError;
  // The functions follow the head, in every version.
  const auto& functions = reinterpret_cast<const molfile::Plugin<18>*>(plugin)->file;
  if (functions.open_file_read == nullptr || functions.close_file_read == nullptr) return molfile::kSuccess;
  if (functions.read_structure == nullptr && functions.read_next_timestep == nullptr) return molfile::kSuccess;
  MolfileReader reader{plugin->name, {}, &functions};
  const std::string endings = functions.filename_extension != nullptr ? functions.filename_extension : "";
  for (std::size_t begin = 0; begin < endings.size();) {
    const std::size_t end = std::min(endings.find(',', begin), endings.size());
    reader.endings.push_back(lower(endings.substr(begin, end - begin)));
    begin = end + 1;
  }
  static_cast<std::vector<MolfileReader>*>(readers)->push_back(std::move(reader));
  return molfile::kSuccess;
}

void load_plugin(const fs::path& path, std::vector<MolfileReader>& readers) {
  // It stays loaded: readers point into it. One that cannot be loaded, for want of a library or a function, is left
  // out; found missing at the call, a function would end the program.
  void* const library = load_library(path.string(), LibraryUse::kOwn);
  if (library == nullptr) return;
  const auto init = find_function<int (*)()>(library, "vmdplugin_init");
  const auto announce = find_function<int (*)(void*, molfile::RegisterCallback)>(library, "vmdplugin_register");
  if (announce == nullptr || (init != nullptr && init() != molfile::kSuccess)) return;
  announce(&readers, add_reader);
}

}  // namespace

const char* const kMolfileRemedy =
    "set VMDDIR to the folder of an installed VMD, or give the folder of its molfile plugins";

std::string find_molfile_folder(const std::string& given) {
  if (!given.empty()) return given;
  if (const char* const vmd = std::getenv("VMDDIR"); vmd != nullptr && *vmd != '\0') return plugins_below(vmd);
  if (const std::string launcher = find_program("vmd"); !launcher.empty()) {
    if (const std::string folder = folder_in_launcher(launcher); !folder.empty()) return folder;
  }
  for (const char* const usual : {"/usr/local/lib/vmd", "/usr/lib/vmd", "/opt/vmd/lib/vmd"}) {
    if (const std::string folder = plugins_below(usual); !folder.empty()) return folder;
  }
  return {};
}

const std::vector<MolfileReader>& molfile_readers(const std::string& folder) {
  static std::mutex mutex;
  static std::map<std::string, std::vector<MolfileReader>> of_folder;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto [entry, is_new] = of_folder.try_emplace(folder);
  if (is_new) {
    const QuietOutput quiet;
    // Plugins in C++ do not name its library, and take the program's. Python's programs have none for them.
    load_library("libstdc++.so.6", LibraryUse::kLazy);
    std::error_code problem;
    std::vector<fs::path> files;
    for (const auto& file : fs::directory_iterator(folder, problem)) {
      // Ours registers with VMD's Tcl; it reads nothing that is not read here.
      const std::string name = file.path().filename().string();
      if (file.path().extension() == ".so" && name.rfind("espdiff", 0) != 0) files.push_back(file.path());
    }
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) load_plugin(file, entry->second);
  }
  if (entry->second.empty())
    throw InputError(folder + ": there are no molfile plugins of VMD 1.9 in this folder; " + kMolfileRemedy);
  return entry->second;
}

const MolfileReader* find_molfile_reader(const std::string& folder, const std::string& path) {
  const std::string ending = ending_of(path);
  for (const MolfileReader& reader : molfile_readers(folder)) {
    if (std::find(reader.endings.begin(), reader.endings.end(), ending) != reader.endings.end()) return &reader;
  }
  return nullptr;
}

bool needs_molfile_reader(const std::string& path) {
  const std::string ending = ending_of(path);
  const auto is_ending = [&](const char* known) { return ending == known; };
  if (!std::any_of(std::begin(kEndings), std::end(kEndings), is_ending)) return false;
  const FileKind kind = kind_of_file(path);
  return kind != FileKind::kAmberRestart && kind != FileKind::kNetcdf;
}

}  // namespace espdiff
