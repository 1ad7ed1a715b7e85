// fuzz_ensemble_file.cpp: an ensemble's HDF5 file. An input is the beginning of the file, where all of its structure
// is; the rest is that of a file of ours.
#include <fstream>
#include <iterator>

#include "ensemble/file/ensemble_file.h"
#include "fuzz/fuzz_file.h"
#include "fuzz/planted_ensemble.h"

namespace {

std::string whole_file() {
  const std::string path = "/dev/shm/espdiff-fuzz-" + std::to_string(getpid()) + ".h5";
  espdiff_fuzz::plant_ensemble(path);
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  unlink(path.c_str());
  return bytes;
}

/// What the statistics rely on.
void use(const espdiff::EnsembleFile& file) {
  const espdiff::TemplateSurface& surface = file.surface();
  const std::size_t n = surface.positions.size();
  if (n != file.n_vertices() || surface.normals.size() != n || surface.residue.size() != n) std::abort();
  for (const espdiff::Triangle& triangle : surface.triangles) {
    for (const auto vertex : triangle) {
      if (vertex >= n) std::abort();
    }
  }
  for (const std::int32_t residue : surface.residue) {
    if (residue < -1 || residue >= static_cast<std::int32_t>(file.plan().residues.size())) std::abort();
  }
  std::vector<float> values(n);
  for (std::size_t f = 0; f < file.plan().n_frames(); ++f) {
    if (!file.has(f)) continue;
    file.numbers(f);
    file.read_values(f, 0, n, values.data());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string whole = whole_file();
  static espdiff_fuzz::MemoryFile file(whole);
  // The file is of 1 MB, most of it room for more; only its beginning is written anew.
  static std::size_t n_changed = 0;
  size = std::min(size, whole.size());
  file.replace(0, espdiff_fuzz::bytes_of(data, size));
  if (n_changed > size) file.replace(size, whole.substr(size, n_changed - size));
  n_changed = size;
  return espdiff_fuzz::read_memory_file(file, [](const std::string& path) { use(espdiff::EnsembleFile(path, false)); });
}
