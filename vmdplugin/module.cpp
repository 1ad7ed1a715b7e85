// module.cpp: the entry points: Tcl's Espdiff_Init and Espdiff_Unload, VMD's vmdplugin_*.
#include <tcl.h>

#include "base/version.h"
#include "vmdplugin/bridge/boundary.h"
#include "vmdplugin/bridge/molfile_bridge.h"
#include "vmdplugin/bridge/worker.h"
#include "vmdplugin/commands/commands.h"

#define ESPDIFF_ENTRY extern "C" __attribute__((visibility("default")))

namespace {

void stop_worker() {
  espdiff::boundary(
      [] {
        espdiff::vmdplugin::Worker::instance().stop();
        return 0;
      },
      [](const espdiff::Failure&) { return 0; });
}

extern "C" void on_tcl_exit(ClientData) { stop_worker(); }

/// Stops the worker if a program ends without calling Tcl's or VMD's own functions for that.
__attribute__((destructor)) void on_unload() { stop_worker(); }

}  // namespace

/// `load espdiffplugin.so Espdiff`. Needs Tcl 8.5 or later.
ESPDIFF_ENTRY int Espdiff_Init(Tcl_Interp* interp) {  // NOLINT: Tcl makes the name from the package's
  if (Tcl_InitStubs(interp, "8.5", 0) == nullptr) return TCL_ERROR;
  return espdiff::boundary(
      [interp] {
        Tcl_CreateExitHandler(on_tcl_exit, nullptr);
        espdiff::vmdplugin::create_commands(interp);
        return Tcl_PkgProvide(interp, "espdiff_core", espdiff::kVersion);
      },
      [interp](const espdiff::Failure& failure) {
        Tcl_SetObjResult(interp, Tcl_NewStringObj(failure.message.plain().c_str(), -1));
        return TCL_ERROR;
      });
}

/// `unload espdiffplugin.so Espdiff`: stops the worker. The library stays mapped (linked with -z nodelete), because
/// VMD may have opened it too.
ESPDIFF_ENTRY int Espdiff_Unload(Tcl_Interp* interp, int flags) {  // NOLINT: as above
  return espdiff::boundary(
      [interp, flags] {
        espdiff::vmdplugin::delete_commands(interp);
        if (flags == TCL_UNLOAD_DETACH_FROM_PROCESS) {
          stop_worker();
          Tcl_DeleteExitHandler(on_tcl_exit, nullptr);
        }
        return TCL_OK;
      },
      [](const espdiff::Failure&) { return TCL_ERROR; });
}

ESPDIFF_ENTRY int vmdplugin_init() { return espdiff::molfile::kSuccess; }

ESPDIFF_ENTRY int vmdplugin_register(void* registrar, espdiff::molfile::RegisterCallback callback) {
  return espdiff::register_plugins(registrar, callback);
}

ESPDIFF_ENTRY int vmdplugin_fini() {
  stop_worker();
  return espdiff::molfile::kSuccess;
}
