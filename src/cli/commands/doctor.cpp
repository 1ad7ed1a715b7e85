// doctor.cpp: `espdiff doctor`: the parts of this build and machine, and how to get missing ones.
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "base/formatted.h"
#include "base/version.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "cli/words/spelling.h"
#include "engine/select_engine.h"
#include "io/files/run_program.h"
#include "io/frames/frame_reader.h"
#include "io/frames/molfile_plugins.h"
#include "prepare/charges/open_babel.h"
#include "prepare/charges/pdb2pqr.h"
#if defined(ESPDIFF_HAVE_HDF5)
#include "ensemble/file/hdf5_writer.h"
#endif
#if defined(ESPDIFF_HAVE_VTK)
#include "io/structures/structure_file.h"
#include "view/display.h"
#endif

namespace espdiff::cli {
namespace {

void line(const char* what, bool good, const Message& text) {
  std::cout << formatted("%-14s %-4s %s\n", what, good ? "ok" : "--", spelled(text).c_str());
}

/// The module of this program, and how VMD finds it. It lies in the build's folder vmd/, beside the program's folder
/// (scripts/install-vmd, scripts/pack-vmd), or where Debian's package espdiff-vmd has it.
void vmd_module_line() {
  std::error_code ignored;
  const auto root = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path().parent_path();
  for (const char* folder : {"vmd", "", "lib/espdiff"}) {
    const auto place = (root / folder).lexically_normal(), module = place / "molfile" / "espdiffplugin.so";
    if (!std::filesystem::exists(module, ignored)) continue;
    const bool is_build = std::string(folder) == "vmd";
    line("vmd module", true,
         module.string() + (is_build ? std::string("; scripts/install-vmd installs it for VMD")
                                     : "; VMD finds it by `lappend auto_path {" +
                                           (place / "tcl").lexically_normal().string() + "}` in ~/.vmdrc"));
    return;
  }
  line("vmd module", false,
       "none beside this program: a build has it where Tcl 8.6 is found (Debian: tcl8.6-dev), of Debian's packages "
       "espdiff-vmd; `espdiff doctor` in VMD has details");
}

int doctor_verb() {
  std::cout << formatted("espdiff %s\n", kVersion);
  const BackEndStatus cpu = cpu_status(), cuda = cuda_status();
  line("cpu", cpu.available, cpu.description);
  line("cuda", cuda.available, cuda.description);
  const std::vector<BackEndStatus> gpus = cuda_devices();
  for (const BackEndStatus& gpu : gpus) {
    if (gpus.size() > 1) line(("  " + gpu.name).c_str(), gpu.available, gpu.description);
  }
  line("--device auto", true, std::string("takes ") + (cuda.available ? "cuda" : "cpu"));
  for (const BackEndStatus& status : {cpu_fourier_status(), cuda_fourier_status()})
    line(("pme on " + status.name).c_str(), status.available, status.description);
#if defined(ESPDIFF_HAVE_GEMMI)
  line("structures", true, structure_format_names());
#else
  line("structures", false, "no PDB and mmCIF: gemmi was not found when this was built (Debian: gemmi-dev)");
#endif
  const std::string plugins = find_molfile_folder();
  const FrameReader* const other = frame_reader();
  line("trajectories", !plugins.empty() || other != nullptr,
       !plugins.empty()   ? "by VMD's plugins in " + plugins
       : other != nullptr ? "by " + other->name + "; VMD's plugins are not found"
                          : std::string("no molfile plugins of VMD, which read DCD, XTC, PSF and others; ") +
                                kMolfileRemedy + frame_reader_remedy());
  line("maps", true, "DX, cube, VTI");
#if defined(ESPDIFF_HAVE_VTK)
  const std::string problem = drawing_problem();
  const char* display = std::getenv("DISPLAY");
  const bool has_display = display != nullptr && *display != '\0';
  line("render", problem.empty(),
       !problem.empty() ? problem
       : has_display    ? std::string("display ") + display
                        : "without a display, by EGL or OSMesa");
#else
  line("render", false, "VTK 9 was not found when this was built (Debian: libvtk9-dev)");
#endif
#if defined(ESPDIFF_HAVE_HDF5)
  const std::string ensemble_problem = hdf5_problem();
  line("ensemble", ensemble_problem.empty(), ensemble_problem.empty() ? "HDF5" : ensemble_problem);
#else
  line("ensemble", false, "HDF5 was not found when this was built (Debian: libhdf5-dev)");
#endif
  const std::string gnuplot = find_program("gnuplot");
  line("plot", !gnuplot.empty(),
       !gnuplot.empty() ? gnuplot : "no program `gnuplot` on PATH, which draws plots (Debian: gnuplot-nox)");
  const std::string pdb2pqr = find_pdb2pqr();
  line("prepare", !pdb2pqr.empty(),
       !pdb2pqr.empty() ? pdb2pqr
                        : std::string("no program `pdb2pqr30` on PATH, which assigns charges; ") + kPdb2pqrRemedy);
  const LigandSupport ligands = ligand_support();
  line("ligands", ligands.is_there, ligands.text);
  vmd_module_line();
  const std::string vmd = find_program("vmd");
  line("vmd", !vmd.empty(), !vmd.empty() ? vmd : "no program `vmd` on PATH; only the VMD module needs it");
  return 0;
}

}  // namespace

Verb add_doctor(CLI::App& app) {
  CLI::App* parser =
      app.add_subcommand("doctor", "List the parts of this build and machine, and how to get missing ones");
  set_help(*parser, {});
  return {parser, [](const Context&) { return doctor_verb(); }};
}

}  // namespace espdiff::cli
