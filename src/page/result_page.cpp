// result_page.cpp: chooses the page of a result by its files.
#include "page/result_page.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "page/ensemble_page.h"
#include "page/report_page.h"
#include "page/study_page.h"

namespace espdiff {

PageKind page_kind(const std::string& prefix) {
  std::error_code ignored;
  if (!std::filesystem::exists(prefix + ".json", ignored)) {
    if (std::filesystem::exists(prefix + ".csv", ignored)) return PageKind::kTrajectory;
    return PageKind::kPair;  // whose reader says what is missing
  }
  const nlohmann::ordered_json record = read_study_json(prefix + ".json");
  if (record.contains("variants") && record.at("variants").is_array()) return PageKind::kMatrix;
  if (record.contains("plan") && record.contains("noise_floor")) return PageKind::kEnsemble;
  return PageKind::kPair;
}

std::vector<std::string> page_inputs(const std::string& prefix) {
  switch (page_kind(prefix)) {
    case PageKind::kMatrix: return {prefix + ".json", prefix + ".csv"};
    case PageKind::kTrajectory: return {prefix + ".csv", prefix + ".residues.csv"};
    case PageKind::kEnsemble:
      return {prefix + ".json", prefix + ".vtp", prefix + ".residues.csv", prefix + ".patch_series.csv"};
    default: return {prefix + ".json", prefix + ".vtp", prefix + ".residues.csv"};
  }
}

std::string result_page(const std::string& prefix, const std::string& title, const std::vector<std::string>& range_of) {
  const PageKind kind = page_kind(prefix);
  if (!range_of.empty() && (kind == PageKind::kMatrix || kind == PageKind::kTrajectory))
    throw InputError(option("range-of") + " is for surfaces, and " + prefix + " is a matrix or a trajectory");
  switch (kind) {
    case PageKind::kMatrix: return matrix_page(prefix, title);
    case PageKind::kTrajectory: return trajectory_page(prefix, title);
    case PageKind::kEnsemble: return ensemble_page(prefix, title, range_of);
    default: return report_page(prefix, title, range_of);
  }
}

}  // namespace espdiff
