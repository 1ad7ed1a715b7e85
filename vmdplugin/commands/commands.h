// commands.h: the commands of namespace ::espdiff::core, which the Tcl package is written on.
#pragma once

#include <tcl.h>

#include <string>
#include <vector>

#include "vmdplugin/objects/handles.h"

namespace espdiff::vmdplugin {

/// The call of a command.
struct Call {
  Tcl_Interp* interp;
  Handles& handles;
  std::vector<Tcl_Obj*> arguments;  ///< without the command's name

  std::string text(std::size_t i) const;
};

/// One command. Its function returns the result or throws.
struct Command {
  const char* name;
  int min_arguments, max_arguments;
  const char* usage;  ///< the arguments, for messages
  Tcl_Obj* (*run)(const Call& call);
};

/// compute_commands.cpp: start computations, watch them, and end them.
std::vector<Command> compute_commands();
/// result_commands.cpp: results as values and as files.
std::vector<Command> result_commands();
/// array_commands.cpp: surfaces as arrays, for other languages.
std::vector<Command> array_commands();
/// parse_computation() of compute_commands.cpp: reads what is common to all computations from OPTIONS, the settings of
/// the comparison included; a regularize key is given to `regularize` where that is not null, otherwise refused. Keys
/// that were read before are left alone.
Computation parse_computation(class DictReader& reader, bool* regularize);
/// The engine that the computation asks for; on the worker's thread.
std::unique_ptr<Engine> engine_for(const Computation& computation);

/// matrix_commands.cpp: many variants, each with each.
std::vector<Command> matrix_commands();
/// ensemble_commands.cpp: groups of simulations.
std::vector<Command> ensemble_commands();
/// potential_commands.cpp: potentials of frames, and their average.
std::vector<Command> potential_commands();
/// trajectory_commands.cpp: runs over frames, and tables as text.
std::vector<Command> trajectory_commands();
/// drawing_commands.cpp: results as maps and triangles for VMD.
std::vector<Command> drawing_commands();
/// pick_commands.cpp: what a click on a drawn surface hits.
std::vector<Command> pick_commands();
/// plot_commands.cpp: plots as files.
std::vector<Command> plot_commands();
/// program_commands.cpp: other programs, beside this one.
std::vector<Command> program_commands();
/// about_commands.cpp: what this module is and offers.
std::vector<Command> about_commands();

/// Makes every command in the interpreter, which owns the handles from then on.
void create_commands(Tcl_Interp* interp);
/// Removes them; cancels what computes and waits for it.
void delete_commands(Tcl_Interp* interp);

}  // namespace espdiff::vmdplugin
