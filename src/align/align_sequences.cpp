// align_sequences.cpp: dynamic programming over two sequences.
#include "align/align_sequences.h"

#include <algorithm>
#include <limits>
#include <string_view>

#include "align/residue_names.h"

namespace espdiff {
namespace {

constexpr int kGapOpen = 11, kGapExtend = 1, kEndGap = 5;
constexpr ResidueCode kFirstNucleotide = 20, kEndOfNucleotides = 25, kFirstOther = 32;
constexpr std::string_view kAminoAcids = "ARNDCQEGHILKMFPSTWYV", kNucleotides = "acgtu";

/// Lower triangle of BLOSUM62, rows and columns in the order of kAminoAcids.
constexpr signed char kBlosum62[] = {4,                                                                          // A
                                     -1, 5,                                                                      // R
                                     -2, 0,  6,                                                                  // N
                                     -2, -2, 1,  6,                                                              // D
                                     0,  -3, -3, -3, 9,                                                          // C
                                     -1, 1,  0,  0,  -3, 5,                                                      // Q
                                     -1, 0,  0,  2,  -4, 2,  5,                                                  // E
                                     0,  -2, 0,  -1, -3, -2, -2, 6,                                              // G
                                     -2, 0,  1,  -1, -3, 0,  0,  -2, 8,                                          // H
                                     -1, -3, -3, -3, -1, -3, -3, -4, -3, 4,                                      // I
                                     -1, -2, -3, -4, -1, -2, -3, -4, -3, 2,  4,                                  // L
                                     -1, 2,  0,  -1, -3, 1,  1,  -2, -1, -3, -2, 5,                              // K
                                     -1, -1, -2, -3, -1, 0,  -2, -3, -2, 1,  2,  -1, 5,                          // M
                                     -2, -3, -3, -3, -2, -3, -3, -3, -1, 0,  0,  -3, 0,  6,                      // F
                                     -1, -2, -2, -1, -3, -1, -1, -2, -2, -3, -3, -1, -2, -4, 7,                  // P
                                     1,  -1, 1,  0,  -1, 0,  0,  0,  -1, -2, -2, 0,  -1, -2, -1, 4,              // S
                                     0,  -1, 0,  -1, -1, -1, -1, -2, -2, -1, -1, -1, -1, -2, -1, 1,  5,          // T
                                     -3, -3, -4, -4, -2, -2, -3, -2, -2, -3, -2, -3, -1, 1,  -4, -3, -2, 11,     // W
                                     -2, -2, -2, -3, -2, -1, -2, -3, 2,  -1, -1, -2, -1, 3,  -3, -2, -2, 2,  7,  // Y
                                     0,  -3, -3, -3, -1, -2, -2, -3, -3, 3,  1,  -2, 1,  -1, -2, -2, 0,  -3, -1,
                                     4};  // V
static_assert(sizeof kBlosum62 == 20 * 21 / 2, "one entry for each pair of amino acids");

/// How the best alignment reaches a cell.
enum Step : unsigned char {
  kPair = 0,
  kGapInB = 1,
  kGapInA = 2,
  kStepMask = 3,
  kExtendsGapInB = 4,
  kExtendsGapInA = 8
};

/// Fills the table row by row and keeps two rows. Scores are doubled, so that equal numbers can add one half.
class AlignmentTable {
 public:
  AlignmentTable(const Sequence& a, const Sequence& b) : a_(a), b_(b) {}

  void use_numbers(const std::vector<std::int32_t>& numbers_a, const std::vector<std::int32_t>& numbers_b) {
    numbers_a_ = numbers_a.data();
    numbers_b_ = numbers_b.data();
    steps_.resize((a_.size() + 1) * (b_.size() + 1), kPair);
  }

  /// Doubled score of the best alignment.
  int fill() {
    const std::size_t m = b_.size();
    row_.assign(m + 1, -2 * kEndGap);  // a gap before all of a
    row_[0] = 0;
    gap_in_b_.assign(m + 1, kMinusInfinity);
    best_ = kMinusInfinity;
    consider_end(0, m);
    for (std::size_t i = 1; i <= a_.size(); ++i) {
      fill_row(i);
      consider_end(i, m);
    }
    for (std::size_t j = 0; j <= m; ++j) consider_end(a_.size(), j);
    return best_;
  }

  std::vector<std::pair<std::size_t, std::size_t>> trace_back() const {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    std::size_t i = best_i_, j = best_j_;
    while (i > 0 && j > 0) {
      const int step = steps_[i * (b_.size() + 1) + j] & kStepMask;
      if (step == kPair) {
        pairs.emplace_back(--i, --j);
      } else {
        const std::size_t length = gap_length(i, j, step);
        (step == kGapInB ? i : j) -= length;
      }
    }
    std::reverse(pairs.begin(), pairs.end());
    return pairs;
  }

 private:
  static constexpr int kMinusInfinity = std::numeric_limits<int>::min() / 2;

