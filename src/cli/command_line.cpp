// command_line.cpp: parses the command line, runs the command, and turns errors into a line, the next command, and an
// exit status.
#include "cli/command_line.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/text/printable.h"
#include "base/text/system_message.h"
#include "base/text/translate.h"
#include "base/version.h"
#include "cli/terminal_progress.h"
#include "cli/verbs.h"
#include "cli/verdict_status.h"
#include "cli/words/help.h"
#include "cli/words/next_command.h"
#include "cli/words/spelling.h"
#include "cli/words/words.h"
#include "system/standard_streams.h"

namespace {

std::string joined(int argc, char** argv) {
  std::string line = "espdiff";
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  return line;
}

/// Runs the chosen command; errors become a line on standard error, with the command that most likely helps below.
int run_verb(const espdiff::cli::Verb& verb, const std::string& command_line, const std::vector<std::string>& words) {
  espdiff::cli::TerminalProgress terminal;
  const auto fail = [&](const char* message, int status) {
    terminal.clear();
    std::fprintf(stderr, "espdiff: %s\n", espdiff::printable(message).c_str());
    return status;
  };
  try {
    espdiff::cli::Context context;
    context.command_line = command_line;
    context.words = words;
    context.progress = &terminal.progress();
    return verb.run(context);
  } catch (const std::exception& error) {
    const espdiff::Error ours = espdiff::translated(error);
    const int status = fail(espdiff::cli::spelled(ours.message()).c_str(), ours.exit_status());
    const espdiff::NextCommand& next = ours.message().next();
    const std::string line = next.empty() ? "" : espdiff::cli::next_command(words, next);
    if (!line.empty()) std::fprintf(stderr, "next: %s\n", espdiff::printable(line).c_str());
    return status;
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
  return status == 0 || status == espdiff::cli::kNotTrustedStatus ? 1 : status;
}

int run(int argc, char** argv) {
  CLI::App app(
      "espdiff shows where and by how much the electrostatic surface potential differs between two states of a "
      "molecule, and how "
      "far the answer can be trusted.");
  app.name("espdiff");
  app.set_help_flag("-h,--help", "Print the most used options");
  app.set_help_all_flag("--help-all", "Print all options");
  app.set_version_flag("--version,-v", std::string("espdiff ") + espdiff::kVersion, "Print the version");
  app.require_subcommand(0, 1);
  espdiff::cli::set_help(app, {"",
                               {"espdiff wild.pdb mutant.pdb", "espdiff render wild_mutant -o difference.png"},
                               "merge plot surface potential verify completion man"});
  std::vector<espdiff::cli::Verb> verbs = {espdiff::cli::add_compare(app),    espdiff::cli::add_trajectory(app),
                                           espdiff::cli::add_matrix(app),     espdiff::cli::add_ensemble(app),
                                           espdiff::cli::add_merge(app),      espdiff::cli::add_plot(app),
                                           espdiff::cli::add_surface(app),    espdiff::cli::add_potential(app),
                                           espdiff::cli::add_prepare(app),    espdiff::cli::add_render(app),
                                           espdiff::cli::add_show(app),       espdiff::cli::add_report(app),
                                           espdiff::cli::add_export(app),     espdiff::cli::add_complementarity(app),
                                           espdiff::cli::add_fields(app),     espdiff::cli::add_view(app),
                                           espdiff::cli::add_verify(app),     espdiff::cli::add_doctor(app),
                                           espdiff::cli::add_completion(app), espdiff::cli::add_man(app)};
  try {
    std::vector<std::string> words = espdiff::cli::understood({argv + std::min(argc, 1), argv + argc}, app);
    espdiff::cli::refuse_empty(words);
    std::reverse(words.begin(), words.end());  // as CLI11 takes a vector
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::fprintf(stderr, "espdiff: %s; see %s\n", espdiff::printable(espdiff::cli::in_our_words(error, app)).c_str(),
                 espdiff::cli::help_command(app).c_str());
    return 2;
  }
  for (const auto& verb : verbs) {
    if (verb.parser->parsed()) return run_verb(verb, joined(argc, argv), {argv + 1, argv + argc});
  }
  std::fputs("espdiff: nothing to do: give two structures to compare, or a command; see espdiff --help\n", stderr);
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
