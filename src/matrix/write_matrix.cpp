// write_matrix.cpp: OUT.csv and OUT.json of a matrix.
#include "matrix/write_matrix.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/text/formats.h"
#include "io/files/atomic_file.h"
#include "io/files/write_csv.h"
#include "matrix/write_through_template.h"
#include "report/compare_json.h"
#include "report/sections/json_number.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

std::string dumped(const Json& json) {
  // A path need not be UTF-8, JSON must be.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// One line for each entry, and for each row of a metric's numbers, for readability.
void write_lines(std::ostream& out, const Json& json, const std::string& indent) {
  out << "{";
  for (const auto& [key, value] : json.items()) {
    out << (key == json.begin().key() ? "\n" : ",\n") << indent << dumped(key) << ": ";
    if (key == "metrics") {
      write_lines(out, value, indent + "  ");
    } else {
      out << dumped(value);
    }
  }
  out << '\n' << indent.substr(2) << '}';
}

/// [source][target], null on the diagonal.
template <typename Of>
Json table(const Matrix& matrix, Of of) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < matrix.n(); ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < matrix.n(); ++j) row.push_back(i == j ? Json(nullptr) : Json(of(matrix.cell(i, j))));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json pair_of(const Matrix& matrix, const MatrixCell& cell) {
  return {{"source", matrix.plan.variants[cell.source].label}, {"target", matrix.plan.variants[cell.target].label}};
}

Json metric_json(const Matrix& matrix, std::size_t m) {
  const Metric& metric = matrix.metrics()[m];
  return {{"title", metric.label},
          {"unit", unit_of(metric, matrix.plan.potential_unit)},
          {"values", table(matrix, [m](const MatrixCell& cell) { return json_number(cell.values[m]); })}};
}

Json asymmetry_json(const Matrix& matrix) {
  Json json = Json::object();
  for (std::size_t m = 0; m < matrix.metrics().size(); ++m) {
    if (!matrix.gives(m)) continue;
    const Asymmetry a = asymmetry(matrix, m);
    json[matrix.metrics()[m].name] = {
        {"mean", json_number(a.mean)},
        {"max", json_number(a.max)},
        {"pair", {matrix.plan.variants[a.first].label, matrix.plan.variants[a.second].label}}};
  }
  return json;
}

Json groups_json(const Matrix& matrix) {
  Json json = Json::object();
  for (std::size_t m = 0; m < matrix.metrics().size(); ++m) {
    if (!matrix.gives(m)) continue;
    Json means = Json::array();
    for (const GroupMean& g : group_means(matrix, m)) {
      means.push_back({{"source", g.source},
                       {"target", g.target},
                       {"n", g.n},
                       {"n_trustworthy", g.n_trustworthy},
                       {"mean", json_number(g.mean)},
                       {"min", json_number(g.min)},
                       {"max", json_number(g.max)}});
    }
    if (!means.empty()) json[matrix.metrics()[m].name] = std::move(means);
  }
  return json;
}

Json clustering_json(const Matrix& matrix, const Clustering& clustering) {
  Json merges = Json::array(), order = Json::array();
  for (const ClusterMerge& merge : clustering.merges)
    merges.push_back({merge.left, merge.right, json_number(merge.distance), merge.n_variants});
  for (const std::size_t i : clustering.order) order.push_back(matrix.plan.variants[i].label);
  return {{"metric", matrix.metrics()[clustering.metric].name},
          {"linkage", "average"},
          {"merges", std::move(merges)},
          {"order", std::move(order)}};
}

/// The distances of all pairs, each once.
std::vector<double> upper_triangle(const DistanceTable& distances, std::size_t n) {
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) values.push_back(distances[i * n + j]);
  }
  return values;
}

Json hodgkin_json(const Matrix& matrix, std::size_t metric) {
  if (matrix.plan.potential.empty()) return nullptr;
  const std::size_t hodgkin = find_metric("hodgkin_index");
  const std::vector<double> a = upper_triangle(symmetric_distances(matrix, metric), matrix.n());
  const std::vector<double> b = upper_triangle(symmetric_distances(matrix, hodgkin), matrix.n());
  return {{"distance", "sqrt(2 - 2 H)"},
          {"correlation", json_number(correlation(a, b))},
          {"rank_correlation", json_number(rank_correlation(a, b))},
          {"clustering", clustering_json(matrix, cluster(matrix, hodgkin))}};
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : "; ") + word;
  return text;
}

