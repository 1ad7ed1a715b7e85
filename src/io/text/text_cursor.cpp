// text_cursor.cpp: words, numbers and line numbers of text files.
#include "io/text/text_cursor.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace espdiff {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
bool is_space(char c) { return is_blank(c) || c == '\n'; }

/// from_chars() says "out of range" for both ends: text such as 1e-400 is 0 for our purposes, 1e400 is an error.
bool is_underflow(std::string_view word) {
  const std::size_t exponent = word.find_first_of("eE");
  return exponent != std::string_view::npos && exponent + 1 < word.size() && word[exponent + 1] == '-';
}

/// from_chars() does not know "+1". False for words that hold no number anyway: "", "+", "+-1".
bool drop_plus(std::string_view& word) {
  if (word.empty() || word.front() != '+') return !word.empty();
  word.remove_prefix(1);
  return !word.empty() && word.front() != '+' && word.front() != '-';
}

}  // namespace

bool parse_number(std::string_view word, double& value) {
  if (!drop_plus(word)) return false;
  double number = 0;
  const char* const end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, number);
  if (result.ptr != end) {
    // Fortran writes double precision exponents with D.
    const bool is_fortran = result.ec == std::errc() && (*result.ptr == 'D' || *result.ptr == 'd');
    if (!is_fortran) return false;
    std::string with_e(word);
    with_e[static_cast<std::size_t>(result.ptr - word.data())] = 'e';
    return parse_number(with_e, value);
  }
  if (result.ec == std::errc::result_out_of_range && is_underflow(word))
    number = 0;
  else if (result.ec != std::errc() || !std::isfinite(number))
    return false;
  value = number;
  return true;
}

bool parse_integer(std::string_view word, long long& value) {
  if (!drop_plus(word)) return false;
  long long number = 0;
  const auto result = std::from_chars(word.data(), word.data() + word.size(), number);
  if (result.ec != std::errc() || result.ptr != word.data() + word.size()) return false;
  value = number;
  return true;
}

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::vector<std::string_view> split_words(std::string_view line) {
  constexpr std::size_t kMostWords = 10000;
  std::vector<std::string_view> words;
  std::size_t begin = 0;
  while (true) {
    while (begin < line.size() && is_space(line[begin])) ++begin;
    if (begin == line.size() || words.size() == kMostWords) return words;
    std::size_t end = begin;
    while (end < line.size() && !is_space(line[end])) ++end;
    words.push_back(line.substr(begin, end - begin));
    begin = end;
  }
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string shown(text.substr(0, kLongest));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
  }
  return "'" + shown + (text.size() > kLongest ? "..." : "") + "'";
}

bool TextCursor::at_end() {
  while (position_ < text_.size() && is_space(text_[position_])) ++position_;
  return position_ == text_.size();
}

std::string_view TextCursor::next_word() {
  at_end();
  mark_ = position_;
  while (position_ < text_.size() && !is_space(text_[position_])) ++position_;
  return text_.substr(mark_, position_ - mark_);
}

std::string_view TextCursor::peek_word() {
  const std::string_view word = next_word();
  position_ = mark_;
  return word;
}

std::string_view TextCursor::rest_of_line() {
  mark_ = position_;
  const std::size_t end = std::min(text_.find('\n', position_), text_.size());
  position_ = std::min(end + 1, text_.size());
  return trimmed(text_.substr(mark_, end - mark_));
}

bool TextCursor::try_number(double& value) {
  at_end();
  mark_ = position_;
  // The common case first: a plain number followed by a blank, without looking for the word's end beforehand.
  const char* const begin = text_.data() + position_;
  const char* const end = text_.data() + text_.size();
  const auto result = std::from_chars(begin, end, value);
  if (result.ec == std::errc() && (result.ptr == end || is_space(*result.ptr)) && std::isfinite(value)) {
    position_ += static_cast<std::size_t>(result.ptr - begin);
    return true;
  }
  const std::string_view word = next_word();
  if (parse_number(word, value)) return true;
  position_ = mark_;
  return false;
}

bool TextCursor::try_value(float& value) {
  double number = 0;
  if (!try_number(number)) return false;
  if (std::abs(number) > static_cast<double>(std::numeric_limits<float>::max())) {
    position_ = mark_;
    return false;
  }
  value = static_cast<float>(number);
  return true;
}

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_sign(char c) { return c == '+' || c == '-'; }

std::size_t digits_from(std::string_view text, std::size_t at) {
  std::size_t n = 0;
  while (at + n < text.size() && is_digit(text[at + n])) ++n;
  return n;
}

/// The length of the number that a word begins with, and the same in a form that parse_number() knows.
std::size_t first_number(std::string_view word, std::string& number) {
  std::size_t end = !word.empty() && is_sign(word[0]) ? 1 : 0;
  end += digits_from(word, end);
  if (end < word.size() && word[end] == '.') end += 1 + digits_from(word, end + 1);
  number = word.substr(0, end);
  if (end < word.size() && std::string_view("eEdD").find(word[end]) != std::string_view::npos) {
    const std::size_t sign = end + 1 < word.size() && is_sign(word[end + 1]) ? 1 : 0;
    const std::size_t n = digits_from(word, end + 1 + sign);
    number += "e" + std::string(word.substr(end + 1, sign + n));
    end += 1 + sign + n;
  } else if (end < word.size() && is_sign(word[end]) && digits_from(word, end + 1) == 3 &&
             (end + 4 == word.size() || is_sign(word[end + 4]))) {
    number += "e" + std::string(word.substr(end, 4));
    end += 4;
  }
  return end;
}

}  // namespace

bool TextCursor::try_column_value(float& value) {
  if (try_value(value)) return true;
  const std::string_view word = peek_word();
  std::string number;
  const std::size_t length = first_number(word, number);
  double parsed = 0;
  if (length == 0 || (length < word.size() && !is_sign(word[length])) || !parse_number(number, parsed)) return false;
  if (std::abs(parsed) > static_cast<double>(std::numeric_limits<float>::max())) return false;
  value = static_cast<float>(parsed);
  position_ = mark_ + length;
  return true;
}

double TextCursor::next_number(const char* what) {
  double value = 0;
  if (!try_number(value)) {
    const std::string_view word = peek_word();
    fail(std::string(what) + (word.empty() ? " is missing at the end of the file" : " is " + in_quotes(word)) +
         "; a finite number was expected");
  }
  return value;
}

long long TextCursor::next_integer(const char* what) {
  const std::string_view word = next_word();
  long long value = 0;
  if (!parse_integer(word, value)) {
    fail(std::string(what) + (word.empty() ? " is missing at the end of the file" : " is " + in_quotes(word)) +
         "; an integer was expected");
  }
  return value;
}

long TextCursor::line() const {
  // After the last newline the last line counts, not an empty one behind it.
  std::size_t position = mark_;
  if (position == text_.size()) {
    while (position > 0 && is_space(text_[position - 1])) --position;
  }
  if (position < counted_to_) counted_to_ = 0, n_counted_ = 0;
  const std::string_view more = text_.substr(counted_to_, position - counted_to_);
  n_counted_ += static_cast<long>(std::count(more.begin(), more.end(), '\n'));
  counted_to_ = position;
  return 1 + n_counted_;
}

void TextCursor::fail(const std::string& message) const { throw FormatError(path_, line(), message); }

}  // namespace espdiff
