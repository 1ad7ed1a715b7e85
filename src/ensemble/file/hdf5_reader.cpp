// hdf5_reader.cpp: superblock, groups, object headers and chunk indices, each checked before it is followed.
#include "ensemble/file/hdf5_reader.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/memory.h"
#include "base/text/system_message.h"
#include "system/open_file.h"

namespace espdiff {
namespace {

// Types of messages in object headers.
constexpr unsigned kDataspace = 1, kDatatype = 3, kExternalFiles = 7, kLayout = 8, kFilters = 11, kContinuation = 16,
                   kSymbolTable = 17;
constexpr std::size_t kMostMessages = 1000, kMostBlock = std::size_t{1} << 20;
/// Of a tree: one of four levels has millions of chunks.
constexpr int kMostLevels = 8;
constexpr std::size_t kMostNodes = 1'000'000;
constexpr std::size_t kNodeHead = 24, kSymbolEntry = 40;

/// A little-endian number; the block was read as long as its parts need.
std::uint64_t number(const std::string& block, std::size_t at, std::size_t n_bytes) {
  std::uint64_t value = 0;
  if (at + n_bytes > block.size()) return 0;
  for (std::size_t i = n_bytes; i > 0; --i) value = value << 8 | static_cast<unsigned char>(block[at + i - 1]);
  return value;
}

bool begins_with(const std::string& block, const char* mark) { return block.compare(0, std::strlen(mark), mark) == 0; }

}  // namespace

struct Hdf5Reader::Message {
  unsigned type;
  std::string content;
};

void read_file_at(const OpenFile& file, const std::string& path, std::uint64_t offset, void* bytes, std::size_t n) {
  const int error = file.read_at(offset, bytes, n);
  if (error == OpenFile::kEndsTooEarly) throw IoError(path, "ends too early");
  if (error != 0) throw IoError(path, std::string("cannot be read: ") + system_message(error));
}

Hdf5Reader::Hdf5Reader(const OpenFile& file, std::string path)
    : file_(file), path_(std::move(path)), n_bytes_(file.size()) {
  constexpr std::size_t kSuperblock = 96;
  const std::string head = n_bytes_ < kSuperblock ? std::string() : block(0, kSuperblock);
  if (!begins_with(head, "\x89HDF\r\n\x1a\n")) fail("not the OUT.h5 of an ensemble: no HDF5 file");
  const bool is_ours = head[8] == 0 && head[13] == 8 && head[14] == 8 && number(head, 24, 8) == 0;
  if (!is_ours) fail("not the OUT.h5 of an ensemble: an HDF5 file of another form");
  root_ = number(head, 64, 8);
}

void Hdf5Reader::fail(const std::string& what) const {
  throw FormatError(path_, 0, what + "; begin anew with another output, or with " + switched_on("overwrite"));
}

void Hdf5Reader::read_bytes(std::uint64_t address, void* bytes, std::size_t n) const {
  if (n > n_bytes_ || address > n_bytes_ - n) fail("the file is cut off, or its structure is damaged");
  read_file_at(file_, path_, address, bytes, n);
}

std::string Hdf5Reader::block(std::uint64_t address, std::uint64_t n) const {
  if (n > n_bytes_ || n > kMostBlock) fail("the file's structure is damaged");
  std::string bytes(static_cast<std::size_t>(n), '\0');
  read_bytes(address, bytes.data(), bytes.size());
  return bytes;
}

std::vector<Hdf5Reader::Message> Hdf5Reader::messages(std::uint64_t header) const {
  constexpr std::size_t kPrefix = 16, kMessageHead = 8;
  const std::string prefix = block(header, kPrefix);
  if (prefix[0] != 1) fail("an object's header is damaged");
  std::vector<std::pair<std::uint64_t, std::uint64_t>> parts = {{header + kPrefix, number(prefix, 8, 4)}};
  std::vector<Message> all;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const auto [address, n_part] = parts[part];
    const std::string bytes = block(address, n_part);
    for (std::size_t at = 0; at + kMessageHead <= bytes.size();) {
      const auto type = static_cast<unsigned>(number(bytes, at, 2));
      const std::size_t n = number(bytes, at + 2, 2);
      const bool is_shared = (number(bytes, at + 4, 1) & 2U) != 0;
      at += kMessageHead;
      if (n > bytes.size() - at || all.size() + parts.size() > kMostMessages) fail("an object's header is damaged");
      Message message{is_shared ? ~0U : type, bytes.substr(at, n)};
      if (message.type == kContinuation)
        parts.emplace_back(number(message.content, 0, 8), number(message.content, 8, 8));
      all.push_back(std::move(message));
      at += n;
    }
  }
  return all;
}

