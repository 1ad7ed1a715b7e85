// read_matrix.cpp: reads and checks a matrix's OUT.json.
#include "matrix/read_matrix.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/files/read_input.h"
#include "io/text/json_integer.h"
#include "io/text/json_values.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

/// The entries of [source][target], row by row.
template <typename Value>
std::vector<Value> table(const Json& rows, std::size_t n, Value otherwise) {
  std::vector<Value> values;
  if (rows.size() != n) throw std::out_of_range("rows");
  for (const Json& row : rows) {
    if (row.size() != n) throw std::out_of_range("columns");
    for (const Json& entry : row) values.push_back(entry.is_null() ? otherwise : entry.get<Value>());
  }
  return values;
}

MatrixFile parse(const std::string& text) {
  const Json json = Json::parse(text);
  MatrixFile file;
  for (const Json& variant : json.at("variants")) {
    file.labels.push_back(variant.at("label"));
    file.groups.push_back(variant.at("group"));
  }
  const std::size_t n = file.n();
  if (n < 2) throw std::out_of_range("variants");
  for (const auto& [name, metric] : json.at("metrics").items()) {
    file.metrics.push_back({name, metric.at("title"), metric.at("unit"),
                            table(metric.at("values"), n, std::numeric_limits<double>::quiet_NaN())});
  }
  file.trustworthy = table(json.at("trustworthy"), n, false);
  const Json& clustering = json.at("clustering");
  clustering.at("metric").get_to(file.clustered_by);
  for (const Json& merge : clustering.at("merges")) {
    const Json& distance = merge.at(2);
    file.merges.push_back({integer_of<std::size_t>(merge.at(0)), integer_of<std::size_t>(merge.at(1)),
                           distance.is_null() ? std::numeric_limits<double>::quiet_NaN() : distance.get<double>(),
                           integer_of<std::size_t>(merge.at(3))});
    if (std::max(file.merges.back().left, file.merges.back().right) >= n + file.merges.size() - 1)
      throw std::out_of_range("merge");
  }
  if (file.merges.size() != n - 1) throw std::out_of_range("merges");
  return file;
}

}  // namespace

const MatrixFileMetric& MatrixFile::metric(const std::string& name) const {
  std::string list;
  for (const MatrixFileMetric& metric : metrics) {
    if (metric.name == name) return metric;
    list += (list.empty() ? "" : ", ") + metric.name;
  }
  throw InputError("there is no metric '" + name + "'; there are: " + list);
}

std::size_t MatrixFile::find(const std::string& label) const {
  const auto found = std::find(labels.begin(), labels.end(), label);
  if (found != labels.end()) return static_cast<std::size_t>(found - labels.begin());
  std::string list;
  for (const std::string& name : labels) list += (list.empty() ? "" : ", ") + name;
  throw InputError("there is no variant '" + label + "'; there are: " + list);
}

MatrixFile read_matrix_json(const std::string& path) {
  const std::string text = read_text_file(path);
  require_memory_for_json(text, path);
  try {
    return parse(text);
  } catch (const nlohmann::json::exception&) {
  } catch (const std::out_of_range&) {
  }
  throw FormatError(path, 0, "this is not the JSON that `espdiff matrix` writes; give its OUT.json, or a CSV file");
}

}  // namespace espdiff
