// vtk_xml.h: VTK's XML files (VTI, VTP): the head, the elements, and the numbers of their arrays.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/read_input.h"
#include "io/text/xml_text.h"
#include "io/vtk/vtk_encoding.h"

namespace espdiff {

/// A VTK XML file in memory. Reads ascii, inline base64 and appended arrays (raw or base64), uncompressed or by zlib,
/// with lengths of 32 or 64 bits, in either byte order, of any number type: what VTK and ParaView write but for their
/// compressors LZ4 and LZMA. Every attribute that counts is checked, and nothing is allocated that the file cannot
/// fill. VTK's own reader is not used: it divides by lengths of the file, and takes the process with it.
class VtkXmlFile {
 public:
  /// Reads and parses the file. `type` is the data set: "ImageData".
  /// @throws FormatError (damaged, cut short), InputError (another data set, an unknown compressor), IoError,
  /// MemoryError
  VtkXmlFile(const std::string& path, const std::string& type) : VtkXmlFile(read_input(path), type) {}
  /// The same of what was read before.
  VtkXmlFile(FileContent file, const std::string& type);
  VtkXmlFile(const VtkXmlFile&) = delete;
  VtkXmlFile& operator=(const VtkXmlFile&) = delete;

  const std::string& path() const { return path_; }
  /// The element of the data set.
  const XmlElement& data_set() const { return *data_set_; }
  std::size_t n_bytes() const { return bytes_.size(); }

  /// The attribute. @throws FormatError where there is none
  const std::string& require(const XmlElement& element, const char* name) const;
  /// Exactly `n` finite numbers of an attribute, separated by blanks. @throws FormatError
  std::vector<double> numbers(const XmlElement& element, const char* name, std::size_t n) const;
  /// Exactly `n` integers. @throws FormatError
  std::vector<long long> integers(const XmlElement& element, const char* name, std::size_t n) const;
  /// Numbers a tuple of an array: NumberOfComponents, 1 where it is absent. @throws FormatError unless 1 to 1000
  int n_components(const XmlElement& array) const;

  /// Hands on the `n` numbers of an array, in order: take(index, value). Integers beyond 2^53 lose their last digits;
  /// values may be NaN or infinite where the array's type has them.
  /// @throws FormatError (another number of values, an unknown type, damage), MemoryError
  void read_values(const XmlElement& array, std::size_t n, const std::function<void(std::size_t, double)>& take) const;

  /// The first text of an array of type String; empty where it has none. @throws FormatError
  std::string read_text(const XmlElement& array) const;

  /// @throws FormatError at the element's line
  [[noreturn]] void fail(const XmlElement& element, const std::string& problem) const;

 private:
  void read_head(const std::string& type);
  void read_ascii(const XmlElement& array, std::size_t n, const std::function<void(std::size_t, double)>& take) const;
  std::string_view binary_bytes(const XmlElement& array, std::uint64_t n_bytes, std::string& storage) const;

  std::string path_;
  std::string bytes_;
  XmlElement root_;
  const XmlElement* data_set_ = nullptr;
  const XmlElement* appended_ = nullptr;
  std::string_view appended_text_;  // behind the '_'
  bool appended_is_base64_ = false;
  bool knows_byte_order_ = false;
  VtkEncoding encoding_;
};

/// How messages name an array: "array 'phi'".
std::string array_in_words(const XmlElement& array);

}  // namespace espdiff
