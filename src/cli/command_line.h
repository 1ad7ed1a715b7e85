// command_line.h: the command line as a function, for the program and for `python -m espdiff`.
#pragma once

namespace espdiff::cli {

/// Parses the arguments and runs the command: results go to standard output, an error as one line to standard error.
/// While it runs, Ctrl-C, termination and a closed terminal cancel it; the handlers there were come back.
/// @returns the exit status: 2 for wrong usage or input, 1 for what could not be computed
int run_command_line(int argc, char** argv);

}  // namespace espdiff::cli