std::uint64_t Hdf5Reader::member_in_node(std::uint64_t node, const std::string& names, const std::string& name,
                                         int depth, std::size_t& n_nodes) const {
  if (++n_nodes > kMostNodes) fail("a group is damaged");
  const std::string head = block(node, kNodeHead);
  if (begins_with(head, "TREE") && head[4] == 0 && depth < kMostLevels) {
    const std::size_t n = number(head, 6, 2);
    const std::string children = block(node + kNodeHead, 16 * n);  // key, child, key, child, ...
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint64_t found = member_in_node(number(children, 16 * i + 8, 8), names, name, depth + 1, n_nodes);
      if (found != 0) return found;
    }
    return 0;
  }
  if (!begins_with(head, "SNOD")) fail("a group is damaged");
  const std::size_t n = number(head, 6, 2);
  const std::string entries = block(node + 8, kSymbolEntry * n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t at = number(entries, kSymbolEntry * i, 8);
    if (at >= names.size() || names.compare(at, name.size() + 1, name.c_str(), name.size() + 1) != 0) continue;
    constexpr std::uint64_t kSoftLink = 2;
    if (number(entries, kSymbolEntry * i + 16, 4) == kSoftLink) fail(name + " is a link");
    return number(entries, kSymbolEntry * i + 8, 8);
  }
  return 0;
}

std::uint64_t Hdf5Reader::member(std::uint64_t group_header, const std::string& name) const {
  for (const Message& message : messages(group_header)) {
    if (message.type != kSymbolTable) continue;
    const std::string heap = block(number(message.content, 8, 8), 32);
    const std::uint64_t n_names = number(heap, 8, 8);
    if (!begins_with(heap, "HEAP")) fail("a group is damaged");
    std::size_t n_nodes = 0;
    return member_in_node(number(message.content, 0, 8), block(number(heap, 24, 8), n_names), name, 0, n_nodes);
  }
  return 0;
}

bool Hdf5Reader::has(const std::string& name) const { return header_of(name) != 0; }

std::uint64_t Hdf5Reader::header_of(const std::string& name) const {
  std::uint64_t header = root_;
  for (std::size_t begin = 1; begin <= name.size() && header != 0;) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    header = member(header, name.substr(begin, end - begin));
    begin = end + 1;
  }
  return header;
}

void Hdf5Reader::add_chunks(std::uint64_t node, int depth, std::size_t& n_nodes, Hdf5Dataset& set) const {
  // A key: bytes of the chunk, filters left out, place of its first element, 0; then the child.
  constexpr std::size_t kKey = 24, kEntry = kKey + 8;
  const std::string head = block(node, kNodeHead);
  if (!begins_with(head, "TREE") || head[4] != 1 || depth > kMostLevels || ++n_nodes > kMostNodes)
    fail(set.name + " has a damaged index");
  const std::size_t n = number(head, 6, 2);
  const bool is_leaf = head[5] == 0;
  const std::string entries = block(node + kNodeHead, kEntry * n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t child = number(entries, kEntry * i + kKey, 8);
    if (!is_leaf) {
      add_chunks(child, depth + 1, n_nodes, set);
      continue;
    }
    const std::uint64_t n_chunk = number(entries, kEntry * i, 4), place = number(entries, kEntry * i + 8, 8);
    if (n_chunk != set.chunk_items * set.item_bytes || place != set.chunks.size() * set.chunk_items ||
        n_chunk > n_bytes_ || child > n_bytes_ - n_chunk || place >= set.n)
      fail(set.name + ": chunk " + std::to_string(set.chunks.size()) + " has no place in the file");
    set.chunks.push_back(child);
  }
}

