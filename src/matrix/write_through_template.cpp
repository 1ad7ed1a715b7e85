// write_through_template.cpp: the template of a matrix as JSON and as a table.
#include "matrix/write_through_template.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/formatted.h"
#include "report/compare_json.h"
#include "report/sections/json_number.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

Json state_json(const std::string& label, const TemplateState& state) {
  Json json = {{"label", label}};
  if (!state.error.empty()) {
    json["error"] = state.error;
    return json;
  }
  json["rmsd_A"] = json_number(state.rmsd_A);
  json["no_counterpart_area_fraction"] = {{"template", json_number(state.unmatched_template)},
                                          {"state", json_number(state.unmatched_state)}};
  json["mapped_to_state_mean_within_limit_A"] = json_number(state.distance_A);
  json["same_residue_area_fraction"] = json_number(state.same_residue_area_fraction);
  json["trustworthy"] = state.trustworthy;
  if (!state.trustworthy) json["reason"] = state.reason;
  return json;
}

Json pair_json(const Matrix& matrix, const MatrixCell& cell) {
  Json json = {{"source", matrix.plan.variants[cell.source].label},
               {"target", matrix.plan.variants[cell.target].label},
               {"trustworthy", cell.error.empty() ? Json(cell.trustworthy) : Json(nullptr)}};
  if (!cell.error.empty()) json["error"] = cell.error;
  for (std::size_t m = 0; m < cell.values.size(); ++m) {
    if (matrix.gives(m)) json["metrics"][matrix.metrics()[m].name] = json_number(cell.values[m]);
  }
  return json;
}

Json exact_json(const Matrix& matrix) {
  Json json = {{"pairs", Json::array()}, {"agreement", Json::object()}};
  for (const MatrixCell& cell : matrix.through->exact) json["pairs"].push_back(pair_json(matrix, cell));
  for (const TemplateAgreement& of : agreement(matrix)) {
    json["agreement"][matrix.metrics()[of.metric].name] = {
        {"n", of.n},
        {"exact_mean", of.exact_mean},
        {"template_mean", of.template_mean},
        {"mean_difference", of.mean_difference},
        {"largest_difference", of.largest_difference},
        {"pair", {matrix.plan.variants[of.farthest.first].label, matrix.plan.variants[of.farthest.second].label}},
        {"correlation", json_number(of.correlation)}};
  }
  return json;
}

void print_agreement(std::ostream& out, const Matrix& matrix) {
  const std::vector<MatrixCell>& exact = matrix.through->exact;
  if (exact.empty()) {
    out << "\nNo pair was compared by itself: how far these values are from exact ones was not measured\n";
    return;
  }
  std::size_t n_trustworthy = 0, n_through = 0, n_both = 0;
  for (const MatrixCell& cell : exact) {
    const bool by_itself = cell.trustworthy, through = matrix.cell(cell.source, cell.target).trustworthy;
    n_trustworthy += by_itself ? 1 : 0;
    n_through += through ? 1 : 0;
    n_both += by_itself && through ? 1 : 0;
  }
  const bool are_all = exact.size() == matrix.n() * (matrix.n() - 1);
  out << formatted("\n%-43s%8s%10s%12s%10s%9s  of\n",
                   formatted("%zu pair%s by %s%s", exact.size(), exact.size() == 1 ? "" : "s",
                             exact.size() == 1 ? "itself" : "themselves", are_all ? "" : ", chosen at random")
                       .c_str(),
                   "exact", "template", "mean diff.", "largest", "correl.");
  for (const TemplateAgreement& of : agreement(matrix)) {
    const Metric& metric = matrix.metrics()[of.metric];
    out << formatted("  %-40.40s %8.3g %9.3g%12.3g%10.3g%9s  %s to %s\n", metric.label, of.exact_mean, of.template_mean,
                     of.mean_difference, of.largest_difference,
                     std::isnan(of.correlation) ? "-" : formatted("%.3f", of.correlation).c_str(),
                     matrix.plan.variants[of.farthest.first].label.c_str(),
                     matrix.plan.variants[of.farthest.second].label.c_str());
  }
  out << "  trustworthy: " << n_trustworthy << " of them, " << n_through << " through the template, " << n_both
      << " both\n";
}

void print_doubtful(std::ostream& out, const Matrix& matrix) {
  constexpr std::size_t kMostShown = 10;
  std::size_t n = 0;
  for (std::size_t i = 0; i < matrix.n(); ++i) {
    const TemplateState& state = matrix.through->states[i];
    if (state.trustworthy) continue;
    if (n == 0)
      out << "\nThe template's mapping is not trustworthy onto these states; their rows and columns are marked\n";
    if (++n <= kMostShown)
      out << formatted("  %-20.60s %.200s\n", matrix.plan.variants[i].label.c_str(),
                       (state.error.empty() ? state.reason : state.error).c_str());
  }
  if (n > kMostShown) out << "  and " << n - kMostShown << " more, which are in the files\n";
}

void print_absent(std::ostream& out, const Matrix& matrix) {
  std::string line = "\nA template does not give:", text;
  for (std::size_t m = 0; m < matrix.metrics().size(); ++m) {
    const Metric& metric = matrix.metrics()[m];
    const bool is_shown = metric.section != MetricSection::kCertificate && metric.section != MetricSection::kMapping;
    if (matrix.gives(m) || !is_shown) continue;
    line += (text.empty() ? " " : ", ") + std::string(metric.label);
    text = "said";
  }
  if (!text.empty())
    out << line
        << "; nor are round trips and the residues' own\npotentials "
           "checked. `espdiff compare` of a pair tells them\n";
}

}  // namespace

Json through_template_json(const Matrix& matrix) {
  const ThroughTemplate& through = *matrix.through;
  Json json = {
      {"name", through.name},
      {"sha256", through.sha256},
      {"n_vertices", through.n_vertices},
      {"area_A2", through.area_A2},
      {"options", options_json(through.settings)},
      {"compared_area_fraction",
       {{"mean", json_number(through.mean_area_fraction)}, {"least", json_number(through.least_area_fraction)}}}};
  json["states"] = Json::array();
  for (std::size_t i = 0; i < matrix.n(); ++i)
    json["states"].push_back(state_json(matrix.plan.variants[i].label, through.states[i]));
  json["absent"] = Json::array();
  for (std::size_t m = 0; m < matrix.metrics().size(); ++m) {
    if (!matrix.gives(m)) json["absent"].push_back(matrix.metrics()[m].name);
  }
  json["not_checked"] = {"residues", "round_trip"};
  json["exact"] = exact_json(matrix);
  return json;
}

void print_through_template(std::ostream& out, const Matrix& matrix) {
  print_agreement(out, matrix);
  print_doubtful(out, matrix);
  print_absent(out, matrix);
}

}  // namespace espdiff
