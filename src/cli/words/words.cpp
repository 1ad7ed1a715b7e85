// words.cpp: what a user typed, as the parser takes it; and what is wrong with it, in our words.
#include "cli/words/words.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <sstream>

#include "cli/words/help.h"
#include "io/text/entry_code.h"
#include "io/text/text_cursor.h"

namespace espdiff::cli {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names = {"help"};
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::vector<std::string> all_option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    const std::vector<std::string> of_option = option_names(*option);
    names.insert(names.end(), of_option.begin(), of_option.end());
  }
  return names;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_option(const std::string& word) { return word.size() > 1 && word[0] == '-'; }

/// Whether a word is meant as a file: there is one, or it is written as a path or with an ending.
bool is_file_name(const std::string& word) {
  std::error_code ignored;
  return std::filesystem::exists(word, ignored) || word.find('/') != std::string::npos ||
         word.find('.') != std::string::npos;
}

/// The command that was typed, or the program where none was.
const CLI::App& chosen(const CLI::App& app) {
  const std::vector<CLI::App*> commands = app.get_subcommands();
  return commands.empty() ? app : *commands.front();
}

/// Number of letters that are inserted, removed, replaced or exchanged with their neighbour.
std::size_t changes_between(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = last;
    last = row;
  }
  return last.back();
}

/// Of CLI11's "--potential: pbe not in {auto,pb,pme}".
std::string not_a_choice(const std::string& text, const std::string& name, std::size_t at) {
  const std::string word = text.substr(name.size() + 2, at - name.size() - 2);
  std::string list = text.substr(at + 9, text.rfind('}') - at - 9), joined;
  std::vector<std::string> choices;
  std::istringstream words(list);
  for (std::string choice; std::getline(words, choice, ',');) {
    choices.push_back(choice);
    joined += (joined.empty() ? "" : ", ") + choice;
  }
  return name + ": " + in_quotes(word) + " is none of " + joined + did_you_mean(word, choices);
}

std::string left_over(const std::string& word, const CLI::App& app) {
  const CLI::App& command = chosen(app);
  if (is_option(word))
    return in_quotes(word) + ": there is no such option" + did_you_mean(word, all_option_names(command));
  if (&command != &app) return in_quotes(word) + " is one argument too many: " + usage_line(command);
  if (const std::string advice = entry_advice(word); !advice.empty()) return in_quotes(word) + ": " + advice;
  return in_quotes(word) + " is neither a command nor a file" + did_you_mean(word, command_names(app));
}

}  // namespace

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_word(word, candidates);
  return nearest.empty() ? "" : " (did you mean " + nearest + "?)";
}

std::vector<std::string> understood(std::vector<std::string> words, const CLI::App& app) {
  if (words.empty()) return words;
  if (words.front() == "-v") words.front() = "--version";
  const std::vector<std::string> commands = command_names(app);
  if (words.front() == "help") {
    words.erase(words.begin());
    if (words.empty() || contains(commands, words.front())) words.emplace_back("--help");
    return words;
  }
  // Two files, with options before, between or behind them, are a comparison; a mistyped command is not.
  const bool has_file = std::any_of(words.begin(), words.end(), is_file_name);
  if (contains(commands, words.front()) || !has_file) return words;
  if (is_option(words.front()) || is_file_name(words.front())) words.insert(words.begin(), "compare");
  return words;
}

void refuse_empty(const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!words[i].empty() || (i > 0 && words[i - 1] == "--title")) continue;
    throw CLI::ValidationError("there is an empty argument behind '" + (i > 0 ? words[i - 1] : std::string("espdiff")) +
                               "', as of a variable that is not set; give a name, or leave it out");
  }
}

std::string in_our_words(const CLI::ParseError& error, const CLI::App& app) {
  const std::string text = error.what(), name = text.substr(0, text.find(": "));
  const auto is = [&](CLI::ExitCodes code) { return error.get_exit_code() == static_cast<int>(code); };
  if (is(CLI::ExitCodes::ArgumentMismatch)) {
    const bool too_many = text.find("At Most") != std::string::npos;
    return name + (too_many ? ": is given more than once; give it once" : ": a value is missing behind it");
  }
  if (is(CLI::ExitCodes::RequiredError)) {
    const std::string missing = text.substr(0, text.find(' '));
    const bool is_alone = missing == "TARGET" && chosen(app).get_name() == "compare";
    return missing + " is missing: " + usage_line(chosen(app)) +
           (is_alone ? "; the potential of one structure: espdiff surface SOURCE --potential pb" : "");
  }
  if (const std::size_t at = text.find(" not in {"); at != std::string::npos) return not_a_choice(text, name, at);
  // All that is left over, the first word last.
  if (is(CLI::ExitCodes::ExtrasError)) return left_over(text.substr(text.rfind(' ') + 1), app);
  return text;
}

std::string help_command(const CLI::App& app) {
  const CLI::App& command = chosen(app);
  return (&command == &app ? app.get_name() : app.get_name() + ' ' + command.get_name()) + " --help";
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates) {
  std::string nearest;
  std::size_t fewest = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t changes = changes_between(word, candidate);
    if (changes >= fewest) continue;
    fewest = changes;
    nearest = candidate;
  }
  return nearest;
}

}  // namespace espdiff::cli
