// compare_answer.cpp: what most readers need of a comparison, in twenty lines: the most important ones.
#include "report/compare_answer.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include "base/formatted.h"
#include "certificate/result.h"
#include "certificate/trusted_area.h"
#include "report/field_patches_report.h"
#include "report/records/metrics.h"
#include "report/records/record.h"
#include "report/records/record_words.h"
#include "report/records/text_lines.h"

namespace espdiff {
namespace {

using Json = Record::Json;

constexpr std::size_t kLabelWidth = 27, kValueWidth = 16, kBasisWidth = 17;

/// The verdict; below it the reasons, in full, of one that refuses.
void print_brief_verdict(std::ostream& out, const Record& record) {
  const std::string verdict = record.text("/certificate/verdict");
  if (record.flag("/certificate/trustworthy")) {
    print_wrapped(out, verdict + ": the numbers rest on " + trusted_in_words(record) + unknown_signs(record));
    return;
  }
  out << verdict << ":\n";
  for (const std::string& reason : record.texts("/certificate/reasons")) print_item(out, reason);
}

/// Label, number with unit, and what belongs to it.
void print_brief_number(std::ostream& out, const std::string& label, const std::string& value,
                        const std::string& beside) {
  out << padded(label, kLabelWidth) << (beside.empty() ? value : padded(value + " ", kValueWidth) + beside) << '\n';
}

std::string number_with_unit(const Metric& metric, double value, const std::string& potential_unit) {
  const std::string unit = unit_of(metric, potential_unit);
  return formatted(metric, value) + (unit.empty() || std::isnan(value) ? "" : " " + unit);
}

/// What a metric's number means where its name does not say so.
std::string beside(const std::string& name, const Record& record) {
  if (name == "mean_abs_difference") return "whole surface: " + whole_surface_in_words(record);
  if (name == "mean_signed_difference") return "target - source";
  if (name == "hodgkin_index") return "1 same, 0 unrelated, -1 opposite";
  return {};
}

void print_brief_part(std::ostream& out, const std::string& title, const Json& json, const Record& whole) {
  const Record part(json);
  const Metric& mean = *find_metric_or_null(whole.has_potential() ? "mean_abs_difference" : "mean_displacement_A");
  const Metric& signed_mean = *find_metric_or_null("mean_signed_difference");
  std::string text = part.text("/certificate/verdict") + "; " + counted(part.count("/n_residues"), "residue");
  if (const std::string turned = turned_share_in_words(part); !turned.empty()) text += "; " + turned + " turned";
  if (whole.has_potential()) text = "signed " + formatted(signed_mean, part.value_of(signed_mean)) + "; " + text;
  print_brief_number(out, title, number_with_unit(mean, part.value_of(mean), whole.text("/potential_unit")), text);
  for (const std::string& reason : part.texts("/certificate/reasons")) print_item(out, reason, 4);
  if (part.has("/placement")) print_item(out, part.text("/placement/in_words"), 4);
}

void print_main_numbers(std::ostream& out, const Record& record) {
  const std::vector<const char*> names = record.has_potential()
                                             ? std::vector<const char*>{"mean_abs_difference", "mean_signed_difference",
                                                                        "sign_change_area_fraction", "hodgkin_index"}
                                             : std::vector<const char*>{"mean_displacement_A"};
  for (const char* name : names) {
    const Metric& metric = *find_metric_or_null(name);
    print_brief_number(out, metric.label,
                       number_with_unit(metric, record.value_of(metric), record.text("/potential_unit")),
                       beside(name, record));
  }
  for (const auto& [name, json] : record.at("/fields").items()) {
    const Record field(json);
    const std::string unit = field.text("/unit");
    print_brief_number(out, "Field " + name,
                       formatted("%.4g", field.number("/mean_abs_difference")) + (unit.empty() ? "" : " " + unit),
                       "mean absolute difference; signed " +
                           formatted("%.4g", field.number("/mean_signed_difference")) + ", correlation " +
                           formatted("%.3g", field.number("/correlation")));
  }
  if (record.has("/interface")) {
    const Record interface(record.at("/interface"));
    print_brief_number(
        out, "Complementarity",
        formatted("%.3f -> %.3f", interface.number("/source/pearson"), interface.number("/target/pearson")),
        "of " + interface.text("/first") + " and " + interface.text("/second") +
            formatted("; Spearman %.3f -> %.3f", interface.number("/source/spearman"),
                      interface.number("/target/spearman")));
  }
  for (const Json& patches : record.at("/field_patches"))
    print_wrapped(out, field_patches_in_words(Record(patches)), "Patches of " + Record(patches).text("/field"),
                  kLabelWidth, 2);
  if (record.has("/region")) print_brief_part(out, "Region", record.at("/region"), record);
  for (const auto& [name, patch] : record.at("/fixed_patches").items())
    print_brief_part(out, "Patch " + name, patch, record);
}

using Lines = std::vector<std::pair<std::string, std::string>>;

/// The record's notes, those without a label behind the one that they continue.
Lines joined_notes(const Record& record) {
  Lines lines;
  for (const Json& json : record.at("/notes")) {
    const Record note(json);
    if (note.text("/label").empty() && !lines.empty()) {
      lines.back().second += "; " + note.text("/text");
    } else {
      lines.emplace_back(note.text("/label"), note.text("/text"));
    }
  }
  return lines;
}

/// Both states, each with where its charges are from; these notes are taken away.
Lines states_in_words(const Record& record, Lines& notes) {
  Lines lines = {{"Source", input_in_words(record, "source")}, {"Target", input_in_words(record, "target")}};
  for (const auto& [label, text] : notes) {
    const std::string added = (text.rfind("of ", 0) == 0 ? "; charges " : "; ") + text;  // of a file, by a program
    if (label == "Charges, source") lines[0].second += added;
    if (label == "Charges, target") lines[1].second += added;
  }
  notes.erase(std::remove_if(notes.begin(), notes.end(),
                             [](const auto& note) { return note.first.rfind("Charges, ", 0) == 0; }),
              notes.end());
  return lines;
}

std::string pairing_in_words(const Record& record) {
  if (record.count("/n_paired_atoms") == 0) return "no atoms; compared where they lie";
  const Metric& rmsd = *find_metric_or_null("rmsd_A");
  return paired_in_words(record) + "; RMSD " + formatted(rmsd, record.value_of(rmsd)) + " A";
}

/// What is not trusted, of an answer on a part of the surface.
std::string untrusted_in_words(const Record& record) {
  const double trusted = std::min(record.number("/certificate/trusted_area_fraction/source"),
                                  record.number("/certificate/trusted_area_fraction/target"));
  std::string parts;
  if (!record.flag("/certificate/trustworthy") || !(trusted < kWholeShare)) return parts;
  for (const std::string& part : record.texts("/certificate/untrusted_parts"))
    parts += (parts.empty() ? "" : "; ") + part;
  return parts;
}

/// What the numbers rest on, the most important first.
Lines basis_of(const Record& record) {
  Lines notes = joined_notes(record), lines = states_in_words(record, notes);
  lines.emplace_back("Paired", pairing_in_words(record));
  if (record.has_potential()) {
    lines.emplace_back("Potential", record.has("/potential") ? record.text("/potential/label") : "of the given maps");
  } else {
    lines.emplace_back("Shapes alone", record.text("/shapes_because"));
  }
  lines.emplace_back("Turned", turned_in_words(record));
  lines.emplace_back("Not trusted", untrusted_in_words(record));
  const Lines chains = chains_in_words(record);
  lines.insert(lines.end(), chains.begin(), chains.end());
  lines.insert(lines.end(), notes.begin(), notes.end());
  lines.erase(std::remove_if(lines.begin(), lines.end(), [](const auto& line) { return line.second.empty(); }),
              lines.end());
  return lines;
}

/// Without those that the verdict gives as its reasons.
std::vector<std::string> further_warnings(const Record& record) {
  std::vector<std::string> warnings = record.texts("/warnings");
  if (record.flag("/certificate/trustworthy")) return warnings;
  for (const std::string& reason : record.texts("/certificate/reasons"))
    warnings.erase(std::remove(warnings.begin(), warnings.end(), reason), warnings.end());
  return warnings;
}

/// How many lines of the basis and of the warnings there is room for.
struct Room {
  std::size_t n_basis, n_warnings;
};

Room room_beside(std::size_t n_other_lines, std::size_t n_basis, std::size_t n_warnings) {
  constexpr std::size_t kMostLines = 20, kFewestBasis = 4, kKeptWarnings = 3;
  const std::size_t around_warnings = n_warnings > 0 ? 2 : 0;  // a blank line and their heading
  const std::size_t n_left = kMostLines - std::min(kMostLines, n_other_lines + around_warnings);
  Room room{};
  const std::size_t n_kept = std::min(n_warnings, kKeptWarnings);
  room.n_basis = std::min(n_basis, std::max(kFewestBasis, n_left - std::min(n_left, n_kept)));
  room.n_warnings = std::min(n_warnings, std::max<std::size_t>(1, n_left - std::min(n_left, room.n_basis)));
  return room;
}

void print_brief_causes(std::ostream& out, const Record& record) {
  constexpr std::size_t kLongest = 8;
  for (const Json& reading : record.at("/causes")) {
    out << "\nCauses of the difference, " << Record(reading).text("/reading") << '\n';
    std::vector<std::string> sentences = causes_in_words(Record(reading));
    sentences.pop_back();  // the check of their sum
    for (const std::string& sentence : sentences) print_wrapped(out, sentence, "  -", 4, kLongest);
  }
}

}  // namespace

void print_answer(std::ostream& out, const Json& json, const std::string& show) {
  const Record record(json);
  std::ostringstream head;
  print_brief_verdict(head, record);
  head << '\n';
  print_main_numbers(head, record);
  head << '\n';
  const std::string text = head.str();
  const Lines basis = basis_of(record);
  const std::vector<std::string> warnings = further_warnings(record);
  const auto n_head = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  const Room room = room_beside(n_head + 1, basis.size(), warnings.size());
  out << text;
  for (std::size_t i = 0; i < room.n_basis; ++i) print_wrapped(out, basis[i].second, basis[i].first, kBasisWidth, 1);
  print_brief_causes(out, record);
  const std::size_t n_notes = basis.size() - room.n_basis;
  if (!warnings.empty()) {
    out << "\nWarnings";
    if (room.n_warnings < warnings.size()) out << ", " << room.n_warnings << " of " << warnings.size();
    out << '\n';
  }
  for (std::size_t i = 0; i < room.n_warnings; ++i) print_wrapped(out, warnings[i], "  -", 4, 1);
  if (!show.empty())
    out << "Every number" << (n_notes > 0 ? ", and " + counted(n_notes, "more note") : "") << ": " << show << '\n';
}

void print_verdict_line(std::ostream& out, const CompareResult& result) {
  const Metric& metric =
      *find_metric_or_null(result.potential.compared ? "mean_abs_difference" : "mean_displacement_A");
  std::string label = metric.label;
  label[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(label[0])));
  out << verdict_of(result.certificate) << ": " << label << ' ' << formatted(metric, value_of(metric, result)) << ' '
      << unit_of(metric, to_string(result.potential.unit)) << '\n';
}

}  // namespace espdiff
