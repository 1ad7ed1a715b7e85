// json_values.h: counts the values of JSON and CBOR before a parser makes objects of them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace espdiff {

/// What a parser takes for a value at most: the value, in an array that doubles, with an empty object or a short name
/// on the heap. Measured: 33 to 65 bytes a bracket, comma or colon.
constexpr double kBytesOfJsonValue = 80;

/// Asks for the memory that JSON takes as objects, by counting its brackets, commas and colons.
/// @param path for the message
/// @throws MemoryError
void require_memory_for_json(std::string_view text, const std::string& path);

/// The same for a file, which is read once more by its parser; a file that cannot be opened passes.
/// @throws MemoryError
void require_memory_for_json(const std::string& path);

/// The number of values in one item of CBOR (RFC 8949), or nothing: for bytes that are no item, or more than one; for
/// more than 16 levels, tags and indefinite lengths, which we do not write. A parser recurses at each of these, so that
/// a small file could use up the stack.
std::optional<std::size_t> count_cbor_values(std::string_view bytes);

}  // namespace espdiff
