// fields.cpp: `espdiff fields`: the quantities that surfaces can be compared by.
#include <iostream>

#include "cli/verbs.h"
#include "cli/words/help.h"
#include "field/field_kinds.h"

namespace espdiff::cli {
namespace {

/// A text in lines of at most 100 columns, indented.
void print_wrapped(std::ostream& out, const std::string& text) {
  constexpr std::size_t kColumns = 100, kIndent = 4;
  std::string line(kIndent, ' ');
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (line.size() + word.size() + 1 > kColumns) {
      out << line << '\n';
      line.assign(kIndent, ' ');
    }
    line += (line.size() > kIndent ? " " : "") + word;
  }
  out << line << '\n';
}

int fields_verb() {
  std::cout << "potential (always)\n";
  print_wrapped(std::cout, "Electrostatic potential, given as maps or computed; --potential chooses which.");
  for (const FieldKind& kind : field_kinds()) {
    const Quantity& q = kind.quantity;
    const bool is_optional = !kind.argument.empty() && kind.argument.front() == '[';
    std::cout << '\n' << q.name;
    if (is_optional)
      std::cout << "[:" << kind.argument.substr(1);
    else if (!kind.argument.empty())
      std::cout << ':' << kind.argument;
    std::cout << (q.unit.empty() ? "" : " (" + q.unit + ")") << (q.is_signed ? ", signed" : "") << '\n';
    print_wrapped(std::cout, kind.help + ".");
    if (!kind.reference.empty()) print_wrapped(std::cout, "From: " + kind.reference + ".");
  }
  return 0;
}

}  // namespace

Verb add_fields(CLI::App& app) {
  CLI::App* parser =
      app.add_subcommand("fields", "List the quantities that `compare --field` compares, with their sources");
  set_help(*parser, {"", {"espdiff fields", "espdiff compare a.pdb b.pdb --field hydrophobicity -o result"}});
  return {parser, [](const Context&) { return fields_verb(); }};
}

}  // namespace espdiff::cli
