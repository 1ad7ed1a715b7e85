// reading.cpp: the forms of a reading.
#include "causes/reading.h"

#include <charconv>

#include "base/error.h"
#include "base/text/printable.h"

namespace espdiff {
namespace {

/// The text behind a word and blanks; empty where it does not begin so.
std::string behind(const std::string& word, const std::string& text) {
  if (text.compare(0, word.size(), word) != 0 || text.size() <= word.size() || text[word.size()] != ' ') return {};
  const std::size_t first = text.find_first_not_of(' ', word.size());
  return first == std::string::npos ? std::string() : text.substr(first);
}

bool parse_residue(const std::string& text, ReadingRequest& request) {
  const std::size_t colon = text.find(':');
  request.chain = colon == std::string::npos ? std::string() : text.substr(0, colon);
  const char* const begin = text.data() + (colon == std::string::npos ? 0 : colon + 1);
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, request.number);
  if (error != std::errc() || stop < end - 1) return false;
  if (stop == end - 1) request.insertion_code = *stop;
  return stop == end || (*stop >= 'A' && *stop <= 'Z');
}

}  // namespace

ReadingRequest parse_reading(const std::string& text) {
  ReadingRequest request;
  if (text == "whole") return request;
  request.of = ReadingOf::kRegion;
  if (text == "region") return request;
  request.of = ReadingOf::kPatch;
  request.patch = behind("patch", text);
  if (!request.patch.empty()) return request;
  request.of = ReadingOf::kResidue;
  const std::string residue = behind("residue", text);
  if (!residue.empty() && parse_residue(residue, request)) return request;
  throw InputError(option("causes") + ": '" + printable(text) +
                   "' is not whole, region, patch NAME, or residue CHAIN:NUMBER such as residue A:103");
}

}  // namespace espdiff
