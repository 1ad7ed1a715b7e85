// causes_report.cpp: what the sentence on the causes of a reading names.
#include "report/sections/causes_report.h"

#include <doctest/doctest.h>

#include "causes/causes.h"

using espdiff::CauseKind;

TEST_CASE("substitutions are named, however little they make; other kinds by size") {
  espdiff::Causes causes;
  espdiff::CausesOfReading reading;
  reading.name = "region";
  const CauseKind kinds[] = {CauseKind::kSideChain,   CauseKind::kBackbone, CauseKind::kUnpaired,
                             CauseKind::kProtonation, CauseKind::kMoved,    CauseKind::kTerminus,
                             CauseKind::kSubstituted};
  double size = 0.7;
  for (const CauseKind kind : kinds) {
    espdiff::ResidueChange change;
    change.kind = kind;
    change.residue = {"LEU", "A", static_cast<std::int32_t>(causes.changes.size() + 1), ' '};
    reading.contributions.push_back({causes.changes.size(), 0, size, 5});
    causes.changes.push_back(change);
    reading.target += size;
    size -= 0.1;
  }
  const auto text = [&] { return espdiff::causes_in_words(causes, reading, "kT/e"); };
  CHECK_MESSAGE(text().find("from 1 substituted residue") != std::string::npos, text());
  CHECK_MESSAGE(text().find("from the other 1 residue") != std::string::npos, text());  // the end of a chain
  reading.contributions.back().target = 0;
  CHECK_MESSAGE(text().find("from 1 substituted residue") != std::string::npos, text());
}
