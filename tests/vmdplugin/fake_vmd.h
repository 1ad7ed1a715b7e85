// fake_vmd.h: VMD's side of the plugin interface: takes plugins of one version, and keeps what they print.
#pragma once

#include <doctest/doctest.h>

#include <cstring>
#include <string>
#include <vector>

#include "vmdplugin/bridge/molfile_bridge.h"

namespace espdiff_test {

namespace molfile = espdiff::molfile;

/// A VMD with one version of the interface: keeps the plugins of that version, refuses others.
struct Registrar {
  int version = 0;
  std::vector<molfile::PluginHead*> kept;
  std::vector<int> offered;

  static int take(void* self, molfile::PluginHead* plugin) {
    auto& registrar = *static_cast<Registrar*>(self);
    registrar.offered.push_back(plugin->abiversion);
    if (plugin->abiversion != registrar.version) return molfile::kError;
    registrar.kept.push_back(plugin);
    return molfile::kSuccess;
  }
};

/// The last line that a plugin printed.
inline std::string& printed() {
  static std::string line;
  return line;
}
inline int print(int, const char* text) {
  printed() = text;
  return 0;
}

template <int Version>
molfile::Plugin<Version>& plugin_named(const std::string& name) {
  Registrar vmd{Version, {}, {}};
  REQUIRE(espdiff::register_plugins(&vmd, Registrar::take) == molfile::kSuccess);
  for (molfile::PluginHead* head : vmd.kept) {
    if (name != head->name) continue;
    auto& plugin = *reinterpret_cast<molfile::Plugin<Version>*>(head);
    plugin.timesteps.print_to_console = print;
    printed().clear();
    return plugin;
  }
  FAIL("no plugin ", name);
  throw 0;
}

inline bool same_bytes(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

inline espdiff::Grid small_grid(double value) {
  espdiff::Grid grid;
  grid.lattice.size = {2, 2, 2};
  grid.lattice.step = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  grid.values.assign(8, static_cast<float>(value));
  return grid;
}

}  // namespace espdiff_test
