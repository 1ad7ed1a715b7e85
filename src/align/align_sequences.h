// align_sequences.h: global alignment of two sequences of residues.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace espdiff {

/// Code of a residue: 0 to 19 amino acids in the order ARNDCQEGHILKMFPSTWYV, 20 to 24 nucleotides a, c, g, t, u, and
/// from 32 on one code per other name.
using ResidueCode = std::uint16_t;
using Sequence = std::vector<ResidueCode>;

/// Assigns codes to names that are neither amino acid nor nucleotide; use one encoder for both sequences.
class SequenceEncoder {
 public:
  ResidueCode encode(const std::string& residue_name);

 private:
  std::map<std::string, ResidueCode> others_;
};

/// Score of pairing two residues: BLOSUM62 for amino acids (Henikoff and Henikoff, Proc. Natl. Acad. Sci. USA 89, 10915
/// (1992)), 5 or -4 for nucleotides (t against u: 3), otherwise 5 for equal names and -1 for different ones.
int substitution_score(ResidueCode a, ResidueCode b);

/// Score of a sequence with itself: the maximum that any sequence reaches with it.
int self_score(const Sequence& sequence);

/// Score of the best global alignment. An inner gap of n residues costs 11 + n. An end gap of any length costs 5,
/// because termini are often missing. Time O(n m), memory O(m).
int alignment_score(const Sequence& a, const Sequence& b);

/// The best global alignment, with the costs of alignment_score() (Needleman and Wunsch, J. Mol. Biol. 48, 443 (1970),
/// with affine gaps after Gotoh, J. Mol. Biol. 162, 705 (1982)). Residues of equal number score 0.5 more, which places
/// gaps in repetitive stretches.
/// @param a, b                 sequences
/// @param numbers_a, numbers_b [position] residue numbers
/// @returns (position in a, position in b), ascending in both; without gaps. Time O(n m), memory n m bytes.
std::vector<std::pair<std::size_t, std::size_t>> align_sequences(const Sequence& a, const Sequence& b,
                                                                 const std::vector<std::int32_t>& numbers_a,
                                                                 const std::vector<std::int32_t>& numbers_b);

}  // namespace espdiff
