// gzip_text.cpp: reads plain and gzip files whole, and says what is wrong with those that cannot be read.
#include "io/gzip_text.h"

#include <sys/stat.h>

#if defined(ESPDIFF_HAVE_ZLIB)
#include <zlib.h>
#endif

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

#include "base/error.h"
#include "base/memory.h"

namespace espdiff {
namespace {

constexpr std::size_t kWholeFile = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kChunk = std::size_t{1} << 18;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

File open_file(const std::string& path) {
  require_regular_file(path);
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) throw IoError(path, std::string("cannot be read: ") + std::strerror(errno) + "; check its permissions");
  struct stat status {};
  if (fstat(fileno(file.get()), &status) == 0 && status.st_size == 0)
    throw InputError(path + ": is empty; give a file with content");
  return file;
}

std::string read_bytes(std::FILE* file, const std::string& path, std::size_t limit) {
  std::string bytes;
  struct stat status {};
  if (fstat(fileno(file), &status) == 0) {
    const std::size_t n = std::min(limit, static_cast<std::size_t>(status.st_size));
    require_memory(static_cast<double>(n), path);
    bytes.reserve(n + 1);  // not doubled on the way
  }
  while (bytes.size() < limit) {
    const std::size_t old_size = bytes.size();
    const std::size_t room = std::max(kChunk, bytes.capacity() - old_size);
    const std::size_t wanted = std::min(room, limit - old_size);
    bytes.resize(old_size + wanted);
    const std::size_t n = std::fread(&bytes[old_size], 1, wanted, file);
    bytes.resize(old_size + n);
    if (n < wanted) break;
  }
  if (std::ferror(file) != 0) throw IoError(path, std::string("reading failed: ") + std::strerror(errno));
  return bytes;
}

bool starts_as_gzip(const std::string& bytes) {
  return bytes.size() >= 2 && bytes[0] == '\x1f' && static_cast<unsigned char>(bytes[1]) == 0x8b;
}

#if defined(ESPDIFF_HAVE_ZLIB)

/// One zlib stream; the object frees what zlib allocated.
class Inflater {
 public:
  explicit Inflater(const std::string& path) : path_(path) {
    constexpr int kGzipOnly = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, kGzipOnly) != Z_OK) throw MemoryError(path + ": zlib could not be started");
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Decompresses up to `limit` bytes. `complete`: `packed` is the whole file, so that it must not end early.
  std::string inflate_all(const std::string& packed, std::size_t limit, bool complete) {
    std::string text;
    std::size_t consumed = 0;
    int status = Z_OK;
    double next_look = 64e6;
    while (text.size() < limit) {
      if (text.size() > kMostUnpacked)
        throw InputError(path_ + ": the gzip file unpacks to more than " + std::to_string(kMostUnpacked >> 30U) +
                         " GiB of text; coarsen or crop what it holds");
      if (static_cast<double>(text.size()) > next_look) {
        // A string grows by doubling: old and new are there at once.
        require_memory(2.0 * static_cast<double>(text.size()), path_);
        next_look = 2 * static_cast<double>(text.size());
      }
      if (stream_.avail_in == 0) {
        const std::size_t n = std::min(packed.size() - consumed, kChunk);
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + consumed));
        stream_.avail_in = static_cast<uInt>(n);
        consumed += n;
      }
      if (status == Z_STREAM_END) {
        // Another member may follow (files joined by cat); anything else behind the end, such as padding, is ignored.
        if (stream_.avail_in < 2 || stream_.next_in[0] != 0x1f || stream_.next_in[1] != 0x8b) break;
        inflateReset(&stream_);
      } else if (stream_.avail_in == 0) {
        if (!complete) break;
        throw FormatError(path_, 0,
                          "the gzip file ends early, after " + std::to_string(text.size()) +
                              " bytes of text; fetch or compress it again");
      }
      status = inflate_chunk(text, limit);
    }
    return text;
  }

 private:
  int inflate_chunk(std::string& text, std::size_t limit) {
    const std::size_t old_size = text.size();
    const std::size_t room = std::min(kChunk, limit - old_size);
    text.resize(old_size + room);
    stream_.next_out = reinterpret_cast<Bytef*>(&text[old_size]);
    stream_.avail_out = static_cast<uInt>(room);
    const int status = inflate(&stream_, Z_NO_FLUSH);
    text.resize(old_size + room - stream_.avail_out);
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) {
      throw FormatError(path_, 0,
                        std::string("the gzip file is corrupt (") +
                            (stream_.msg != nullptr ? stream_.msg : "zlib error") + "); fetch or compress it again");
    }
    return status;
  }

  const std::string& path_;
  z_stream stream_{};
};

std::string inflated(const std::string& path, const std::string& packed, std::size_t limit, bool complete) {
  return Inflater(path).inflate_all(packed, limit, complete);
}

#else

std::string inflated(const std::string& path, const std::string&, std::size_t, bool) {
  throw FormatError(
      path, 0,
      "is compressed, and this build has no zlib to read it with; decompress it with gunzip, or install zlib "
      "(Debian: zlib1g-dev) and build again");
}

#endif

std::string read_up_to(const std::string& path, std::size_t limit) {
  try {
    const File file = open_file(path);
    // Text compresses, so the same number of packed bytes holds at least as much text.
    std::string bytes = read_bytes(file.get(), path, limit == kWholeFile ? limit : std::max(limit, kChunk));
    if (bytes.empty()) throw InputError(path + ": is empty; give a file with content");
    if (starts_as_gzip(bytes)) {
      const bool complete = limit == kWholeFile || bytes.size() < std::max(limit, kChunk);
      bytes = inflated(path, bytes, limit, complete);
      if (bytes.empty()) throw InputError(path + ": the gzip file is empty inside; give a file with content");
    }
    if (bytes.size() > limit) bytes.resize(limit);
    return bytes;
  } catch (const std::bad_alloc&) {
    throw MemoryError(path + ": does not fit into memory; give a smaller file");
  }
}

}  // namespace

void require_regular_file(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0)
    throw IoError(path, std::string("cannot be read: ") + std::strerror(errno) + "; check the path");
  if (S_ISDIR(status.st_mode)) throw IoError(path, "is a directory; give a file in it");
  if (S_ISREG(status.st_mode)) return;
  const bool is_pipe = S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode);
  throw IoError(path, std::string("is a ") + (is_pipe ? "pipe" : "device") +
                          ", and inputs are read more than once; save its content as a file and give that");
}

std::string read_text_file(const std::string& path) {
  std::string text = read_up_to(path, kWholeFile);
  const bool old_mac = text.find('\r') != std::string::npos && text.find('\n') == std::string::npos;
  if (old_mac) std::replace(text.begin(), text.end(), '\r', '\n');
  return text;
}

std::string read_binary_file(const std::string& path) { return read_up_to(path, kWholeFile); }

std::string peek_text_file(const std::string& path, std::size_t n_bytes) { return read_up_to(path, n_bytes); }

bool is_gzip_file(const std::string& path) { return starts_as_gzip(read_bytes(open_file(path).get(), path, 2)); }

}  // namespace espdiff
