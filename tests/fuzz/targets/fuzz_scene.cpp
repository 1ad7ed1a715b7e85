// fuzz_scene.cpp: scene files (JSON).
#include "fuzz/fuzz_file.h"
#include "scene/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size), [](const std::string& path) {
    const espdiff::Scene scene = espdiff::read_scene(path, {});
    try {
      espdiff::check(scene);
    } catch (const espdiff::InputError&) {
      return;  // names the value, not the file
    }
  });
}
