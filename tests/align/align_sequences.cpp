// align_sequences.cpp: alignment against brute force, and the placement of gaps.
#include "align/align_sequences.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <numeric>
#include <random>

using namespace espdiff;

namespace {

Sequence encode(const std::string& letters) {
  static const std::string order = "ARNDCQEGHILKMFPSTWYV";
  Sequence sequence;
  for (const char letter : letters) sequence.push_back(static_cast<ResidueCode>(order.find(letter)));
  return sequence;
}

std::vector<std::int32_t> numbered(std::size_t n, int first = 1) {
  std::vector<std::int32_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

/// Both sequences written with gaps, as "ACD-|A-DE".
std::string written(const std::string& a, const std::string& b, int first_a = 1, int first_b = 1) {
  std::string top, bottom;
  std::size_t i = 0, j = 0;
  const auto skip_to = [&](std::size_t p, std::size_t q) {
    for (; i < p; ++i) top += a[i], bottom += '-';
    for (; j < q; ++j) top += '-', bottom += b[j];
  };
  for (const auto& [p, q] :
       align_sequences(encode(a), encode(b), numbered(a.size(), first_a), numbered(b.size(), first_b))) {
    skip_to(p, q);
    top += a[i++];
    bottom += b[j++];
  }
  skip_to(a.size(), b.size());
  return top + "|" + bottom;
}

/// Score of an alignment given as pairs, by the documented rules.
int score_of(const Sequence& a, const Sequence& b, const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
  int score = 0;
  std::size_t i = 0, j = 0;
  const auto gap = [&](std::size_t from, std::size_t to, std::size_t size) {
    if (to == from) return 0;
    return from == 0 || to == size ? 5 : 11 + static_cast<int>(to - from);
  };
  for (const auto& [p, q] : pairs) {
    score += substitution_score(a[p], b[q]) - gap(i, p, a.size()) - gap(j, q, b.size());
    i = p + 1;
    j = q + 1;
  }
  return score - gap(i, a.size(), a.size()) - gap(j, b.size(), b.size());
}

/// The best score over all ways to pair positions in order.
int brute_force(const Sequence& a, const Sequence& b) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  int best = score_of(a, b, pairs);
  const std::function<void(std::size_t, std::size_t)> extend = [&](std::size_t i, std::size_t j) {
    for (std::size_t p = i; p < a.size(); ++p) {
      for (std::size_t q = j; q < b.size(); ++q) {
        pairs.emplace_back(p, q);
        best = std::max(best, score_of(a, b, pairs));
        extend(p + 1, q + 1);
        pairs.pop_back();
      }
    }
  };
  extend(0, 0);
  return best;
}

}  // namespace

TEST_CASE("substitution scores are symmetric and highest for equal residues") {
  for (ResidueCode a = 0; a < 40; ++a) {
    for (ResidueCode b = 0; b < 40; ++b) {
      CHECK(substitution_score(a, b) == substitution_score(b, a));
      if (a != b) CHECK(substitution_score(a, b) < substitution_score(a, a));
    }
  }
  CHECK(substitution_score(encode("W")[0], encode("W")[0]) == 11);
  CHECK(substitution_score(encode("L")[0], encode("I")[0]) == 2);
  CHECK(substitution_score(23, 24) == 3);   // t against u
  CHECK(substitution_score(20, 24) == -4);  // a against u
}

TEST_CASE("names without a letter get their own code, the same in both sequences") {
  SequenceEncoder encoder;
  const ResidueCode nte = encoder.encode("NTE"), cte = encoder.encode("CTE");
  CHECK(nte != cte);
  CHECK(encoder.encode("NTE") == nte);
  CHECK(encoder.encode("HSE") == encoder.encode("HIS"));
  CHECK(encoder.encode("A") != encoder.encode("ALA"));
  CHECK(substitution_score(nte, nte) == 5);
  CHECK(substitution_score(nte, cte) == -1);
}

TEST_CASE("score and alignment are optimal: compared with every alignment of short sequences") {
  std::mt19937 random(7);
  for (int trial = 0; trial < 200; ++trial) {
    Sequence a(1 + random() % 5), b(1 + random() % 6);
    for (ResidueCode& code : a) code = static_cast<ResidueCode>(random() % 4);
    for (ResidueCode& code : b) code = static_cast<ResidueCode>(random() % 4);
    const int best = brute_force(a, b);
    CHECK(alignment_score(a, b) == best);
    CHECK(alignment_score(b, a) == best);
    // Numbers that never agree leave the score alone.
    CHECK(score_of(a, b, align_sequences(a, b, numbered(a.size(), 100), numbered(b.size(), 200))) == best);
  }
}

TEST_CASE("gaps are placed where residues are missing") {
  CHECK(written("MKTAYIAKQR", "MKTAYIAKQR") == "MKTAYIAKQR|MKTAYIAKQR");
  CHECK(written("MKTAYIAKQR", "MKTAYLAKQR") == "MKTAYIAKQR|MKTAYLAKQR");
  CHECK(written("MKTAYIAKQR", "TAYIAKQR") == "MKTAYIAKQR|--TAYIAKQR");
  CHECK(written("MKTAYIAKQR", "MKTAYIA") == "MKTAYIAKQR|MKTAYIA---");
  CHECK(written("MKTAYIAKQRQISFVK", "MKTAYIAISFVK") == "MKTAYIAKQRQISFVK|MKTAYIA----ISFVK");
  // A substitution at the end is a pair, not two gaps.
  CHECK(written("MKTAYW", "MKTAYG") == "MKTAYW|MKTAYG");
}

TEST_CASE("equal residue numbers place the gap in a repeat") {
  // WCAAAAAACW has lost two of six alanines: 5 and 6 by their numbers; the score alone cannot decide.
  const Sequence a = encode("WCAAAAAACW"), b = encode("WCAAAACW");
  const auto pairs = align_sequences(a, b, numbered(10), {1, 2, 3, 4, 7, 8, 9, 10});
  std::vector<std::size_t> positions;
  for (const auto& pair : pairs) positions.push_back(pair.first);
  CHECK(positions == std::vector<std::size_t>{0, 1, 2, 3, 6, 7, 8, 9});
}

TEST_CASE("empty sequences align to nothing") {
  CHECK(alignment_score({}, {}) == 0);
  CHECK(alignment_score(encode("AC"), {}) == -5);
  CHECK(align_sequences({}, encode("AC"), {}, numbered(2)).empty());
}

TEST_CASE("2,000 by 2,000 residues align quickly") {
  std::mt19937 random(3);
  Sequence a(2000);
  for (ResidueCode& code : a) code = static_cast<ResidueCode>(random() % 20);
  Sequence b(a.begin() + 300, a.end());
  b.erase(b.begin() + 500, b.begin() + 540);
  const auto start = std::chrono::steady_clock::now();
  const auto pairs = align_sequences(a, b, numbered(a.size()), numbered(b.size(), 5000));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  MESSAGE("2,000 x 1,660 residues: ", 1e3 * seconds, " ms");
  CHECK(pairs.size() == b.size());
  CHECK(pairs.front() == std::make_pair(std::size_t{300}, std::size_t{0}));
  CHECK(pairs.back() == std::make_pair(std::size_t{1999}, b.size() - 1));
}
