// command_line.cpp: parses the command line, runs the command, and turns errors into one line and an exit status.
#include "cli/command_line.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/printable.h"
#include "base/system_message.h"
#include "base/translate.h"
#include "base/version.h"
#include "cli/spelling.h"
#include "cli/terminal_progress.h"
#include "cli/verbs.h"
#include "system/standard_streams.h"

namespace {

std::string joined(int argc, char** argv) {
  std::string line = "espdiff";
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  return line;
}

/// What is wrong with the words of the command, in ours; the library's begin with the option's name and a colon.
std::string in_our_words(const CLI::ParseError& error) {
  const std::string text = error.what(), name = text.substr(0, text.find(": "));
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ArgumentMismatch)) {
    const bool too_many = text.find("At Most") != std::string::npos;
    return name + (too_many ? ": is given more than once; give it once" : ": a value is missing behind it");
  }
  // All that is left over, the first word last.
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError))
    return "'" + text.substr(text.rfind(' ') + 1) + "': there is no such option, and no place for another argument";
  return text;
}

/// Runs the chosen command; errors become one line on standard error.
int run_verb(const espdiff::cli::Verb& verb, const std::string& command_line) {
  espdiff::cli::TerminalProgress terminal;
  const auto fail = [&](const char* message, int status) {
    terminal.clear();
    std::fprintf(stderr, "espdiff: %s\n", espdiff::printable(message).c_str());
    return status;
  };
  try {
    espdiff::cli::Context context;
    context.command_line = command_line;
    context.progress = &terminal.progress();
    return verb.run(context);
  } catch (const std::exception& error) {
    const espdiff::Error ours = espdiff::translated(error);
    return fail(espdiff::cli::spelled(ours.message()).c_str(), ours.exit_status());
  } catch (...) {
    return fail("internal error: an exception of unknown type; please report it with the command", 1);
  }
}

/// What was printed must have arrived: on a full disk, files may be complete and their summary lost.
int with_output_written(int status) {
  errno = 0;
  const bool is_written = static_cast<bool>(std::cout.flush());
  if (std::fflush(stdout) == 0 && is_written && std::ferror(stdout) == 0) return status;
  if (espdiff::is_output_unread()) return status;  // as after `| head`
  const std::string reason = errno != 0 ? ": " + espdiff::system_message(errno) : std::string();
  std::fprintf(stderr, "espdiff: the standard output cannot be written%s; files that were asked for are complete\n",
               reason.c_str());
  return status == 0 ? 1 : status;
}

int run(int argc, char** argv) {
  CLI::App app(
      "espdiff shows where and by how much the electrostatic surface potential differs between two states of a "
      "molecule, and how "
      "far the answer can be trusted.");
  app.name("espdiff");
  app.set_version_flag("--version", std::string("espdiff ") + espdiff::kVersion);
  app.require_subcommand(0, 1);
  std::vector<espdiff::cli::Verb> verbs = {
      espdiff::cli::add_compare(app),   espdiff::cli::add_trajectory(app), espdiff::cli::add_matrix(app),

#ifdef ESPDIFF_HAVE_HDF5
      espdiff::cli::add_ensemble(app),
#endif
      espdiff::cli::add_merge(app),     espdiff::cli::add_plot(app),       espdiff::cli::add_surface(app),
      espdiff::cli::add_potential(app), espdiff::cli::add_prepare(app),    espdiff::cli::add_render(app),
      espdiff::cli::add_view(app),      espdiff::cli::add_verify(app),     espdiff::cli::add_doctor(app)};
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    const auto chosen = app.get_subcommands();
    const std::string help = chosen.empty() ? "" : " " + chosen.front()->get_name();
    std::fprintf(stderr, "espdiff: %s; see espdiff%s --help\n", espdiff::printable(in_our_words(error)).c_str(),
                 help.c_str());
    return 2;
  }
  for (const auto& verb : verbs) {
    if (verb.parser->parsed()) return run_verb(verb, joined(argc, argv));
  }
  std::fputs(
      "espdiff: a subcommand is missing: compare, trajectory, matrix, merge, plot, surface, potential, prepare, "
      "render, view or doctor; see espdiff --help\n",
      stderr);
  return 2;
}

}  // namespace

namespace espdiff::cli {

int run_command_line(int argc, char** argv) {
  if (!open_closed_streams()) return 1;
  try {
    return with_output_written(run(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "espdiff: internal error: %s; please report it with the command\n", error.what());
  } catch (...) {
    std::fputs("espdiff: internal error: an exception of unknown type; please report it with the command\n", stderr);
  }
  return 1;
}

}  // namespace espdiff::cli
