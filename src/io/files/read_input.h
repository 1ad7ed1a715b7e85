// read_input.h: reads a file once: its content, unpacked, and the SHA-256 of the same bytes.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace espdiff {

/// An input as it was read. Parsers take the content and provenance takes the hash, so that the hash is of what was
/// compared, whatever happens to the file meanwhile.
struct FileContent {
  std::string path;
  std::string content;  ///< unpacked, when the file was packed by gzip
  std::string sha256;   ///< of the file as it stands, packed or not
};

/// Called once with the first bytes of the content (kRecogniseBytes, fewer in a shorter file), before the others are
/// read. It throws for a file of a wrong kind, so that a large one is not read in vain.
using HeadCheck = std::function<void(std::string_view head)>;

/// Bytes that a gzip file may hold: one of a thousandth of this size can hold as much.
constexpr std::size_t kMostUnpacked = std::size_t{4} << 30U;

/// Reads a file or a pipe to its end. A gzip file (told by its first two bytes, not by its name) is unpacked, all
/// members of it; padding behind the last is ignored. A named pipe that nobody opens for writing is refused after ten
/// seconds.
/// @throws IoError (missing, a directory, a device, unreadable), FormatError (gzip stream truncated or corrupt),
///         InputError (empty, unpacks to more than kMostUnpacked), MemoryError (does not fit), and what `check_head`
///         throws
FileContent read_input(const std::string& path, const HeadCheck& check_head = {});

/// For files that are read again later, or are written to as well, such as states: a pipe would block, or be empty
/// then.
/// @throws IoError unless `path` is a regular file (or a link to one)
void require_regular_file(const std::string& path);

/// Makes newlines of the carriage returns of a text that has no other line ends, so that lines can be counted.
void unify_line_ends(std::string& text);

/// The content of a text file whose hash nobody asks for, with unified line ends.
/// @throws as read_input()
std::string read_text_file(const std::string& path);

}  // namespace espdiff
