// text_cursor.h: walks through a text file by words, numbers and lines, and names the line when something is wrong.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace espdiff {

/// Reads all of `word` as a finite decimal number: "1", "+1.5", "-2e-3", also Fortran's "1.0D-3". Too small becomes 0.
/// Independent of the locale. Returns false, and leaves `value`, for anything else ("nan", "inf", "1.2x", "", "1e999").
bool parse_number(std::string_view word, double& value);

/// Reads all of `word` as a decimal integer that fits; a leading "+" is allowed.
bool parse_integer(std::string_view word, long long& value);

/// Of the Latin alphabet, whatever locale the host program has set.
bool is_letter(char c);

/// `text` without blanks (space, tab, carriage return) at both ends.
std::string_view trimmed(std::string_view text);

/// `text` in ASCII lower case.
std::string lower_case(std::string_view text);

/// Words of a line, separated by blanks; the first 10,000 of a line that has more, so that a hostile one takes no
/// memory.
std::vector<std::string_view> split_words(std::string_view line);

/// For messages: 'text', on one line, at most 40 characters of it, all but printable ASCII as '?'.
std::string in_quotes(std::string_view text);

/// A position in a text. Line numbers are counted only when asked for, from where they were counted last, so that
/// reading values is fast, and so is asking at each line.
class TextCursor {
 public:
  /// Keeps references to both: they must outlive the cursor.
  TextCursor(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  /// Skips blanks and line ends; true when nothing follows.
  bool at_end();

  /// Next word, or an empty one at the end. The word's start is where fail() points.
  std::string_view next_word();

  /// Next word without moving on.
  std::string_view peek_word();

  /// What is left of this line, without its end; moves to the next line.
  std::string_view rest_of_line();

  /// Next word as a finite number. `what` names it in the message: "delta", "value 17".
  /// @throws FormatError
  double next_number(const char* what);

  /// Next word as an integer. @throws FormatError
  long long next_integer(const char* what);

  /// As next_number(), but returns false, and stays put, when there is no next word or it is not a finite number.
  bool try_number(double& value);

  /// As try_number(), for grid values: numbers beyond the range of float are refused, those too small become 0.
  bool try_value(float& value);

  /// As try_value(), of numbers in columns that may touch, as Fortran writes them: a number also ends where a sign
  /// begins the next ("-0.12E-01-0.34E-02"), and three digits behind a sign are an exponent without its letter
  /// ("0.5643-102").
  bool try_column_value(float& value);

  std::size_t n_bytes_left() const { return text_.size() - position_; }

  /// Line of the word or line read last, from 1.
  long line() const;

  /// @throws FormatError at line().
  [[noreturn]] void fail(const std::string& message) const;

 private:
  std::string_view text_;
  const std::string& path_;
  std::size_t position_ = 0;
  std::size_t mark_ = 0;  // start of the word or line read last
  mutable std::size_t counted_to_ = 0;
  mutable long n_counted_ = 0;  // line ends before counted_to_
};

}  // namespace espdiff
