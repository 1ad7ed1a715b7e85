// read_input.cpp: reads plain and gzip files in chunks, each hashed as it comes, and says why a file cannot be read.
#include "io/files/read_input.h"

#if defined(ESPDIFF_HAVE_ZLIB)
#include <zlib.h>
#endif

#include <algorithm>
#include <filesystem>
#include <memory>
#include <new>
#include <utility>

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text/system_message.h"
#include "io/files/file_kind.h"
#include "io/files/sha256.h"
#include "io/text/entry_code.h"
#include "system/interruption.h"
#include "system/open_file.h"

namespace espdiff {
namespace {

#ifndef ESPDIFF_READ_CHUNK  // smaller in the fuzz targets, so that their small inputs have several
#define ESPDIFF_READ_CHUNK (std::size_t{1} << 18)
#endif
constexpr std::size_t kChunk = ESPDIFF_READ_CHUNK;
constexpr int kWaitForWriterMs = 10000, kWaitMs = 100;

namespace fs = std::filesystem;

[[noreturn]] void cannot_read(const std::string& path, int error, const char* remedy) {
  throw IoError(path, std::string("cannot be read: ") + system_message(error) + "; " + remedy);
}

/// @throws IoError (nothing there, or a folder)
fs::file_type type_of_file(const std::string& path) {
  if (path.empty()) throw IoError("(empty name)", "cannot read a file without a name; name the input");
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  if (error) {
    if (const std::string advice = entry_advice(path); !advice.empty()) throw IoError(path, advice);
    cannot_read(path, error.value(), "check the path");
  }
  if (type == fs::file_type::directory) throw IoError(path, "is a directory; give a file in it");
  return type;
}

/// A file or pipe that is open for reading.
class InputStream {
 public:
  /// @throws IoError
  explicit InputStream(const std::string& path) : path_(path) {
    const fs::file_type type = type_of_file(path);
    if (type != fs::file_type::regular && type != fs::file_type::fifo)
      throw IoError(path, "is a device or a socket; give a file or a pipe");
    // Opening a pipe would wait for a writer, without end.
    file_ = OpenFile(path, FileAccess::kReadPipe);
    if (!file_) cannot_read(path, file_.error(), "check its permissions");
    is_pipe_ = type == fs::file_type::fifo;
    if (!is_pipe_) n_bytes_ = static_cast<std::size_t>(file_.size());
  }

  /// 0 where it is not known before.
  std::size_t n_bytes() const { return n_bytes_; }

  /// Fills the buffer as far as there is something left to read; returns the number of bytes.
  std::size_t read(char* buffer, std::size_t size) {
    std::size_t n_read = 0;
    const int error = is_pipe_ ? read_pipe(buffer, size, n_read) : file_.read(buffer, size, n_read);
    if (error != 0) throw IoError(path_, std::string("reading failed: ") + system_message(error));
    return n_read;
  }

 private:
  /// In short waits, since a signal between two of them would not end one.
  int read_pipe(char* buffer, std::size_t size, std::size_t& n_read) {
    for (int waited_ms = 0; n_read < size;) {
      const bool is_readable = file_.wait_until_readable(kWaitMs);
      if (Interruption::is_asked()) throw Cancelled();
      CancelRequest().check();
      waited_ms += kWaitMs;
      if (!is_readable && (has_writer_ || waited_ms < kWaitForWriterMs)) continue;
      std::size_t n = 0;
      const int error = file_.read_what_is_there(buffer + n_read, size - n_read, n);
      if (error == 0 && n == 0 && !is_readable)
        throw IoError(path_, "is a pipe that nobody writes into; start what writes, or give a file");
      has_writer_ = true;
      if (error == OpenFile::kNothingYet) continue;
      n_read += n;
      if (error != 0 || n == 0) return error;
    }
    return 0;
  }

  std::string path_;
  OpenFile file_;
  std::size_t n_bytes_ = 0;
  bool is_pipe_ = false, has_writer_ = false;
};

bool starts_as_gzip(std::string_view bytes) { return bytes.substr(0, 2) == "\x1f\x8b"; }

#if defined(ESPDIFF_HAVE_ZLIB)

/// Unpacks a gzip file that comes in chunks.
class Unpacker {
 public:
  explicit Unpacker(std::string path) : path_(std::move(path)) {
    constexpr int kGzipOnly = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, kGzipOnly) != Z_OK) throw MemoryError(path_ + ": zlib could not be started");
  }
  ~Unpacker() { inflateEnd(&stream_); }
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;

  /// Appends to `content` what the chunk holds.
  void add(std::string_view chunk, std::string& content) {
    packed_.append(chunk);
    std::size_t used = 0;
    for (bool goes_on = true; goes_on && !at_padding_;) {
      const std::string_view rest = std::string_view(packed_).substr(used);
      if (!member_ended_) {
        const auto [n_used, n_unpacked] = unpack(rest, content);
        used += n_used;
        goes_on = n_used > 0 || n_unpacked > 0;
      } else if (rest.size() < 2) {
        goes_on = false;
      } else if (starts_as_gzip(rest)) {  // files joined by cat
        inflateReset(&stream_);
        member_ended_ = false;
      } else {
        at_padding_ = true;
      }
    }
    packed_.erase(0, at_padding_ ? packed_.size() : used);
  }

