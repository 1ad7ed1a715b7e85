// planted_pairing.cpp: errors of correspondence planted into crystal copies of one protein, and what the checks of the
// inputs say of them and of the copies as they are; the table of bench/study_notes.md.
#include "input_checks/planted_pairing.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/molecule/structure_options.h"
#include "io/structures/structure_file.h"

namespace {

using namespace espdiff_test;

struct Tally {
  int cases = 0, refused = 0, right = 0;
};

void judge(const std::string& label, const PlacedError& error, std::map<std::string, Tally>& tallies, double& seconds) {
  espdiff::Alignment result;
  const std::vector<std::string> warnings = warnings_of(error, result, &seconds);
  const bool right = is_judged_rightly(error, result, warnings);
  Tally& tally = tallies[error.kind];
  ++tally.cases;
  tally.right += right ? 1 : 0;
  tally.refused += std::any_of(warnings.begin(), warnings.end(), [](const auto& text) { return text[0] == '*'; });
  if (right) return;
  std::printf("- %s, %s (RMSD %.2f A):", error.kind.c_str(), label.c_str(), result.rmsd_A);
  for (const std::string& text : warnings) std::printf(" %s;", text.c_str());
  std::printf("\n");
}

/// Files of one entry are copies of one protein: the name up to `_`.
std::map<std::string, std::vector<std::string>> copies_in(const std::string& folder) {
  std::map<std::string, std::vector<std::string>> entries;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const std::string name = file.path().filename().string();
    if (name.find(".pdb") != std::string::npos) entries[name.substr(0, name.find('_'))].push_back(file.path().string());
  }
  for (auto& [name, files] : entries) std::sort(files.begin(), files.end());
  return entries;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr,
                 "usage: planted_pairing FOLDER [MOST ENTRIES]\n"
                 "FOLDER has files such as 1i10_A.pdb.gz and 1i10_B.pdb.gz: copies of one protein in a crystal\n");
    return 2;
  }
  const std::size_t most = argc > 2 ? static_cast<std::size_t>(std::atoi(argv[2])) : 25;
  const std::string easy = "copies as they are, both ways";
  std::map<std::string, Tally> tallies;
  double planted_seconds = 0, easy_seconds = 0;
  std::size_t n_entries = 0;
  for (const auto& [entry, files] : copies_in(argv[1])) {
    if (files.size() < 2) continue;
    std::vector<espdiff::Molecule> copies;
    for (const std::string& file : files) copies.push_back(espdiff::read_structure(file, espdiff::StructureOptions{}));
    for (std::size_t k = 1; k < copies.size(); ++k) {
      judge(files[k], {easy, "", {copies[0], copies[k]}}, tallies, easy_seconds);
      judge(files[k], {easy, "", {copies[k], copies[0]}}, tallies, easy_seconds);
    }
    if (++n_entries > most) continue;
    for (const PlacedError& error : pairing_errors(copies[0], copies[1], n_entries))
      judge(entry, error, tallies, planted_seconds);
  }
  std::printf("\n| kind | cases | judged rightly | refused |\n|---|---|---|---|\n");
  for (const auto& [kind, tally] : tallies)
    std::printf("| %s | %d | %d | %d |\n", kind.c_str(), tally.cases, tally.right, tally.refused);
  if (tallies[easy].cases > 0)
    std::printf("\nThe checks of a pair of copies take %.1f ms.\n", 1000 * easy_seconds / tallies[easy].cases);
  return 0;
}
