// gzip_text.h: a whole text file as one string, plain or compressed by gzip.
#pragma once

#include <cstddef>
#include <string>

namespace espdiff {

/// Reads a file into memory; a gzip file (told by its first two bytes, not by its name) is decompressed, all members of
/// it. A file with carriage returns as its only line ends gets newlines instead, so that lines can be counted.
/// @throws IoError (missing, a directory, unreadable), FormatError (gzip stream truncated or corrupt),
///         InputError (empty), MemoryError (does not fit)
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
