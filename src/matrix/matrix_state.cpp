// matrix_state.cpp: lines with a running checksum, one write each.
#include "matrix/matrix_state.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text/system_message.h"
#include "io/files/atomic_file.h"
#include "io/files/read_input.h"
#include "io/files/sha256.h"
#include "io/text/json_integer.h"
#include "io/text/json_values.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kTag = "espdiff matrix state 1\n";
constexpr std::size_t kSumDigits = 32;

/// The checksum of a line that follows lines with the checksum `before`.
std::string sum_of(const std::string& before, const std::string& json) {
  return sha256_of(before + json).substr(0, kSumDigits);
}

std::string line_of(const std::string& sum, const std::string& json) { return sum + ' ' + json + '\n'; }

std::string cell_json(const MatrixCell& cell, const PartsAndFields& compared) {
  Json values = Json::object();
  const std::vector<Metric>& metrics = matrix_metrics(compared);
  const std::vector<std::string>& parts = compared.parts;
  for (std::size_t m = 0; m < cell.values.size(); ++m)
    values[metrics[m].name] = std::isfinite(cell.values[m]) ? Json(cell.values[m]) : Json(nullptr);
  Json json = {{"source", cell.source},       {"target", cell.target},           {"values", std::move(values)},
               {"converged", cell.converged}, {"trustworthy", cell.trustworthy}, {"reasons", cell.reasons},
               {"error", cell.error}};
  if (!cell.warnings.empty()) json["warnings"] = cell.warnings;
  for (std::size_t k = 0; k < parts.size(); ++k) json[trustworthy_column(parts[k])] = cell.parts_trustworthy.at(k) != 0;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

MatrixCell parse_cell(const std::string& text, const MatrixPlan& plan) {
  const std::size_t n_variants = plan.variants.size();
  const Json json = Json::parse(text);
  MatrixCell cell;
  cell.source = integer_of<std::size_t>(json.at("source"));
  cell.target = integer_of<std::size_t>(json.at("target"));
  if (cell.source >= n_variants || cell.target >= n_variants || cell.source == cell.target)
    throw std::out_of_range("pair");
  for (const Metric& metric : matrix_metrics(plan.compared())) {
    const Json& value = json.at("values").at(metric.name);
    cell.values.push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>());
  }
  json.at("converged").get_to(cell.converged);
  json.at("trustworthy").get_to(cell.trustworthy);
  for (const std::string& part : plan.parts())
    cell.parts_trustworthy.push_back(json.at(trustworthy_column(part)).get<bool>() ? 1 : 0);
  json.at("reasons").get_to(cell.reasons);
  json.at("error").get_to(cell.error);
  if (json.contains("warnings")) json.at("warnings").get_to(cell.warnings);
  return cell;
}

/// Reads checked lines from the front of a file.
class LineReader {
 public:
  LineReader(const std::string& path, const std::string& bytes) : path_(path), bytes_(bytes) {}

  /// @returns false if no complete line remains
  bool next(std::string& json) {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string::npos) return false;
    ++line_;
    const std::string line = bytes_.substr(at_, end - at_);
    if (line.size() < kSumDigits + 2 || line[kSumDigits] != ' ') damaged();
    json = line.substr(kSumDigits + 1);
    sum_ = sum_of(sum_, json);
    if (line.compare(0, kSumDigits, sum_) != 0) damaged();
    at_ = end + 1;
    return true;
  }
  [[noreturn]] void damaged() const {
    throw FormatError(path_, line_,
                      "the state file is damaged from this line on; delete it and run anew (" +
                          switched_on("overwrite") + "), or remove this line and all after it and resume");
  }
  void skip_tag() {
    at_ = std::strlen(kTag);
    line_ = 1;
  }
  std::size_t position() const { return at_; }

 private:
  const std::string& path_;
  const std::string& bytes_;
  std::size_t at_ = 0;
  long line_ = 0;
  std::string sum_;
};

std::string read_all(const std::string& path) {
  require_regular_file(path);
  require_memory_for_json(path);
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(path, "the state file cannot be read");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// The checksum at the end of complete lines; `n_bytes` of them.
std::string last_sum(const std::string& bytes, std::size_t n_bytes) {
  const std::size_t start = bytes.rfind('\n', n_bytes - 2) + 1;
  return bytes.substr(start, kSumDigits);
}

}  // namespace

MatrixStateContent read_matrix_state(const std::string& path) {
  const std::string bytes = read_all(path);
  if (bytes.compare(0, std::strlen(kTag), kTag) != 0)
    throw FormatError(path, 1,
                      "this is no state file of a matrix of this version; give another file, or begin anew (" +
                          switched_on("overwrite") + ")");
  LineReader reader(path, bytes);
  reader.skip_tag();
  MatrixStateContent content;
  std::string json;
  if (!reader.next(json))
    throw FormatError(path, 2,
                      "the state file is cut off before its first row; run anew (" + switched_on("overwrite") + ")");
  try {
    content.plan = parse_plan(json);
    while (reader.next(json)) content.cells.push_back(parse_cell(json, content.plan));
  } catch (const nlohmann::json::exception&) {
    reader.damaged();
  } catch (const std::out_of_range&) {
    reader.damaged();
  } catch (const InputError&) {  // a patch in its settings
    reader.damaged();
  }
  content.n_good_bytes = reader.position();
  content.cut_off = content.n_good_bytes < bytes.size();
  return content;
}

MatrixState::MatrixState(std::string path, std::string sum)
    : path_(std::move(path)), sum_(std::move(sum)), file_(path_, FileAccess::kAppend) {
  if (!file_) throw IoError(path_, std::string("the state file cannot be written: ") + system_message(file_.error()));
  if (file_.lock() == LockResult::kBusy)
    throw IoError(path_, "another process is writing this state file; wait for it, or name another output");
}

MatrixState MatrixState::begin(const std::string& path, const MatrixPlan& plan) {
  // JSON must be UTF-8, a path need not be.
  const std::string json = plan_json(plan).dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string sum = sum_of("", json);
  if (std::ifstream(path)) MatrixState(path, "");  // refused while another process writes it
  AtomicFile file(path);
  file.stream() << kTag << line_of(sum, json);
  file.commit();
  MatrixState state(path, sum);
  state.compared_ = plan.compared();
  return state;
}

MatrixState MatrixState::go_on(const std::string& path, const MatrixPlan& plan, MatrixStateContent& content) {
  // Locked before reading: a row that another process is writing would look truncated.
  MatrixState state(path, "");
  content = read_matrix_state(path);
  const std::string difference = plan_difference(content.plan, plan);
  if (!difference.empty())
    throw InputError(path + ": this state file is of another run: " + difference +
                     "; run with the same input and settings to continue, or anew (" + switched_on("overwrite") + ")");
  std::error_code error;
  if (content.cut_off) std::filesystem::resize_file(path, content.n_good_bytes, error);
  if (error) throw IoError(path, "the incomplete last row cannot be taken away: " + system_message(error.value()));
  state.compared_ = plan.compared();
  state.sum_ = last_sum(read_all(path), content.n_good_bytes);
  return state;
}

void MatrixState::add(const MatrixCell& cell) {
  const std::string json = cell_json(cell, compared_);
  sum_ = sum_of(sum_, json);
  const std::string line = line_of(sum_, json);
  const int error = file_.write(line.data(), line.size());
  if (error != 0)
    throw IoError(path_, std::string("a row cannot be written: ") + system_message(error) +
                             "; what is done is kept, and " + switched_on("resume") + " continues");
}

}  // namespace espdiff