  /// @throws FormatError when the file ended early
  void finish(const std::string& content) const {
    if (member_ended_) return;
    throw FormatError(path_, 0,
                      "the gzip file ends early, after " + std::to_string(content.size()) +
                          " bytes of text; fetch or compress it again");
  }

 private:
  /// As much as fits into one more chunk of the content: bytes used, bytes appended.
  std::pair<std::size_t, std::size_t> unpack(std::string_view packed, std::string& content) {
    const std::size_t old_size = content.size();
    content.resize(old_size + kChunk);
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream_.avail_in = static_cast<uInt>(packed.size());
    stream_.next_out = reinterpret_cast<Bytef*>(&content[old_size]);
    stream_.avail_out = static_cast<uInt>(kChunk);
    const int status = inflate(&stream_, Z_NO_FLUSH);
    const std::size_t n_unpacked = kChunk - stream_.avail_out;
    content.resize(old_size + n_unpacked);
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
      throw FormatError(path_, 0,
                        std::string("the gzip file is corrupt (") +
                            (stream_.msg != nullptr ? stream_.msg : "zlib error") + "); fetch or compress it again");
    member_ended_ = status == Z_STREAM_END;
    if (content.size() > kMostUnpacked)
      throw InputError(path_ + ": the gzip file unpacks to more than " + std::to_string(kMostUnpacked >> 30U) +
                       " GiB of text; coarsen or crop what it holds");
    return {packed.size() - stream_.avail_in, n_unpacked};
  }

  std::string path_;
  z_stream stream_{};
  std::string packed_;  // not used yet
  bool member_ended_ = false, at_padding_ = false;
};

#else

class Unpacker {
 public:
  explicit Unpacker(const std::string& path) {
    throw FormatError(
        path, 0,
        "is compressed, and this build has no zlib to read it with; decompress it with gunzip, or install zlib "
        "(Debian: zlib1g-dev) and build again");
  }
  void add(std::string_view, std::string&) {}
  void finish(const std::string&) const {}
};

#endif

/// The whole content, checked and hashed on the way.
FileContent read_chunks(const std::string& path, const HeadCheck& check_head) {
  InputStream file(path);
  FileContent result;
  result.path = path;
  std::string& content = result.content;
  Sha256 hash;
  std::unique_ptr<Unpacker> unpacker;
  std::string chunk(kChunk, '\0');
  bool head_is_checked = false;
  for (std::size_t n_read = 0, next_look = kChunk;;) {
    const std::size_t n = file.read(chunk.data(), chunk.size());
    const std::string_view bytes = std::string_view(chunk).substr(0, n);
    hash.update(bytes.data(), n);
    if (n_read == 0 && starts_as_gzip(bytes)) unpacker = std::make_unique<Unpacker>(path);
    n_read += n;
    if (unpacker != nullptr) {
      unpacker->add(bytes, content);
    } else {
      content.append(bytes);
    }
    if (n_read == 0) throw InputError(path + ": is empty; give a file with content");
    const bool at_end = n < chunk.size();
    // An error in the part that is there counts more than the missing end.
    if (at_end && unpacker != nullptr && content.size() < kRecogniseBytes) unpacker->finish(content);
    if (!head_is_checked && (at_end || content.size() >= kRecogniseBytes)) {
      if (content.empty()) throw InputError(path + ": the gzip file is empty inside; give a file with content");
      if (check_head) check_head(std::string_view(content).substr(0, kRecogniseBytes));
      head_is_checked = true;
      if (unpacker == nullptr && file.n_bytes() > content.size()) {
        require_memory(static_cast<double>(file.n_bytes()), path);
        content.reserve(file.n_bytes());  // not doubled on the way
      }
    }
    if (at_end && unpacker != nullptr) unpacker->finish(content);
    if (at_end) break;
    if (content.size() > next_look) {
      // A buffer of unknown final size doubles; the old and the new one exist at once.
      if (content.size() == content.capacity() || unpacker != nullptr)
        require_memory(2.0 * static_cast<double>(content.size()), path);
      next_look = 2 * content.size();
    }
  }
  result.sha256 = hash.finish();
  return result;
}

}  // namespace

FileContent read_input(const std::string& path, const HeadCheck& check_head) {
  try {
    return read_chunks(path, check_head);
  } catch (const std::bad_alloc&) {
    throw MemoryError(path + ": does not fit into memory; give a smaller file");
  }
}

void require_regular_file(const std::string& path) {
  if (type_of_file(path) != fs::file_type::regular)
    throw IoError(path, "is a pipe or a device; save its content as a file and give that");
}

void unify_line_ends(std::string& text) {
  const bool old_mac = text.find('\r') != std::string::npos && text.find('\n') == std::string::npos;
  if (old_mac) std::replace(text.begin(), text.end(), '\r', '\n');
}

std::string read_text_file(const std::string& path) {
  std::string text = read_input(path).content;
  unify_line_ends(text);
  return text;
}

}  // namespace espdiff