void write_table(std::ostream& out, const Matrix& matrix) {
  std::vector<std::string> names = {"source", "target", "source_group", "target_group", "potential_unit"};
  for (const Metric& metric : matrix.metrics()) names.emplace_back(metric.name);
  names.insert(names.end(), {"converged", "trustworthy"});
  for (const std::string& part : matrix.plan.parts()) names.push_back(trustworthy_column(part));
  names.insert(names.end(), {"reasons", "warnings", "error"});
  write_csv_row(out, names);
  for (const MatrixCell& cell : matrix.cells) {
    const MatrixPlan::Item &source = matrix.plan.variants[cell.source], &target = matrix.plan.variants[cell.target];
    std::vector<std::string> fields = {source.label, target.label, source.group, target.group,
                                       matrix.plan.potential_unit};
    for (const double value : cell.values) fields.push_back(csv_number(value));
    const bool has_values = cell.error.empty();
    const auto known = [&](bool value) { return has_values ? std::to_string(static_cast<int>(value)) : std::string(); };
    fields.insert(fields.end(), {known(cell.converged), known(cell.trustworthy)});
    for (const std::uint8_t part : cell.parts_trustworthy) fields.push_back(known(part != 0));
    fields.insert(fields.end(), {joined(cell.reasons), joined(cell.warnings), cell.error});
    write_csv_row(out, fields);
  }
}

}  // namespace

Json matrix_json(const Matrix& matrix, std::size_t metric) {
  Json json{{"format", kMatrixFormat}, {"format_version", kFormatVersion}};
  const Json plan = plan_json(matrix.plan);
  for (const char* key : {"version", "device", "potential", "potential_unit", "radii_note"}) json[key] = plan[key];
  json["options"] = options_json(matrix.plan.settings);
  json["variants"] = plan["variants"];
  if (plan.contains("fields")) json["fields"] = plan["fields"];
  if (matrix.through) json["template"] = through_template_json(matrix);
  for (std::size_t m = 0; m < matrix.metrics().size(); ++m) {
    if (matrix.gives(m)) json["metrics"][matrix.metrics()[m].name] = metric_json(matrix, m);
  }
  const auto known = [](const MatrixCell& cell, bool value) {
    return cell.error.empty() ? Json(value) : Json(nullptr);
  };
  json["trustworthy"] = table(matrix, [&](const MatrixCell& cell) { return known(cell, cell.trustworthy); });
  const std::vector<std::string> parts = matrix.plan.parts();
  for (std::size_t k = 0; k < parts.size(); ++k)
    json[trustworthy_column(parts[k])] =
        table(matrix, [&](const MatrixCell& cell) { return known(cell, cell.parts_trustworthy.at(k) != 0); });
  json["converged"] = table(matrix, [&](const MatrixCell& cell) { return known(cell, cell.converged); });
  json["not_trustworthy"] = Json::array();
  json["errors"] = Json::array();
  for (const MatrixCell& cell : matrix.cells) {
    Json pair = pair_of(matrix, cell);
    if (!cell.error.empty()) {
      pair["error"] = cell.error;
      json["errors"].push_back(std::move(pair));
    } else if (!cell.trustworthy) {
      pair["reasons"] = cell.reasons;
      json["not_trustworthy"].push_back(std::move(pair));
    }
  }
  json["asymmetry"] = asymmetry_json(matrix);
  Json groups = groups_json(matrix);
  if (!groups.empty()) json["groups"] = std::move(groups);
  json["clustering"] = clustering_json(matrix, cluster(matrix, metric));
  json["hodgkin"] = hodgkin_json(matrix, metric);
  return json;
}

std::vector<std::string> write_matrix(const std::string& output_prefix, const Matrix& matrix, std::size_t metric) {
  AtomicFile csv(output_prefix + ".csv"), json(output_prefix + ".json");
  write_table(csv.stream(), matrix);
  write_lines(json.stream(), matrix_json(matrix, metric), "  ");
  json.stream() << '\n';
  commit_all({&csv, &json});
  return {csv.path(), json.path()};
}

}  // namespace espdiff
