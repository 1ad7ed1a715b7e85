// vtk_encoding.cpp: base64, lengths and blocks, every one checked against the bytes that are there.
#include "io/vtk/vtk_encoding.h"

#if defined(ESPDIFF_HAVE_ZLIB)
#include <zlib.h>
#endif

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "base/error.h"
#include "base/memory.h"

namespace espdiff {
namespace {

constexpr int kNoDigit = -1;

constexpr std::array<int, 256> base64_digits() {
  std::array<int, 256> digits{};
  for (int& digit : digits) digit = kNoDigit;
  constexpr std::string_view kAll = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kAll.size(); ++i) digits[static_cast<unsigned char>(kAll[i])] = static_cast<int>(i);
  return digits;
}

/// Reads streams of bytes one after the other from the characters of a file.
class EncodedText {
 public:
  EncodedText(std::string_view text, bool is_base64, std::string where)
      : text_(text), is_base64_(is_base64), where_(std::move(where)) {}

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(ErrorClass::kFormat, where_ + " " + problem + "; write or fetch the file again");
  }

  /// How many bytes the characters that are left can hold.
  std::uint64_t most_bytes() const { return is_base64_ ? text_.size() / 4 * 3 : text_.size(); }
  std::size_t n_read() const { return n_read_; }

  /// The first `n` bytes of a stream that begins here, without moving on.
  std::string_view peek(std::uint64_t n, std::string& storage) const {
    if (n > most_bytes())
      fail("is cut short: " + std::to_string(n) + " bytes are needed, and " + std::to_string(most_bytes()) + " follow");
    if (!is_base64_) return text_.substr(0, n);
    decode(n, storage);
    return storage;
  }

  /// The same, and moves behind the stream.
  std::string_view take(std::uint64_t n, std::string& storage) {
    const std::string_view bytes = peek(n, storage);
    const std::size_t used = is_base64_ ? (n + 2) / 3 * 4 : n;
    text_.remove_prefix(used);
    n_read_ += used;
    return bytes;
  }

 private:
  void decode(std::uint64_t n, std::string& bytes) const {
    static constexpr std::array<int, 256> kDigits = base64_digits();
    require_memory(static_cast<double>(n), where_);
    bytes.clear();
    bytes.reserve(n + 2);
    for (std::size_t i = 0; bytes.size() < n; i += 4) {
      std::uint32_t bits = 0;
      int n_digits = 0;
      for (std::size_t j = 0; j < 4; ++j) {
        const char c = text_[i + j];
        const int digit = kDigits[static_cast<unsigned char>(c)];
        const bool is_padding = c == '=' && j > n - bytes.size();
        if (digit == kNoDigit && !is_padding)
          fail("has a character that is not base64 where " + std::to_string(n) + " bytes were expected");
        bits = bits << 6U | static_cast<std::uint32_t>(is_padding ? 0 : digit);
        n_digits += is_padding ? 0 : 1;
      }
      for (int j = 0; j + 1 < n_digits; ++j) bytes += static_cast<char>(bits >> (16 - 8 * j) & 0xffU);
    }
    bytes.resize(n);
  }

  std::string_view text_;
  bool is_base64_;
  std::string where_;
  std::size_t n_read_ = 0;
};

#if defined(ESPDIFF_HAVE_ZLIB)
/// Unpacks a block to exactly `n` bytes at the end of `bytes`.
bool append_unpacked(std::string_view packed, std::uint64_t n, std::string& bytes) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + n);
  uLongf n_unpacked = static_cast<uLongf>(n);
  const int status = uncompress(reinterpret_cast<Bytef*>(&bytes[begin]), &n_unpacked,
                                reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
  return status == Z_OK && n_unpacked == n;
}
#else
bool append_unpacked(std::string_view, std::uint64_t, std::string&) { return false; }
#endif

constexpr std::uint64_t kMostOfAnyLength = 1'000'000;

/// Sizes of the blocks of an array.
struct Blocks {
  std::uint64_t whole = 0;            // bytes of each block but perhaps the last, unpacked
  std::uint64_t last = 0;             // bytes of the last block, unpacked
  std::vector<std::uint64_t> packed;  // bytes of each block in the file
};

