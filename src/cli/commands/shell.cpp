// shell.cpp: `espdiff completion SHELL` and `espdiff man [COMMAND]`, made from the commands' own options.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <iostream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/version.h"
#include "cli/verbs.h"
#include "cli/words/help.h"

namespace espdiff::cli {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* o) { return o->nonpositional() && !o->get_group().empty(); });
}

std::string replaced_all(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
    text.replace(at, what.size(), with);
  return text;
}

/// A script that bash sources.
std::string bash_completion(const CLI::App& app) {
  std::string names, options, values;
  for (const CLI::App* command : commands_of(app)) {
    names += ' ' + command->get_name();
    options += "    " + command->get_name() + ") words=\"";
    for (const CLI::Option* option : options_of(*command)) {
      std::string alternatives, choices;
      for (const std::string& name : option_names(*option)) {
        options += name + ' ';
        alternatives += (alternatives.empty() ? "\"" : "|\"") + command->get_name() + ' ' + name + '"';
      }
      for (const std::string& choice : choices_of(*option)) choices += choice + ' ';
      if (!choices.empty()) values += "    " + alternatives + ") words=\"" + choices + "\" ;;\n";
    }
    options += "\" ;;\n";
  }
  return "_espdiff() {\n"
         "  local word=\"${COMP_WORDS[COMP_CWORD]}\" command=\"${COMP_WORDS[1]}\" words=\"\"\n"
         "  if ((COMP_CWORD == 1)); then words=\"" +
         names + " --help --version\"\n  elif [[ \"$word\" == -* ]]; then case \"$command\" in\n" + options +
         "  esac; else case \"$command ${COMP_WORDS[COMP_CWORD-1]}\" in\n" + values +
         "  esac; fi\n  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n}\ncomplete -o default -F _espdiff "
         "espdiff\n";
}

/// A function for a folder of zsh's fpath.
std::string zsh_completion(const CLI::App& app) {
  const auto plain = [](std::string text) {
    for (const char* special : {"'", "[", "]", ":", "`"}) text = replaced_all(text, special, " ");
    return text.substr(0, text.find(". "));
  };
  std::string names, cases;
  for (const CLI::App* command : commands_of(app)) {
    names += "    '" + command->get_name() + ':' + plain(command->get_description()) + "'\n";
    cases += "    " + command->get_name() + ") _arguments";
    for (const CLI::Option* option : options_of(*command)) {
      std::string choices;
      for (const std::string& choice : choices_of(*option)) choices += choice + ' ';
      for (const std::string& name : option_names(*option))
        cases += " \\\n      '*" + name + '[' + plain(option->get_description()) + ']' +
                 (value_name(*option).empty() ? "'"
                  : choices.empty()           ? ":value:_files'"
                                              : ":value:(" + choices + ")'");
    }
    cases += " \\\n      '*:file:_files' ;;\n";
  }
  return "#compdef espdiff\nlocal -a commands\ncommands=(\n" + names +
         ")\nif ((CURRENT == 2)); then\n  _describe command commands\n  _files\nelse\n  shift words\n  ((CURRENT--))\n"
         "  case \"${words[1]}\" in\n" +
         cases + "    *) _files ;;\n  esac\nfi\n";
}

/// Text that roff prints as it stands.
std::string roff(std::string text) {
  text = replaced_all(replaced_all(text, "\\", "\\e"), "-", "\\-");
  text = replaced_all(replaced_all(text, "\n.", "\n\\&."), "\n'", "\n\\&'");
  return !text.empty() && (text[0] == '.' || text[0] == '\'') ? "\\&" + text : text;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

std::string page_start(const std::string& name, const std::string& purpose, const std::string& usage) {
  return ".TH " + upper(roff(name)) + " 1 \"\" \"espdiff " + std::string(kVersion) + "\" \"espdiff\"\n" +
         ".ad l\n.SH NAME\n" + roff(name) + " \\- " + roff(purpose) + "\n.SH SYNOPSIS\n.B " + roff(usage) + '\n';
}

/// The manual page of the program: its commands.
std::string man_page(const CLI::App& app) {
  std::string page = page_start("espdiff", "compare electrostatic surface potentials of molecules of different shape",
                                "espdiff COMMAND [OPTION ...]") +
                     ".SH COMMANDS\n";
  std::string others;
  for (const CLI::App* command : commands_of(app)) {
    page += ".TP\n.B " + roff(command->get_name()) + '\n' + roff(command->get_description()) + '\n';
    others += (others.empty() ? "" : ",\n") + (".BR " + roff("espdiff-" + command->get_name())) + " (1)";
  }
  return page + ".SH SEE ALSO\n" + others + '\n';
}

/// The manual page of a command.
std::string man_page(const CLI::App& app, const CLI::App& command) {
  std::string page =
      page_start(app.get_name() + '-' + command.get_name(), command.get_description(), usage_line(command)) +
      ".SH ARGUMENTS\n";
  for (const CLI::Option* option : command.get_options([](const CLI::Option* o) { return o->get_positional(); }))
    page += ".TP\n.I " + roff(option->get_name(true)) + '\n' + roff(option->get_description()) + '\n';
  for (const std::string& group : command.get_groups()) {
    std::string entries;
    for (const CLI::Option* option : options_of(command)) {
      if (option->get_group() != group) continue;
      std::string names;
      for (const std::string& one : option_names(*option)) names += (names.empty() ? "" : ", ") + one;
      entries += ".TP\n.B " + roff(names + ' ' + value_name(*option)) + '\n' + roff(option->get_description()) + '\n';
    }
    if (!entries.empty()) page += ".SH " + upper(roff(group)) + '\n' + entries;
  }
  if (!command.get_footer().empty()) page += ".SH NOTES\n.nf\n" + roff(command.get_footer()) + "\n.fi\n";
  return page;
}

const CLI::App& command_named(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : commands_of(app)) {
    if (command->get_name() == name) return *command;
  }
  throw InputError("there is no command '" + name + "'; espdiff --help lists them");
}

}  // namespace

Verb add_completion(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* parser = app.add_subcommand("completion", "Print the completion of commands and options for a shell");
  parser->add_option("SHELL", *shell, "bash or zsh")->required()->check(CLI::IsMember({"bash", "zsh"}));
  set_help(*parser, {"",
                     {"source <(espdiff completion bash)     # in ~/.bashrc",
                      "espdiff completion zsh > ~/.zfunc/_espdiff     # a folder of fpath"}});
  return {parser, [shell, &app](const Context&) {
            std::cout << (*shell == "bash" ? bash_completion(app) : zsh_completion(app));
            return 0;
          }};
}

Verb add_man(CLI::App& app) {
  auto command = std::make_shared<std::string>();
  CLI::App* parser = app.add_subcommand("man", "Print the manual page of the program or of a command");
  parser->add_option("COMMAND", *command, "A command of espdiff; the program itself when none is named");
  set_help(*parser, {"", {"espdiff man compare | man -l -"}});
  return {parser, [command, &app](const Context&) {
            std::cout << (command->empty() ? man_page(app) : man_page(app, command_named(app, *command)));
            return 0;
          }};
}

}  // namespace espdiff::cli
