// residue_csv.cpp: writes the rows, and continues those of an interrupted run.
#include "trajectory/residue_csv.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "align/paired_residues.h"
#include "base/error.h"
#include "certificate/result.h"
#include "io/files/read_csv.h"
#include "io/files/write_csv.h"
#include "report/residue_values.h"

namespace espdiff {
namespace {

constexpr const char* kFrame = "frame";

constexpr const char* kFingerprint = "trajectory: ";

/// The quantity of the head's first line; empty for another file.
std::string quantity_of(const std::vector<std::string>& comments) {
  const std::string word = ResidueCsv::kHeadWord;
  const bool has_partners = comments.size() == 3 && comments[2].rfind(ResidueCsv::kPartners, 0) == 0;
  if ((comments.size() != 2 && !has_partners) || comments[0].rfind(word, 0) != 0) return {};
  const std::string rest = comments[0].substr(word.size());
  return rest.substr(0, rest.find(' '));
}

/// Whether a text is empty, or what a run that was killed before its first row left.
bool is_part_of_head(const std::string& text) {
  const std::string first = std::string("# ") + ResidueCsv::kHeadWord;
  if (text.size() < first.size()) return first.rfind(text, 0) == 0;
  const bool has_partners = text.find(std::string("\n# ") + ResidueCsv::kPartners) != std::string::npos;
  return text.rfind(first, 0) == 0 && std::count(text.begin(), text.end(), '\n') < (has_partners ? 4 : 3);
}

/// The names of the residues' partners under their columns; empty if the target's residues have the same names.
std::vector<std::string> partners_of(const std::vector<std::string>& columns, const Molecule& source,
                                     const Molecule& target, const CompareResult& result) {
  if (result.alignment.pairing.pairs.empty()) return {};
  const std::vector<std::int32_t> target_of = paired_residues(source, target, result.alignment.pairing);
  std::vector<std::string> partners{""};  // of the frame
  bool differ = false;
  for (const ResidueRow& row : result.residues) {
    const std::int32_t partner = target_of[row.residue];
    partners.push_back(partner < 0 ? "" : residue_column(target.residues[static_cast<std::size_t>(partner)]));
    differ = differ || partners.back() != columns[partners.size() - 1];
  }
  return differ ? partners : std::vector<std::string>();
}

}  // namespace

std::string residue_column(const Residue& residue) {
  std::string name = residue.name + " " + std::to_string(residue.number);
  if (residue.insertion_code != ' ') name += residue.insertion_code;
  return residue.chain.empty() ? name : residue.chain + ":" + name;
}

ResidueCsv::ResidueCsv(std::string path, std::string quantity, ExistingFile existing,
                       const std::vector<FieldRequest>& fields)
    : file_(std::move(path), existing), replaces_(existing == ExistingFile::kReplace), quantity_(std::move(quantity)) {
  if (!quantity_.empty()) require_residue_quantity(quantity_, fields);
}

void ResidueCsv::resume(const std::vector<std::string>& frames, const std::string& fingerprint) {
  if (replaces_) return;
  const Message anew = "; " + switched_on("overwrite") + " begins anew";
  const std::string text = file_.has_content() ? file_.text() : "", lines = complete_lines(text);
  if (is_part_of_head(text)) {
    if (frames.empty()) return;
    throw InputError(path() + ": has no rows, while the run has " + std::to_string(frames.size()) +
                     "; the residues of a run are written from its first frame on" + anew);
  }
  const CsvTable table = parse_csv(lines, path());
  const std::string quantity = quantity_of(table.comments);
  if (quantity.empty() || table.columns.front() != kFrame)
    throw FormatError(path(), 1, "this is not a trajectory's table of residues; give another file");
  // Rows are written before those of the trajectory: a killed run can have one more here.
  if (table.rows.size() > frames.size() + 1)
    throw InputError(path() + ": has " + std::to_string(table.rows.size()) + " rows, and the run " +
                     std::to_string(frames.size()) + anew);
  if (frames.empty()) return;  // one row, which is written again with its head
  if (quantity_.empty()) quantity_ = quantity;
  if (quantity != quantity_ || table.comments[1] != kFingerprint + fingerprint)
    throw InputError(path() + ": has " + quantity + " of another run, or " + quantity_ + " was asked for" + anew);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string there = i < table.rows.size() ? "frame " + table.rows[i][0] : "missing";
    if (there != "frame " + frames[i])
      throw InputError(path() + ": row " + std::to_string(i + 1) + " is " + there + ", not frame " + frames[i] + anew);
  }
  columns_ = table.columns;
  std::string kept = lines;
  if (table.rows.size() > frames.size()) kept.resize(kept.rfind('\n', kept.size() - 2) + 1);
  file_.truncate(kept.size());
}

ResidueLine ResidueCsv::row(int frame, const Molecule& source, const Molecule& target,
                            const CompareResult& result) const {
  ResidueLine row{
      quantity_.empty() ? usual_residue_quantity(result) : quantity_, "", {kFrame}, {std::to_string(frame)}, {}};
  row.unit = residue_unit(result, row.quantity);
  for (const ResidueRow& residue : result.residues)
    row.columns.push_back(residue_column(source.residues[residue.residue]));
  for (const double value : residue_values(result, row.quantity))
    row.cells.push_back(std::isfinite(value) ? nlohmann::json(value).dump() : std::string());
  if (!columns_.empty() && row.columns != columns_)
    throw InputError(path() +
                     ": this frame has other residues than the first: " + std::to_string(row.columns.size() - 1) +
                     " instead of " + std::to_string(columns_.size() - 1) + ", or other names");
  if (columns_.empty()) row.partners = partners_of(row.columns, source, target, result);
  return row;
}

void ResidueCsv::add(const ResidueLine& row, const std::string& fingerprint) {
  std::string text;
  if (columns_.empty()) {
    text = std::string("# ") + kHeadWord + row.quantity + (row.unit.empty() ? "" : " [" + row.unit + "]") + "\n# " +
           kFingerprint + fingerprint + "\n" +
           (row.partners.empty() ? std::string() : std::string("# ") + kPartners + csv_row(row.partners)) +
           csv_row(row.columns);
    file_.truncate(0);
    columns_ = row.columns;
    quantity_ = row.quantity;
  }
  file_.append(text + csv_row(row.cells));
}

}  // namespace espdiff
