// json_values.cpp: one pass over the bytes.
#include "io/text/json_values.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>

#include "base/memory.h"

namespace espdiff {
namespace {

constexpr std::size_t kMostLevels = 16;

/// The types of CBOR: the first three bits of an item.
enum CborType : std::uint8_t { kUnsigned, kNegative, kBytes, kText, kArray, kMap, kTag, kSimple };

/// An item's beginning: its type, and the number behind it (a value, a length or a count).
struct CborHead {
  std::uint8_t type = 0;
  std::uint64_t number = 0;
};

/// Takes a head from the front of `rest`.
std::optional<CborHead> take_head(std::string_view& rest) {
  if (rest.empty()) return std::nullopt;
  const auto first = static_cast<std::uint8_t>(rest.front());
  rest.remove_prefix(1);
  constexpr std::uint8_t kTypeShift = 5, kInfo = 31, kOneByte = 24, kEightBytes = 27;
  CborHead head{static_cast<std::uint8_t>(first >> kTypeShift), static_cast<std::uint64_t>(first & kInfo)};
  if (head.number < kOneByte) return head;
  if (head.number > kEightBytes) return std::nullopt;  // reserved, or of indefinite length
  const std::size_t width = std::size_t{1} << (head.number - kOneByte);
  if (rest.size() < width) return std::nullopt;
  head.number = 0;
  for (std::size_t i = 0; i < width; ++i) head.number = head.number << 8U | static_cast<std::uint8_t>(rest[i]);
  rest.remove_prefix(width);
  return head;
}

double count_values(std::string_view json) {
  return static_cast<double>(
      std::count_if(json.begin(), json.end(), [](char c) { return c == ',' || c == ':' || c == '[' || c == '{'; }));
}

}  // namespace

void require_memory_for_json(std::string_view text, const std::string& path) {
  require_memory(static_cast<double>(text.size()) + kBytesOfJsonValue * count_values(text), path);
}

void require_memory_for_json(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string chunk(std::size_t{1} << 16U, '\0');
  double n_bytes = 0, n_values = 0;
  while (in.read(chunk.data(), static_cast<std::streamsize>(chunk.size())), in.gcount() > 0) {
    n_bytes += static_cast<double>(in.gcount());
    n_values += count_values(std::string_view(chunk).substr(0, static_cast<std::size_t>(in.gcount())));
  }
  require_memory(n_bytes + kBytesOfJsonValue * n_values, path);
}

std::optional<std::size_t> count_cbor_values(std::string_view bytes) {
  std::string_view rest = bytes;
  std::array<std::uint64_t, kMostLevels> left{};  // items that each open array or map still lacks
  std::size_t n_open = 0, n_values = 0;
  do {
    const std::optional<CborHead> head = take_head(rest);
    if (!head || head->type == kTag) return std::nullopt;
    ++n_values;
    if (n_open > 0) --left[n_open - 1];
    if (head->type == kBytes || head->type == kText) {
      if (head->number > rest.size()) return std::nullopt;
      rest.remove_prefix(static_cast<std::size_t>(head->number));
    } else if (head->type == kArray || head->type == kMap) {
      // Each item is a byte or more.
      if (head->number > rest.size() || n_open == kMostLevels) return std::nullopt;
      left[n_open++] = head->number * (head->type == kMap ? 2 : 1);
    }
    while (n_open > 0 && left[n_open - 1] == 0) --n_open;
  } while (n_open > 0);
  if (!rest.empty()) return std::nullopt;
  return n_values;
}

}  // namespace espdiff
