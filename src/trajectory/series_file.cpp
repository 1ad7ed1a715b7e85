// series_file.cpp: the state of a series as a file.
#include "trajectory/series_file.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/sha256.h"

namespace espdiff {
namespace {

constexpr const char* kTag = "espdiff series state 2\n";
constexpr const char* kAnyTag = "espdiff series state ";
constexpr std::size_t kHashDigits = 64;

template <typename T>
void append(std::string& bytes, const T* values, std::size_t n) {
  bytes.append(reinterpret_cast<const char*>(values), n * sizeof(T));
}

template <typename T>
void append_counted(std::string& bytes, const T& values) {
  const std::uint64_t n = values.size();
  append(bytes, &n, 1);
  append(bytes, values.data(), values.size());
}

/// What a later step needs of a molecule: what pairs its atoms, and where they are.
void append_molecule(std::string& bytes, const Molecule& molecule) {
  append_counted(bytes, molecule.name);
  append_counted(bytes, molecule.positions);
  append_counted(bytes, molecule.radii);
  for (const Atom& atom : molecule.atoms) {
    append_counted(bytes, atom.name);
    append_counted(bytes, atom.element);
    const std::int32_t numbers[] = {atom.residue, atom.hetero ? 1 : 0};
    append(bytes, numbers, 2);
  }
  const std::uint64_t n_residues = molecule.residues.size();
  append(bytes, &n_residues, 1);
  for (const Residue& residue : molecule.residues) {
    append_counted(bytes, residue.name);
    append_counted(bytes, residue.chain);
    append(bytes, &residue.number, 1);
    append(bytes, &residue.insertion_code, 1);
  }
}

/// Takes values off the front of what is left of a file.
class Reader {
 public:
  Reader(const std::string& path, const std::string& bytes) : path_(path), bytes_(bytes) {}

  template <typename T>
  std::vector<T> take(std::size_t n) {
    if (n > (bytes_.size() - at_) / sizeof(T)) throw damaged(path_);
    std::vector<T> values(n);
    if (n > 0) std::memcpy(values.data(), bytes_.data() + at_, n * sizeof(T));
    at_ += n * sizeof(T);
    return values;
  }
  std::size_t take_count() { return static_cast<std::size_t>(take<std::uint64_t>(1)[0]); }
  template <typename T>
  std::vector<T> take_counted() {
    return take<T>(take_count());
  }
  std::string take_text() {
    const std::vector<char> text = take_counted<char>();
    return {text.begin(), text.end()};
  }
  bool at_end() const { return at_ == bytes_.size(); }

  static FormatError damaged(const std::string& path) {
    return FormatError(path, 0, "the saved state is damaged or cut off; delete it, and the run starts from the source");
  }

 private:
  const std::string& path_;
  const std::string& bytes_;
  std::size_t at_ = 0;
};

Molecule take_molecule(Reader& reader) {
  Molecule molecule;
  molecule.name = reader.take_text();
  molecule.positions = reader.take_counted<Vec3d>();
  molecule.radii = reader.take_counted<float>();
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    Atom atom;
    atom.name = reader.take_text();
    atom.element = reader.take_text();
    const auto numbers = reader.take<std::int32_t>(2);
    atom.residue = numbers[0];
    atom.hetero = numbers[1] != 0;
    molecule.atoms.push_back(std::move(atom));
  }
  for (std::size_t n = reader.take_count(); n > 0; --n) {
    Residue residue;
    residue.name = reader.take_text();
    residue.chain = reader.take_text();
    residue.number = reader.take<std::int32_t>(1)[0];
    residue.insertion_code = reader.take<char>(1)[0];
    molecule.residues.push_back(std::move(residue));
  }
  return molecule;
}

}  // namespace

void write_series_state(const std::string& path, const SeriesState& state, const std::string& fingerprint) {
  std::string bytes = kTag + fingerprint + '\n';
  append_counted(bytes, state.mapped);
  append_counted(bytes, state.target);
  bytes += state.morph ? 'm' : 'd';
  if (state.morph) {
    append_counted(bytes, state.morph->source);
    append_counted(bytes, state.morph->triangles);
    append_counted(bytes, state.morph->unmatched);
    append_counted(bytes, state.morph->path_length);
    append_molecule(bytes, state.morph->target);
    append(bytes, &state.morph->unmatched_share, 1);
    append(bytes, &state.morph->unmatched_share_at_start, 1);
  }
  AtomicFile file(path);
  file.stream() << bytes << sha256_of(bytes);
  file.commit();
}

SeriesState read_series_state(const std::string& path, const std::string& fingerprint) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(path, "cannot be read; without it the run starts from the source");
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (bytes.size() < kHashDigits) throw Reader::damaged(path);
  const std::string hash = bytes.substr(bytes.size() - kHashDigits);
  bytes.resize(bytes.size() - kHashDigits);
  if (sha256_of(bytes) != hash || bytes.compare(0, std::strlen(kAnyTag), kAnyTag) != 0) throw Reader::damaged(path);
  if (bytes.compare(0, std::strlen(kTag), kTag) != 0)
    throw FormatError(path, 0,
                      "the saved state was written by another version of espdiff; delete it, and the run starts from "
                      "the source");

  const std::size_t line = std::strlen(kTag), end = bytes.find('\n', line);
  if (end == std::string::npos) throw Reader::damaged(path);
  const std::string found = bytes.substr(line, end - line);
  if (found != fingerprint)
    throw InputError(path + ": the saved state is of another run (" + found + " instead of " + fingerprint +
                     "); delete it, and the run starts from the source");
  const std::string rest = bytes.substr(end + 1);
  Reader reader(path, rest);
  SeriesState state;
  state.mapped = reader.take_counted<Vec3f>();
  state.target = reader.take_counted<Vec3d>();
  if (reader.take<char>(1)[0] == 'm') {
    SeriesState::Morph morph;
    morph.source = reader.take_counted<Vec3f>();
    morph.triangles = reader.take_counted<Triangle>();
    morph.unmatched = reader.take_counted<float>();
    morph.path_length = reader.take_counted<float>();
    morph.target = take_molecule(reader);
    morph.unmatched_share = reader.take<double>(1)[0];
    morph.unmatched_share_at_start = reader.take<double>(1)[0];
    state.morph = std::move(morph);
  }
  if (!reader.at_end()) throw Reader::damaged(path);
  return state;
}

}  // namespace espdiff
