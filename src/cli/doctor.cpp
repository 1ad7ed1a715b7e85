// doctor.cpp: `espdiff doctor`: what this build and this machine offer, and how to get what is missing.
#include <cstdio>
#include <cstdlib>

#include "base/version.h"
#include "cli/verbs.h"
#include "engine/select_engine.h"

namespace espdiff::cli {
namespace {

void line(const char* what, bool good, const std::string& text) {
  std::printf("%-14s %-4s %s\n", what, good ? "ok" : "--", text.c_str());
}

int run() {
  std::printf("espdiff %s\n", kVersion);
  const BackEndStatus cpu = cpu_status(), cuda = cuda_status();
  line("cpu", cpu.available, cpu.description);
  line("cuda", cuda.available, cuda.description);
  line("--device auto", true, std::string("takes ") + (cuda.available ? "cuda" : "cpu"));
#if defined(ESPDIFF_HAVE_GEMMI)
  line("structures", true, "PQR, PDB, mmCIF");
#else
  line("structures", false, "PQR only: gemmi was not found when this was built (Debian: gemmi-dev)");
#endif
#if defined(ESPDIFF_HAVE_VTK)
  line("maps", true, "DX, cube, VTI");
  const char* display = std::getenv("DISPLAY");
  const bool has_display = display != nullptr && *display != '\0';
  line("render", has_display,
       has_display ? std::string("display ") + display
                   : "no DISPLAY; run `xvfb-run -a espdiff render ...` (Debian: xvfb, xauth)");
#else
  line("maps", false, "DX and cube; no VTI: VTK 9 was not found when this was built (Debian: libvtk9-dev)");
  line("render", false, "VTK 9 was not found when this was built (Debian: libvtk9-dev)");
#endif
  line("vmd", false, "the VMD plugin is not in this version");
  return 0;
}

}  // namespace

Verb add_doctor(CLI::App& app) {
  CLI::App* parser =
      app.add_subcommand("doctor", "Say what this build and this machine offer, and how to get what is missing");
  return {parser, [](const Context&) { return run(); }};
}

}  // namespace espdiff::cli
