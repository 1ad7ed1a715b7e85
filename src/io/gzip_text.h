// gzip_text.h: a whole text file as one string, plain or compressed by gzip.
#pragma once

#include <cstddef>
#include <string>

namespace espdiff {

/// @throws IoError unless `path` is a regular file (or a link to one). Inputs are read several times (format, content,
/// fingerprint), which a pipe cannot be, and a pipe that nobody writes into would block.
void require_regular_file(const std::string& path);

/// Bytes of text that a gzip file may hold: a thousandth of that packs as much.
constexpr std::size_t kMostUnpacked = std::size_t{4} << 30U;

/// Reads a file into memory; a gzip file (told by its first two bytes, not by its name) is decompressed, all members of
/// it. A file with carriage returns as its only line ends gets newlines instead, so that lines can be counted.
/// A gzip file may hold up to 4 GiB of text (kMostUnpacked), and no more than fits into memory.
/// @throws IoError (missing, a directory, unreadable, a pipe or a device), FormatError (gzip stream truncated or
///         corrupt), InputError (empty, unpacks to more than the limit), MemoryError (does not fit)
std::string read_text_file(const std::string& path);

/// The bytes of a file, as read_text_file() without a look at line ends.
/// @throws as read_text_file()
std::string read_binary_file(const std::string& path);

/// The first `n_bytes` of what read_text_file() would return (fewer when the file is shorter).
/// @throws as read_text_file(), but damage behind these bytes is not seen
std::string peek_text_file(const std::string& path, std::size_t n_bytes);

/// Whether the file starts as gzip does.
/// @throws IoError, InputError as read_text_file()
bool is_gzip_file(const std::string& path);

}  // namespace espdiff