Hdf5Dataset Hdf5Reader::find(const std::string& name) const {
  Hdf5Dataset set;
  set.name = name;
  const std::uint64_t header = header_of(name);
  if (header == 0) fail(name + " is missing or damaged");
  std::uint64_t n = 0, n_stored = 0, tree = 0;
  bool has_size = false, has_type = false, has_layout = false;
  for (const Message& message : messages(header)) {
    const std::string& m = message.content;
    if (message.type == kFilters || message.type == kExternalFiles) fail(name + " is packed, or in another file");
    if (message.type == kDataspace && number(m, 0, 1) == 1) {
      const std::size_t rank = number(m, 1, 1);
      n = 1;
      for (std::size_t k = 0; k < rank; ++k) {
        const std::uint64_t size = number(m, 8 + 8 * k, 8);
        if (size > n_bytes_ || n > n_bytes_) fail(name + " is larger than the file");
        n *= size;
      }
      has_size = rank > 0 && n <= n_bytes_;
    } else if (message.type == kDatatype && m.size() >= 8) {
      const unsigned type_class = number(m, 0, 1) & 15U, bits = static_cast<unsigned>(number(m, 1, 1));
      set.kind = type_class == 1 ? 'f' : (bits & 8U) != 0 ? 'i' : 'u';
      set.item_bytes = number(m, 4, 4);
      has_type = type_class <= 1 && (bits & 1U) == 0 && set.item_bytes >= 1 && set.item_bytes <= 8;
    } else if (message.type == kLayout && number(m, 0, 1) == 3) {
      const std::uint64_t layout = number(m, 1, 1);
      if (layout == 1) {
        set.address = number(m, 2, 8);
        n_stored = number(m, 10, 8);
      } else if (layout == 2 && number(m, 2, 1) == 2) {
        tree = number(m, 3, 8);
        set.chunk_items = number(m, 11, 4);
      }
      has_layout = layout == 1 || tree != 0;
    }
  }
  if (!has_size || !has_type || !has_layout) fail(name + " is damaged, or of another form than espdiff writes");
  set.n = n;
  if (tree != 0) {
    std::size_t n_nodes = 0;
    add_chunks(tree, 0, n_nodes, set);
    if (set.chunk_items == 0 || set.chunks.size() * set.chunk_items != n) fail(name + " lacks chunks");
  } else if (n_stored != n * set.item_bytes || n_stored > n_bytes_ || set.address > n_bytes_ - n_stored) {
    fail(name + " is larger than the file");
  }
  return set;
}

std::vector<char> Hdf5Reader::bytes_of(const std::string& name) const {
  const Hdf5Dataset set = find(name);
  std::vector<char> bytes(checked_size(set, set.kind, set.item_bytes, 1) * set.item_bytes);
  read_bytes(set.address, bytes.data(), bytes.size());
  return bytes;
}

std::size_t Hdf5Reader::checked_size(const Hdf5Dataset& set, char kind, std::size_t item_bytes,
                                     std::size_t per_item) const {
  if (set.kind != kind || set.item_bytes != item_bytes || !set.chunks.empty() || set.n % per_item != 0)
    fail(set.name + " is of another form than espdiff writes");
  require_memory(static_cast<double>(set.n) * static_cast<double>(item_bytes), path_);
  return static_cast<std::size_t>(set.n) / per_item;
}

}  // namespace espdiff
