// interface_report.h: the complementarity of an interface as JSON and in words.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace espdiff {

struct InterfaceComparison;
struct InterfaceRow;
struct StateComplementarity;
class Record;

/// Keys: structure, potential, n_atoms_left_out, pearson, spearman, and of `first` and `second` pearson, spearman,
/// area_A2, buried_area_A2.
nlohmann::ordered_json complementarity_json(const StateComplementarity& state);

/// Keys: pearson, spearman; the target's less the source's.
nlohmann::ordered_json change_of_complementarity(const StateComplementarity& source,
                                                 const StateComplementarity& target);

/// OUT.json's `interface`: first, second, source, target, change; null without one.
nlohmann::ordered_json interface_json(const InterfaceComparison& interface);

/// OUT.interface.csv: the columns of each state, and with two the change of the contribution.
void write_interface_rows(std::ostream& out, const std::string& first, const std::string& second, std::size_t n_states,
                          const std::vector<InterfaceRow>& rows);

/// A state's lines. @param interface the object with the partners  @param state "source" or "target"
void print_complementarity(std::ostream& out, const Record& interface, const char* state);

/// "change +0.123 (Pearson), +0.110 (Spearman)"
void print_change_of_complementarity(std::ostream& out, const Record& interface);

/// Both states and the change, in a section of their own; nothing without an interface.
/// @param record OUT.json
void print_interface(std::ostream& out, const Record& record);

}  // namespace espdiff