  void fill_row(std::size_t i) {
    int diagonal = row_[0], gap_in_a = kMinusInfinity;
    row_[0] = -2 * kEndGap;
    for (std::size_t j = 1; j <= b_.size(); ++j) {
      unsigned char step = kPair;
      const int opened_in_b = row_[j] - 2 * (kGapOpen + kGapExtend), extended_in_b = gap_in_b_[j] - 2 * kGapExtend;
      const int opened_in_a = row_[j - 1] - 2 * (kGapOpen + kGapExtend), extended_in_a = gap_in_a - 2 * kGapExtend;
      if (extended_in_b > opened_in_b) step |= kExtendsGapInB;
      if (extended_in_a > opened_in_a) step |= kExtendsGapInA;
      gap_in_b_[j] = std::max(opened_in_b, extended_in_b);
      gap_in_a = std::max(opened_in_a, extended_in_a);
      int score = diagonal + pair_score(i - 1, j - 1);
      if (gap_in_b_[j] > score) {
        score = gap_in_b_[j];
        step = static_cast<unsigned char>(step | kGapInB);
      }
      if (gap_in_a > score) {
        score = gap_in_a;
        step = static_cast<unsigned char>((step & ~kStepMask) | kGapInA);
      }
      diagonal = row_[j];
      row_[j] = score;
      if (!steps_.empty()) steps_[i * (b_.size() + 1) + j] = step;
    }
  }

  int pair_score(std::size_t i, std::size_t j) const {
    const int same_number = numbers_a_ != nullptr && numbers_a_[i] == numbers_b_[j] ? 1 : 0;
    return 2 * substitution_score(a_[i], b_[j]) + same_number;
  }

  /// An alignment may end in the last row or column; the rest of the other sequence is an end gap.
  void consider_end(std::size_t i, std::size_t j) {
    const int score = row_[j] - (i < a_.size() || j < b_.size() ? 2 * kEndGap : 0);
    if (score < best_) return;
    best_ = score;
    best_i_ = i;
    best_j_ = j;
  }

  /// Length of the gap that ends in cell (i, j).
  std::size_t gap_length(std::size_t i, std::size_t j, int step) const {
    const int extends = step == kGapInB ? kExtendsGapInB : kExtendsGapInA;
    std::size_t length = 1;
    while ((steps_[i * (b_.size() + 1) + j] & extends) != 0) {
      --(step == kGapInB ? i : j);
      ++length;
    }
    return length;
  }

  const Sequence &a_, &b_;
  const std::int32_t *numbers_a_ = nullptr, *numbers_b_ = nullptr;
  std::vector<int> row_, gap_in_b_;
  std::vector<unsigned char> steps_;  // [i][j]; empty if only the score is needed
  int best_ = 0;
  std::size_t best_i_ = 0, best_j_ = 0;
};

}  // namespace

ResidueCode SequenceEncoder::encode(const std::string& residue_name) {
  const char letter = residue_letter(residue_name);
  const std::size_t amino_acid = kAminoAcids.find(letter), nucleotide = kNucleotides.find(letter);
  if (amino_acid != std::string_view::npos) return static_cast<ResidueCode>(amino_acid);
  if (nucleotide != std::string_view::npos) return static_cast<ResidueCode>(kFirstNucleotide + nucleotide);
  const auto next = static_cast<ResidueCode>(kFirstOther + others_.size());
  return others_.emplace(residue_name, next).first->second;
}

int substitution_score(ResidueCode a, ResidueCode b) {
  if (a < b) std::swap(a, b);
  if (a < kFirstNucleotide) return kBlosum62[a * (a + 1) / 2 + b];
  if (a == b) return 5;
  if (a < kEndOfNucleotides && b >= kFirstNucleotide) return a == kEndOfNucleotides - 1 && b == a - 1 ? 3 : -4;
  return -1;
}

int self_score(const Sequence& sequence) {
  int score = 0;
  for (const ResidueCode code : sequence) score += substitution_score(code, code);
  return score;
}

int alignment_score(const Sequence& a, const Sequence& b) {
  const int doubled = AlignmentTable(a, b).fill();
  return doubled / 2;
}

std::vector<std::pair<std::size_t, std::size_t>> align_sequences(const Sequence& a, const Sequence& b,
                                                                 const std::vector<std::int32_t>& numbers_a,
                                                                 const std::vector<std::int32_t>& numbers_b) {
  if (a == b && numbers_a == numbers_b) {  // each gap or other pair scores less: copies of a chain need no table
    std::vector<std::pair<std::size_t, std::size_t>> each_with_itself;
    for (std::size_t i = 0; i < a.size(); ++i) each_with_itself.emplace_back(i, i);
    return each_with_itself;
  }
  AlignmentTable table(a, b);
  table.use_numbers(numbers_a, numbers_b);
  table.fill();
  return table.trace_back();
}

}  // namespace espdiff
