// interface_report.cpp: numbers of interfaces, written and read.
#include "report/sections/interface_report.h"

#include <nlohmann/json.hpp>
#include <string>

#include "base/formatted.h"
#include "base/not_a_number.h"
#include "certificate/interface_numbers.h"
#include "certificate/result.h"
#include "io/files/write_csv.h"
#include "report/records/record.h"
#include "report/records/text_lines.h"
#include "report/sections/json_number.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

const char* const kPartners[] = {"first", "second"};
const char* const kStateNames[] = {"source", "target"};

/// The columns of a residue in one state.
struct InterfaceColumn {
  const char* name;
  double InterfaceResidue::*value;
};
const InterfaceColumn kInterfaceColumns[] = {{"area_A2", &InterfaceResidue::area_A2},
                                             {"contribution", &InterfaceResidue::contribution},
                                             {"mean_own_potential", &InterfaceResidue::mean_own},
                                             {"mean_other_potential", &InterfaceResidue::mean_other}};

}  // namespace

Json complementarity_json(const StateComplementarity& state) {
  Json json{{"structure", state.structure},
            {"potential", state.potential},
            {"n_atoms_left_out", state.n_left_out},
            {"pearson", json_number(state.pearson)},
            {"spearman", json_number(state.spearman)}};
  for (std::size_t side = 0; side < 2; ++side) {
    const SideComplementarity& of = state.sides[side];
    json[kPartners[side]] = {{"pearson", json_number(of.pearson)},
                             {"spearman", json_number(of.spearman)},
                             {"area_A2", json_number(of.area_A2)},
                             {"buried_area_A2", json_number(of.buried_area_A2)}};
  }
  return json;
}

Json change_of_complementarity(const StateComplementarity& source, const StateComplementarity& target) {
  return {{"pearson", json_number(target.pearson - source.pearson)},
          {"spearman", json_number(target.spearman - source.spearman)}};
}

Json interface_json(const InterfaceComparison& of) {
  Json json{{"first", of.first}, {"second", of.second}};
  json["source"] = complementarity_json(of.source);
  json["target"] = complementarity_json(of.target);
  json["change"] = change_of_complementarity(of.source, of.target);
  return json;
}

void write_interface_rows(std::ostream& out, const std::string& first, const std::string& second, std::size_t n_states,
                          const std::vector<InterfaceRow>& rows) {
  std::vector<std::string> names = {"partner", "chain", "residue_number", "insertion_code", "residue_name"};
  for (std::size_t s = 0; s < n_states; ++s) {
    for (const InterfaceColumn& column : kInterfaceColumns)
      names.push_back((n_states > 1 ? std::string(kStateNames[s]) + "_" : "") + column.name);
  }
  if (n_states > 1) names.emplace_back("change_of_contribution");
  write_csv_row(out, names);
  for (const InterfaceRow& row : rows) {
    const Residue& residue = row.residue;
    std::vector<std::string> cells = {row.side == 0 ? first : second, residue.chain, std::to_string(residue.number),
                                      residue.insertion_code == ' ' ? "" : std::string(1, residue.insertion_code),
                                      residue.name};
    for (std::size_t s = 0; s < n_states; ++s) {
      for (const InterfaceColumn& column : kInterfaceColumns)
        cells.push_back(csv_number(row.states[s] ? (*row.states[s]).*column.value : kNaN));
    }
    if (n_states > 1) cells.push_back(csv_number(row.change()));
    write_csv_row(out, cells);
  }
}

void print_complementarity(std::ostream& out, const Record& interface, const char* name) {
  constexpr std::size_t kWidth = 12;
  const Record state(interface.at(std::string("/") + name));
  out << state.text("/structure") << '\n'
      << formatted("  complementarity %.3f (Pearson), %.3f (Spearman)\n", state.number("/pearson"),
                   state.number("/spearman"));
  for (const char* partner : kPartners) {
    const Record side(state.at(std::string("/") + partner));
    out << "  on " << padded(interface.text(std::string("/") + partner), kWidth)
        << formatted("%.3f, %.3f over %.0f A^2 (%.0f A^2 buried, less the border)\n", side.number("/pearson"),
                     side.number("/spearman"), side.number("/area_A2"), side.number("/buried_area_A2"));
  }
  out << "  potential: " << state.text("/potential");
  if (const std::size_t n = state.count("/n_atoms_left_out"); n > 0)
    out << "; " << counted(n, "atom") << " of neither partner left out";
  out << '\n';
}

void print_change_of_complementarity(std::ostream& out, const Record& interface) {
  out << formatted("change %+.3f (Pearson), %+.3f (Spearman)\n", interface.number("/change/pearson"),
                   interface.number("/change/spearman"));
}

void print_interface(std::ostream& out, const Record& record) {
  if (!record.has("/interface")) return;
  const Record interface(record.at("/interface"));
  out << "\nElectrostatic complementarity of " << interface.text("/first") << " and " << interface.text("/second")
      << '\n';
  for (const char* state : {"source", "target"}) print_complementarity(out, interface, state);
  print_change_of_complementarity(out, interface);
}

}  // namespace espdiff
