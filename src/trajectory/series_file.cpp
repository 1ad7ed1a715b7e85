// series_file.cpp: the state of a series as CBOR (RFC 8949): its arrays as byte strings, the rest by name.
#include "trajectory/series_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/memory.h"
#include "io/files/atomic_file.h"
#include "io/files/read_input.h"
#include "io/files/sha256.h"
#include "io/text/json_integer.h"
#include "io/text/json_values.h"

namespace espdiff {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

constexpr const char* kFormat = "espdiff series state";
constexpr int kStateVersion = 3;

template <typename T>
Json binary(const std::vector<T>& values) {
  Bytes bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return Json::binary(std::move(bytes));
}

template <typename T>
std::vector<T> array_of(const Json& json) {
  const Bytes& bytes = json.get_binary();
  if (bytes.size() % sizeof(T) != 0) throw std::out_of_range("array");
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// The parts of a molecule that a later step needs: names for pairing atoms, and positions.
Json molecule_json(const Molecule& molecule) {
  Json atoms = Json::array(), residues = Json::array();
  for (const Atom& a : molecule.atoms) atoms.push_back({a.name, a.element, a.residue, a.hetero});
  for (const Residue& r : molecule.residues)
    residues.push_back({r.name, r.chain, r.number, static_cast<int>(r.insertion_code)});
  return {{"name", molecule.name},
          {"positions", binary(molecule.positions)},
          {"radii", binary(molecule.radii)},
          {"atoms", std::move(atoms)},
          {"residues", std::move(residues)}};
}

Molecule molecule_of(const Json& json) {
  Molecule molecule;
  json.at("name").get_to(molecule.name);
  molecule.positions = array_of<Vec3d>(json.at("positions"));
  molecule.radii = array_of<float>(json.at("radii"));
  for (const Json& a : json.at("atoms")) {
    Atom atom;
    a.at(0).get_to(atom.name);
    a.at(1).get_to(atom.element);
    atom.residue = integer_of<std::int32_t>(a.at(2));
    a.at(3).get_to(atom.hetero);
    molecule.atoms.push_back(std::move(atom));
  }
  for (const Json& r : json.at("residues")) {
    Residue residue;
    r.at(0).get_to(residue.name);
    r.at(1).get_to(residue.chain);
    residue.number = integer_of<int>(r.at(2));
    residue.insertion_code = integer_of<char>(r.at(3));
    molecule.residues.push_back(std::move(residue));
  }
  return molecule;
}

Json state_json(const SeriesState& state) {
  Json json = {{"mapped", binary(state.mapped)}, {"target", binary(state.target)}};
  if (state.morph)
    json["morph"] = {{"source", binary(state.morph->source)},
                     {"triangles", binary(state.morph->triangles)},
                     {"unmatched", binary(state.morph->unmatched)},
                     {"path_length", binary(state.morph->path_length)},
                     {"target", molecule_json(state.morph->target)},
                     {"unmatched_share", state.morph->unmatched_share},
                     {"unmatched_share_at_start", state.morph->unmatched_share_at_start}};
  return json;
}

SeriesState state_of(const Json& json) {
  SeriesState state;
  state.mapped = array_of<Vec3f>(json.at("mapped"));
  state.target = array_of<Vec3d>(json.at("target"));
  const auto morph = json.find("morph");
  if (morph == json.end()) return state;
  state.morph = SeriesState::Morph{array_of<Vec3f>(morph->at("source")),
                                   array_of<Triangle>(morph->at("triangles")),
                                   array_of<float>(morph->at("unmatched")),
                                   array_of<float>(morph->at("path_length")),
                                   molecule_of(morph->at("target")),
                                   morph->at("unmatched_share").get<double>(),
                                   morph->at("unmatched_share_at_start").get<double>()};
  return state;
}

template <typename T>
bool are_finite(const std::vector<Vec3<T>>& positions) {
  return std::all_of(positions.begin(), positions.end(),
                     [](const Vec3<T>& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); });
}

/// Whether indices and sizes fit each other: a check sum says that the file is whole, not that it is ours.
bool holds_together(const SeriesState& state) {
  if (!are_finite(state.mapped)) return false;
  if (!state.morph) return true;
  const SeriesState::Morph& morph = *state.morph;
  const std::size_t n = state.mapped.size();
  const auto is_inside = [n](const Triangle& t) { return t[0] < n && t[1] < n && t[2] < n; };
  const Molecule& target = morph.target;
  const auto has_residue = [&](const Atom& atom) {
    return atom.residue >= 0 && static_cast<std::size_t>(atom.residue) < target.residues.size();
  };
  return morph.source.size() == n && are_finite(morph.source) && morph.path_length.size() == n &&
         morph.unmatched.size() == morph.triangles.size() &&
         std::all_of(morph.triangles.begin(), morph.triangles.end(), is_inside) &&
         target.positions.size() == target.atoms.size() && are_finite(target.positions) &&
         target.radii.size() == target.atoms.size() &&
         std::all_of(target.atoms.begin(), target.atoms.end(), has_residue);
}

std::string hash_of(const Bytes& bytes) {
  Sha256 hash;
  hash.update(bytes.data(), bytes.size());
  return hash.finish();
}

FormatError damaged(const std::string& path) {
  return FormatError(path, 0, "the saved state is damaged or cut off; delete it, and the run starts from the source");
}

/// @throws FormatError, MemoryError
Json parse_cbor(std::string_view bytes, const std::string& path) {
  const std::optional<std::size_t> n_values = count_cbor_values(bytes);
  if (!n_values) throw damaged(path);
  require_memory(static_cast<double>(bytes.size()) + kBytesOfJsonValue * static_cast<double>(*n_values), path);
  return Json::from_cbor(bytes);
}

std::string read_all(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(path, "cannot be read; without it the run starts from the source");
  require_regular_file(path);
  require_memory(2.0 * static_cast<double>(std::filesystem::file_size(path)), path);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

void write_series_state(const std::string& path, const SeriesState& state, const std::string& fingerprint) {
  Bytes content = Json::to_cbor(state_json(state));
  const std::string hash = hash_of(content);
  const Bytes bytes = Json::to_cbor({{"format", kFormat},
                                     {"version", kStateVersion},
                                     {"fingerprint", fingerprint},
                                     {"sha256", hash},
                                     {"state", Json::binary(std::move(content))}});
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

SeriesState read_series_state(const std::string& path, const std::string& fingerprint) {
  const std::string bytes = read_all(path);
  const FormatError other_version(path, 0,
                                  "the saved state was written by another version of espdiff; delete it, and the run "
                                  "starts from the source");
  if (bytes.rfind(kFormat, 0) == 0) throw other_version;  // versions 1 and 2 began with these words
  try {
    const Json json = parse_cbor(bytes, path);
    if (json.at("format") != kFormat) throw damaged(path);
    if (json.at("version") != kStateVersion) throw other_version;
    if (json.at("fingerprint") != fingerprint)
      throw InputError(path + ": the saved state is of another run; delete it, and the run starts from the source");
    const Bytes& content = json.at("state").get_binary();
    if (hash_of(content) != json.at("sha256")) throw damaged(path);
    SeriesState state = state_of(parse_cbor({reinterpret_cast<const char*>(content.data()), content.size()}, path));
    if (!holds_together(state)) throw damaged(path);
    return state;
  } catch (const nlohmann::json::exception&) {
    throw damaged(path);
  } catch (const std::out_of_range&) {
    throw damaged(path);
  }
}

}  // namespace espdiff
