// compare_answer.h: what most readers need of a comparison's record.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>

namespace espdiff {

struct CompareResult;

/// Prints what most readers need of a record: the verdict with its reasons, the numbers, what they rest on, the causes
/// that were asked for, and the warnings, the most important first; about twenty lines. Long warnings are cut.
/// @param show the command that prints the whole record; empty for none
void print_answer(std::ostream& out, const nlohmann::ordered_json& record, const std::string& show);

/// Prints the verdict and the main number in one line: "TRUSTWORTHY: mean absolute difference 0.397 kT/e".
void print_verdict_line(std::ostream& out, const CompareResult& result);

}  // namespace espdiff
