// settings.cpp: reads ESPDIFF_CUDA_EMULATOR; ends the program where something is wrong.
#include "settings.h"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

#include "kernel.h"

namespace cuda_emulator {
namespace {

Settings read_settings() {
  Settings settings;
  const char* const text = std::getenv("ESPDIFF_CUDA_EMULATOR");
  std::istringstream words(text != nullptr ? text : "");
  for (std::string word; std::getline(words, word, ',');) {
    const std::size_t equals = word.find('=');
    const long value = equals == std::string::npos ? 0 : std::strtol(word.c_str() + equals + 1, nullptr, 0);
    const std::string name = word.substr(0, equals);
    if (name == "check")
      settings.check = true;
    else if (name == "no-pools")
      settings.pools = false;
    else if (name == "others")
      settings.others = static_cast<std::size_t>(value) << 20;
    else if (name == "no-driver")
      settings.driver = false;
    else if (name == "exclusive")
      settings.shared = false;
    else if (name == "count")
      settings.count = true;
    else if (name == "devices")
      settings.n_devices = static_cast<int>(value);
    else if (name == "lost")
      settings.lost = static_cast<std::size_t>(value);
    else if (name == "memory")
      settings.memory = static_cast<std::size_t>(value) << 20;
    else
      fail(
          "ESPDIFF_CUDA_EMULATOR: '%s' is none of check, no-pools, no-driver, exclusive, count, devices=N, "
          "memory=MIB, others=MIB, lost=N",
          word.c_str());
  }
  return settings;
}

}  // namespace

const Settings& settings() {
  static const Settings read = read_settings();
  return read;
}

void fail(const char* format, ...) {
  std::fputs("cuda_emulator: ", stderr);
  va_list values;
  va_start(values, format);
  std::vfprintf(stderr, format, values);
  va_end(values);
  const Kernel* const kernel = running_kernel();
  std::fprintf(stderr, "%s%s\n", kernel != nullptr ? "; in kernel " : "",
               kernel != nullptr ? kernel->name.c_str() : "");
  std::_Exit(3);
}

}  // namespace cuda_emulator
