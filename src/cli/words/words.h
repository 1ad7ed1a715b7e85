// words.h: what a user typed, as the parser takes it; and what is wrong with it, in our words.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace espdiff::cli {

/// The words behind the program's name, as the parser takes them: `A B` compares, `help VERB` is `VERB --help`, and
/// `-v` is `--version`.
std::vector<std::string> understood(std::vector<std::string> words, const CLI::App& app);

/// @throws CLI::ValidationError (an empty word, as of a variable that is not set; a title may be empty)
void refuse_empty(const std::vector<std::string>& words);

/// What is wrong with the words, in one sentence, and the nearest right word where there is one.
std::string in_our_words(const CLI::ParseError& error, const CLI::App& app);

/// Where to look after a wrong word: "espdiff compare --help".
std::string help_command(const CLI::App& app);

/// The candidate that is nearest to the word by changes of letters, at most a third of the word's; empty if none is.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);
/// " (did you mean coulomb?)", or nothing. @param candidates as of nearest_word()
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace espdiff::cli
