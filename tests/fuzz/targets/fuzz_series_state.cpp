// fuzz_series_state.cpp: the saved mapping of a trajectory. What begins with '!' is the file as it is; other inputs are
// the state inside it, behind a check sum that fits.
#include <nlohmann/json.hpp>

#include "fuzz/fuzz_file.h"
#include "io/files/sha256.h"
#include "trajectory/series_file.h"

namespace {

std::string file_with(const std::string& state) {
  const auto bytes = nlohmann::json::to_cbor({{"format", "espdiff series state"},
                                              {"version", 3},
                                              {"fingerprint", "f"},
                                              {"sha256", espdiff::sha256_of(state)},
                                              {"state", nlohmann::json::binary({state.begin(), state.end()})}});
  return {bytes.begin(), bytes.end()};
}

/// What a series relies on.
bool holds_together(const espdiff::SeriesState& state) {
  const auto finite = [](const auto& p) { return p.x - p.x == 0 && p.y - p.y == 0 && p.z - p.z == 0; };
  for (const auto& p : state.mapped) {
    if (!finite(p)) return false;
  }
  if (!state.morph) return true;
  const auto& morph = *state.morph;
  const std::size_t n = state.mapped.size();
  if (morph.source.size() != n || morph.path_length.size() != n || morph.unmatched.size() != morph.triangles.size())
    return false;
  for (const auto& triangle : morph.triangles) {
    for (const auto vertex : triangle) {
      if (vertex >= n) return false;
    }
  }
  const espdiff::Molecule& target = morph.target;
  if (target.positions.size() != target.atoms.size() || target.radii.size() != target.atoms.size()) return false;
  for (const espdiff::Atom& atom : target.atoms) {
    if (atom.residue < 0 || static_cast<std::size_t>(atom.residue) >= target.residues.size()) return false;
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes = espdiff_fuzz::bytes_of(data, size);
  const bool whole = size > 0 && data[0] == '!';
  return espdiff_fuzz::read_as_file(whole ? bytes.substr(1) : file_with(bytes), [](const std::string& path) {
    if (!holds_together(espdiff::read_series_state(path, "f"))) std::abort();
  });
}