/// @param n_bytes expected; of kAnyLength set to what the file says
Blocks read_blocks(EncodedText& text, const VtkEncoding& encoding, std::uint64_t& n_bytes) {
  const std::size_t width = encoding.long_headers ? 8 : 4;
  std::string storage;
  const auto number = [&](std::string_view bytes, std::size_t i) {
    return load_unsigned(bytes.data() + i * width, width, encoding.big_endian);
  };
  const std::string_view head = text.peek(3 * width, storage);
  const std::uint64_t n_blocks = number(head, 0), whole = number(head, 1), partial = number(head, 2);
  const std::uint64_t most = n_bytes == kAnyLength ? kMostOfAnyLength : n_bytes;
  if (n_blocks == 0 || n_blocks > text.most_bytes() / width || whole == 0 || whole > most + (std::uint64_t{1} << 32U) ||
      partial > whole)
    text.fail("has a damaged table of blocks: " + std::to_string(n_blocks) + " blocks of " + std::to_string(whole) +
              " bytes, the last of " + std::to_string(partial) + " (is header_type the one that it was written with?)");
  Blocks blocks;
  blocks.whole = whole;
  blocks.last = partial == 0 ? whole : partial;
  if (n_bytes == kAnyLength && n_blocks <= kMostOfAnyLength / whole + 1) n_bytes = (n_blocks - 1) * whole + blocks.last;
  // In doubles, since the product of two numbers of a file may be anything.
  const double total =
      static_cast<double>(n_blocks - 1) * static_cast<double>(whole) + static_cast<double>(blocks.last);
  if (total != static_cast<double>(n_bytes) || (n_blocks - 1) * whole + blocks.last != n_bytes)
    text.fail("has blocks of " + std::to_string(n_blocks - 1) + " x " + std::to_string(whole) + " + " +
              std::to_string(blocks.last) + " bytes, but " + std::to_string(n_bytes) + " were expected");
  const std::string_view table = text.take((3 + n_blocks) * width, storage);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < n_blocks; ++i) {
    blocks.packed.push_back(number(table, 3 + i));
    if (blocks.packed.back() > text.most_bytes() - sum) text.fail("is cut short: its blocks are longer than the file");
    sum += blocks.packed.back();
  }
  // No stream of zlib's is shorter than a 1032nd of what it holds.
  constexpr std::uint64_t kBestPacking = 1032;
  if (n_bytes / kBestPacking > sum)
    text.fail("promises " + std::to_string(n_bytes) + " bytes in " + std::to_string(sum) +
              " compressed ones, more than zlib can pack");
  return blocks;
}

std::string_view unpack(EncodedText& text, const VtkEncoding& encoding, std::uint64_t n_bytes, std::string& storage,
                        const std::string& where) {
#if !defined(ESPDIFF_HAVE_ZLIB)
  throw InputError(where +
                   " is compressed, and this build has no zlib to read it with; save the file without compression, or "
                   "install zlib (Debian: zlib1g-dev) and build again");
#endif
  const Blocks blocks = read_blocks(text, encoding, n_bytes);
  std::uint64_t n_packed = 0;
  for (const std::uint64_t n : blocks.packed) n_packed += n;
  std::string packed_storage;
  const std::string_view packed = text.take(n_packed, packed_storage);
  require_memory(static_cast<double>(n_bytes), where);
  storage.clear();
  storage.reserve(n_bytes);
  std::size_t position = 0;
  for (std::size_t i = 0; i < blocks.packed.size(); ++i) {
    const bool is_last = i + 1 == blocks.packed.size();
    if (!append_unpacked(packed.substr(position, blocks.packed[i]), is_last ? blocks.last : blocks.whole, storage))
      text.fail("has a damaged block: number " + std::to_string(i + 1) + " of " + std::to_string(blocks.packed.size()) +
                " cannot be unpacked");
    position += blocks.packed[i];
  }
  return storage;
}

}  // namespace

const char* vtk_byte_order() {
  const std::uint16_t probe = 1;
  unsigned char first = 0;
  std::memcpy(&first, &probe, 1);
  return first == 1 ? "LittleEndian" : "BigEndian";
}

std::uint64_t load_unsigned(const char* bytes, std::size_t n_bytes, bool big_endian) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < n_bytes; ++i) {
    const auto byte = static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[big_endian ? i : n_bytes - 1 - i]));
    value = value << 8U | byte;
  }
  return value;
}

std::string_view decode_array(std::string_view encoded, bool is_base64, const VtkEncoding& encoding,
                              std::uint64_t n_bytes, std::string& storage, std::size_t& n_read, const std::string& path,
                              long line, const std::string& array) {
  const std::string where = path + ":" + std::to_string(line) + ": " + array;
  EncodedText text(encoded, is_base64, where);
  std::string_view bytes;
  if (encoding.compressed) {
    bytes = unpack(text, encoding, n_bytes, storage, where);
  } else {
    // Length and values are one stream.
    const std::size_t width = encoding.long_headers ? 8 : 4;
    const std::uint64_t length = load_unsigned(text.peek(width, storage).data(), width, encoding.big_endian);
    if (n_bytes == kAnyLength && length <= kMostOfAnyLength) n_bytes = length;
    if (length != n_bytes)
      text.fail("has " + std::to_string(length) + " bytes, but its type and the number of points ask for " +
                std::to_string(n_bytes));
    bytes = text.take(width + n_bytes, storage).substr(width);
  }
  n_read = text.n_read();
  return bytes;
}

}  // namespace espdiff
