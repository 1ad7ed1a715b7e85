// text_lines.cpp: labels, units and columns of numbers, in lines of limited width.
#include "report/records/text_lines.h"

#include <cmath>
#include <sstream>

#include "base/formatted.h"

namespace espdiff {
namespace {

constexpr std::size_t kLineLabelWidth = 35, kUnitWidth = 7, kColumnWidth = 14;

std::string right(const std::string& text, std::size_t width) {
  return std::string(text.size() < width ? width - text.size() : 1, ' ') + text;
}

/// The words in lines that have room for `width` characters; a longer word has a line to itself.
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (lines.empty() || lines.back().size() + 1 + word.size() > width) {
      lines.push_back(word);
    } else {
      lines.back() += " " + word;
    }
  }
  return lines;
}

}  // namespace

std::string counted(std::size_t n, const std::string& noun, const std::string& plural) {
  return std::to_string(n) + " " + (n == 1 ? noun : plural.empty() ? noun + "s" : plural);
}

std::string share_of(double fraction) {
  return std::isfinite(fraction) ? formatted("%.3g", 100 * fraction) + " %" : "-";
}

void print_row(std::ostream& out, const std::string& label, const std::string& unit,
               const std::vector<std::string>& values) {
  out << padded("  " + label, kLineLabelWidth) << padded(unit, kUnitWidth);
  for (const std::string& value : values) out << right(value, kColumnWidth);
  out << '\n';
}

void print_heading(std::ostream& out, const std::string& title, const std::vector<std::string>& columns) {
  out << '\n' << padded(title, kLineLabelWidth + kUnitWidth);
  for (const std::string& column : columns) out << right(column, kColumnWidth);
  out << '\n';
}

void print_line(std::ostream& out, const std::string& label, const std::string& text) {
  out << padded("  " + label, kLineLabelWidth) << text << '\n';
}

void print_item(std::ostream& out, const std::string& text, std::size_t indent) {
  std::string before = std::string(indent, ' ') + "- ";
  for (const std::string& line : wrapped(text, kTextWidth - before.size())) {
    out << before << line << '\n';
    before.assign(before.size(), ' ');
  }
}

void print_wrapped(std::ostream& out, const std::string& text, const std::string& label, std::size_t label_width,
                   std::size_t n_lines) {
  const std::string cut = " ...";
  std::vector<std::string> lines = wrapped(text, kTextWidth - label_width);
  if (lines.size() > n_lines) {
    lines = wrapped(text, kTextWidth - label_width - cut.size());
    lines.resize(n_lines);
    lines.back() += cut;
  }
  for (std::size_t i = 0; i < lines.size(); ++i) out << padded(i == 0 ? label : "", label_width) << lines[i] << '\n';
}

std::string padded(const std::string& text, std::size_t width) {
  const std::size_t least = width > 0 ? 1 : 0;
  return text + std::string(text.size() < width ? width - text.size() : least, ' ');
}

}  // namespace espdiff
