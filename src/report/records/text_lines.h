// text_lines.h: the layout of printed tables: labels, units and columns of numbers.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace espdiff {

/// The width of printed text, in columns.
constexpr std::size_t kTextWidth = 100;

/// "1 atom", "2 atoms"; "2 vertices" with a plural of its own.
std::string counted(std::size_t n, const std::string& noun, const std::string& plural = "");
/// "12.3 %"; "-" for none.
std::string share_of(double fraction);

/// A line of numbers: label, unit, and one column for each value.
void print_row(std::ostream& out, const std::string& label, const std::string& unit,
               const std::vector<std::string>& values);
/// A heading over such lines.
void print_heading(std::ostream& out, const std::string& title, const std::vector<std::string>& columns);
/// A line in words: label and text.
void print_line(std::ostream& out, const std::string& label, const std::string& text);
/// "  - TEXT", its further lines indented like the first.
void print_item(std::ostream& out, const std::string& text, std::size_t indent = 2);
/// TEXT in lines of at most kTextWidth, the further ones below its beginning, behind a label; text of more than
/// `n_lines` is cut and ends in " ...".
void print_wrapped(std::ostream& out, const std::string& text, const std::string& label = "",
                   std::size_t label_width = 0, std::size_t n_lines = 100);

/// The text with blanks behind it, at least one where a width is given.
std::string padded(const std::string& text, std::size_t width);

}  // namespace espdiff
