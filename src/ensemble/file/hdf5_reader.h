// hdf5_reader.h: finds datasets in the HDF5 files that make_hdf5_file() lays out, and reads them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace espdiff {

class OpenFile;

/// @throws IoError (beyond its end, cannot be read)
void read_file_at(const OpenFile& file, const std::string& path, std::uint64_t offset, void* bytes, std::size_t n);

/// Where a dataset lies in the file.
struct Hdf5Dataset {
  std::string name;
  char kind = 0;               ///< of its elements: 'i' signed, 'u' unsigned, 'f' floating point; little-endian
  std::size_t item_bytes = 0;  ///< of an element
  std::uint64_t n = 0;         ///< elements
  std::uint64_t address = 0;   ///< of all elements, one after the other; 0 where it is chunked
  /// [chunk] of a chunked dataset of one dimension, in order; all are there, without filters, of `chunk_items` each.
  std::vector<std::uint64_t> chunks;
  std::uint64_t chunk_items = 0;
};

/// Reads the part of HDF5 that such a file uses: superblock version 0, groups as symbol tables, object headers of
/// version 1, contiguous and chunked datasets without filters. The HDF5 library crashes on damaged files; this does
/// not: every address and size is checked against the file before it is followed. Links to other files, filters and
/// virtual datasets are not read. Source: HDF5 File Format Specification, version 1.1.
class Hdf5Reader {
 public:
  /// @param file open for reading, and as long as this lives
  /// @throws FormatError (not such a file)
  Hdf5Reader(const OpenFile& file, std::string path);

  /// Whether there is a group or dataset of this path from the root.
  bool has(const std::string& name) const;
  /// A dataset by its path from the root: "/espdiff/plan". @throws FormatError (missing, damaged, of another form)
  Hdf5Dataset find(const std::string& name) const;
  /// The elements of a contiguous dataset, as they are in the file.
  /// @param T of the dataset's element size times `per_item`
  /// @throws FormatError (another kind or size of element, not a multiple of `per_item`, beyond the file)
  template <typename T>
  std::vector<T> read(const std::string& name, char kind, std::size_t per_item = 1) const {
    const Hdf5Dataset set = find(name);
    std::vector<T> values(checked_size(set, kind, sizeof(T) / per_item, per_item));
    read_bytes(set.address, values.data(), values.size() * sizeof(T));
    return values;
  }
  /// All elements of a contiguous dataset of any kind.
  std::vector<char> bytes_of(const std::string& name) const;

 private:
  struct Message;

  [[noreturn]] void fail(const std::string& what) const;
  /// @throws FormatError (beyond the file)
  void read_bytes(std::uint64_t address, void* bytes, std::size_t n) const;
  std::string block(std::uint64_t address, std::uint64_t n) const;
  std::size_t checked_size(const Hdf5Dataset& set, char kind, std::size_t item_bytes, std::size_t per_item) const;
  std::vector<Message> messages(std::uint64_t header) const;
  /// The address of the object header at a path from the root; 0 if there is none.
  std::uint64_t header_of(const std::string& name) const;
  /// The address of the object header of a group's member; 0 if there is none.
  std::uint64_t member(std::uint64_t group_header, const std::string& name) const;
  /// @param n_nodes counts the nodes of the tree: those of a damaged one may be each other's children
  std::uint64_t member_in_node(std::uint64_t node, const std::string& names, const std::string& name, int depth,
                               std::size_t& n_nodes) const;
  void add_chunks(std::uint64_t node, int depth, std::size_t& n_nodes, Hdf5Dataset& set) const;

  const OpenFile& file_;
  std::string path_;
  std::uint64_t n_bytes_ = 0, root_ = 0;
};

}  // namespace espdiff
