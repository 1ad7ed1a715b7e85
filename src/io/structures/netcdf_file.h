// netcdf_file.h: files in NetCDF's classic formats (CDF-1, CDF-2, CDF-5), variable by variable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace espdiff {

/// Where the bytes of a file come from: it itself, or what was read of it already.
struct ByteSource {
  std::string path;  ///< for messages
  std::uint64_t n_bytes = 0;
  std::function<bool(std::uint64_t at, char* bytes, std::size_t n)> read;  ///< false where they are not there
};

/// @throws IoError (missing, unreadable)
ByteSource bytes_of_file(const std::string& path);
ByteSource bytes_of_text(const std::string& path, std::string content);

/// A variable of numbers.
struct NetcdfVariable {
  int type = 0;                              ///< NetCDF's number of it
  std::vector<std::size_t> lengths;          ///< of its dimensions; of records' own variables without that of records
  bool has_records = false;                  ///< there is one value of it in each record
  std::uint64_t begin = 0;                   ///< of its first value in the file
  std::map<std::string, std::string> notes;  ///< its attributes that are text

  std::size_t n_values() const;  ///< all of them, or those of a record
};

/// A head, and numbers by it. Specification: docs.unidata.ucar.edu, "NetCDF Classic Format".
class NetcdfFile {
 public:
  /// @throws FormatError (no classic NetCDF; its head is cut off or contradicts itself)
  explicit NetcdfFile(ByteSource source);

  const std::string& path() const { return source_.path; }
  /// Null where there is none.
  const NetcdfVariable* find(const std::string& name) const;
  /// Whole records, by the file's size; of those that its head names, where it names any.
  std::size_t n_records() const { return n_records_; }
  /// What of the records is missing, in words; empty where nothing is.
  std::string missing() const;
  /// The values of a variable of float or double. @param record from 0; of no meaning for others
  /// @throws FormatError (values of another type, or beyond the file's end)
  std::vector<double> read(const NetcdfVariable& variable, std::size_t record) const;

 private:
  friend class NetcdfHead;

  ByteSource source_;
  std::map<std::string, NetcdfVariable> variables_;
  bool names_records_ = true;  // false of a file that is written as a stream
  std::uint64_t n_promised_ = 0, n_there_ = 0;
  std::uint64_t first_record_ = std::numeric_limits<std::uint64_t>::max(), n_record_bytes_ = 0;
  std::size_t n_records_ = 0;
};

}  // namespace espdiff
