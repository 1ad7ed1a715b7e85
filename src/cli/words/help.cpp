// help.cpp: what `--help` and `--help-all` print.
#include "cli/words/help.h"

#include <algorithm>
#include <memory>
#include <sstream>
#include <utility>

namespace espdiff::cli {
namespace {

constexpr std::size_t kWidth = 100;     // columns of a line
constexpr std::size_t kNameWidth = 28;  // columns of an option's name and value

/// Text broken into lines at blanks; each begins at column `indent`, where the first one already stands.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::string out;
  std::size_t column = indent;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > kWidth) {
      out += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  return out;
}

/// A name, and what it means beside it, or below it where the name is long.
std::string entry(const std::string& name, const std::string& meaning) {
  std::string line = "  " + name;
  if (line.size() + 2 > kNameWidth)
    line += '\n' + std::string(kNameWidth, ' ');
  else
    line.resize(kNameWidth, ' ');
  return line + wrapped(meaning, kNameWidth) + '\n';
}

/// The beginning of a help text, for the short help: the last phrase that ends on its line, or else the first
/// statement.
std::string first_statement(const std::string& text) {
  const std::string statement = text.substr(0, std::min(text.find(". "), text.find("; ")));
  constexpr std::size_t kFits = kWidth - kNameWidth;
  if (statement.size() <= kFits) return statement;
  std::size_t last = std::string::npos;
  int n_open = 0;
  constexpr std::size_t kSaysEnough = 24;  // not the first words of a long list
  for (std::size_t i = 0; i <= kFits; ++i) {
    n_open += statement[i] == '(' ? 1 : statement[i] == ')' ? -1 : 0;
    if (i >= kSaysEnough && n_open == 0 && (statement[i] == ',' || statement[i] == ':')) last = i;
  }
  return statement.substr(0, last);
}

std::string option_entry(const CLI::Option& option, bool is_short) {
  std::string name;
  std::vector<std::string> names = option_names(option);
  std::reverse(names.begin(), names.end());  // "-o, --output"
  for (const std::string& one : names) name += (name.empty() ? "" : ", ") + one;
  const std::string value = value_name(option);
  if (!value.empty()) name += ' ' + value;
  const std::string start = option.get_default_str();
  const std::string& help = option.get_description();
  return entry(name, (is_short ? first_statement(help) : help) +
                         (start.empty() || value.empty() ? "" : " (default " + start + ")") +
                         (option.get_required() ? " (required)" : ""));
}

bool is_shown(const CLI::Option& option) { return option.nonpositional() && !option.get_group().empty(); }

std::string arguments(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options([](const CLI::Option* o) { return o->get_positional(); }))
    text += entry(option->get_name(true), option->get_description());
  return text;
}

std::string all_options(const CLI::App& app) {
  std::string text;
  for (const std::string& group : app.get_groups()) {
    std::string entries;
    for (const CLI::Option* option : app.get_options()) {
      if (is_shown(*option) && option->get_group() == group) entries += option_entry(*option, false);
    }
    if (!entries.empty()) text += '\n' + group + ":\n" + entries;
  }
  return text;
}

/// Prints the short help or, for CLI11's mode "all", the whole.
class HelpText : public CLI::FormatterBase {
 public:
  explicit HelpText(ShortHelp help) : help_(std::move(help)) {}

  std::string make_help(const CLI::App* app, std::string /*name*/, CLI::AppFormatMode mode) const override {
    const bool is_whole = mode == CLI::AppFormatMode::All, is_short = !is_whole && !help_.options.empty();
    std::string text = wrapped(app->get_description(), 0) + "\n\nUsage: " + usage_line(*app) + '\n' + arguments(*app);
    const bool has_commands = !help_.rare.empty();
    if (has_commands)
      text += is_whole ? all_options(*app) + commands(*app) : usual_commands(*app);
    else
      text += is_short ? some_options(*app) : all_options(*app);
    if (!is_short && !app->get_footer().empty()) text += '\n' + app->get_footer() + '\n';
    if (!help_.examples.empty()) text += "\nExamples:\n";
    for (const std::string& example : help_.examples) text += "  " + example + '\n';
    if (has_commands && !is_whole) text += "\nOptions: espdiff COMMAND --help; version: espdiff -v\n";
    if (is_short) text += "\nAll options: " + usage_name(*app) + " --help-all\n";
    return text;
  }

 private:
  ShortHelp help_;

  static std::string usage_name(const CLI::App& app) {
    return (app.get_parent() != nullptr ? app.get_parent()->get_name() + ' ' : "") + app.get_name();
  }

  std::string some_options(const CLI::App& app) const {
    std::string text = "\nOptions:\n";
    std::istringstream names(help_.options);
    for (std::string name; names >> name;) text += option_entry(*app.get_option(name), true);
    return text;
  }

  /// A line for each command, and one for the names of the others.
  std::string usual_commands(const CLI::App& app) const {
    std::string text = "\nCommands:\n", others = help_.rare;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
      if ((' ' + help_.rare + ' ').find(' ' + command->get_name() + ' ') != std::string::npos) continue;
      text += entry(command->get_name(), first_statement(command->get_description()));
    }
    for (std::size_t at = 0; (at = others.find(' ', at)) != std::string::npos; at += 2) others.insert(at, 1, ',');
    return text + entry("and", others);
  }

  static std::string commands(const CLI::App& app) {
    std::string text;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
      text += entry(command->get_name(), command->get_description());
    return text.empty() ? "" : "\nCommands:\n" + text;
  }
};

}  // namespace

void set_help(CLI::App& parser, ShortHelp help) { parser.formatter(std::make_shared<HelpText>(std::move(help))); }

std::string usage_line(const CLI::App& parser) {
  const bool has_commands = parser.get_parent() == nullptr;
  if (has_commands)
    return parser.get_name() + " SOURCE TARGET [OPTION ...]   or   " + parser.get_name() + " COMMAND ...";
  std::string line = parser.get_parent()->get_name() + ' ' + parser.get_name();
  for (const CLI::Option* option : parser.get_options([](const CLI::Option* o) { return o->get_positional(); })) {
    const std::string name = option->get_name(true) + (option->get_expected_max() > 1 ? " ..." : "");
    line += option->get_required() ? ' ' + name : " [" + name + ']';
  }
  return line + " [OPTION ...]";
}

std::vector<std::string> option_names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

std::string value_name(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return {};  // a switch
  const std::vector<std::string> choices = choices_of(option);
  if (!choices.empty()) {
    std::string text;
    for (const std::string& choice : choices) text += (text.empty() ? "" : "|") + choice;
    return text;
  }
  const std::string type = option.get_type_name(), plain = type.substr(0, type.find(':'));
  return plain == "INT" || plain == "FLOAT" || plain == "UINT" ? "NUMBER" : plain;
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  std::string list = option.get_type_name();
  const std::size_t brace = list.find(":{");  // as CLI11 writes its IsMember
  if (brace != std::string::npos) list = list.substr(brace + 2, list.rfind('}') - brace - 2);
  std::replace(list.begin(), list.end(), ',', '|');
  std::vector<std::string> choices;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, '|');) choices.push_back(word);
  return choices.size() > 1 ? choices : std::vector<std::string>();
}

}  // namespace espdiff::cli
