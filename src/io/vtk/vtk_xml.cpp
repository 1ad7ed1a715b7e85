// vtk_xml.cpp: checks the head of a VTK XML file and decodes its arrays.
#include "io/vtk/vtk_xml.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "base/error.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

enum class NumberKind { kSigned, kUnsigned, kReal };

struct NumberType {
  std::string_view name;
  NumberKind kind;
  std::size_t n_bytes;
};

constexpr std::array<NumberType, 10> kTypes = {{{"Int8", NumberKind::kSigned, 1},
                                                {"UInt8", NumberKind::kUnsigned, 1},
                                                {"Int16", NumberKind::kSigned, 2},
                                                {"UInt16", NumberKind::kUnsigned, 2},
                                                {"Int32", NumberKind::kSigned, 4},
                                                {"UInt32", NumberKind::kUnsigned, 4},
                                                {"Int64", NumberKind::kSigned, 8},
                                                {"UInt64", NumberKind::kUnsigned, 8},
                                                {"Float32", NumberKind::kReal, 4},
                                                {"Float64", NumberKind::kReal, 8}}};

double number_of(std::uint64_t bits, const NumberType& type) {
  if (type.kind == NumberKind::kReal) {
    double number = 0;
    if (type.n_bytes == sizeof number) {
      std::memcpy(&number, &bits, sizeof number);
      return number;
    }
    const auto short_bits = static_cast<std::uint32_t>(bits);
    float value = 0;
    std::memcpy(&value, &short_bits, sizeof value);
    return static_cast<double>(value);
  }
  const unsigned n_bits = 8 * static_cast<unsigned>(type.n_bytes);
  const bool is_negative = type.kind == NumberKind::kSigned && (bits >> (n_bits - 1) & 1U) != 0;
  if (!is_negative) return static_cast<double>(bits);
  const std::uint64_t all = n_bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << n_bits) - 1;
  return -static_cast<double>((~bits & all)) - 1;
}

/// Whether an integer of this type can have the value, which was read from text.
bool fits(double value, const NumberType& type) {
  if (type.kind == NumberKind::kReal) return true;
  const int n_bits = 8 * static_cast<int>(type.n_bytes);
  const bool is_signed = type.kind == NumberKind::kSigned;
  const double most = std::ldexp(1.0, is_signed ? n_bits - 1 : n_bits);
  return value == std::floor(value) && value < most && value >= (is_signed ? -most : 0);
}

/// "nan" and "inf" in any spelling of C's; these are what VTK writes for them in ascii.
bool parse_special(std::string_view word, double& value) {
  const std::string lower = lower_case(word);
  const bool is_negative = !lower.empty() && lower[0] == '-';
  const std::string_view bare = std::string_view(lower).substr(is_negative ? 1 : 0);
  if (bare == "nan") {
    value = std::numeric_limits<double>::quiet_NaN();
  } else if (bare == "inf" || bare == "infinity") {
    value = (is_negative ? -1 : 1) * std::numeric_limits<double>::infinity();
  } else {
    return false;
  }
  return true;
}

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r\n") == std::string_view::npos; }

}  // namespace

std::string array_in_words(const XmlElement& array) {
  const std::string* const name = array.attribute("Name");
  return "array " + in_quotes(name != nullptr ? *name : "");
}

VtkXmlFile::VtkXmlFile(FileContent file, const std::string& type)
    : path_(std::move(file.path)), bytes_(std::move(file.content)) {
  const std::size_t end = bytes_.rfind("</VTKFile>");
  if (end == std::string::npos || !is_blank(std::string_view(bytes_).substr(end + 10))) {
    throw FormatError(path_, 0,
                      "the " + std::string(type == "ImageData" ? "VTI" : "VTP") +
                          " file is cut short: it does not end with </VTKFile>; write or fetch it again");
  }
  root_ = parse_xml(bytes_, path_, "AppendedData");
  read_head(type);
}

void VtkXmlFile::fail(const XmlElement& element, const std::string& problem) const {
  throw FormatError(path_, element.line, problem + "; write or fetch the file again");
}

void VtkXmlFile::read_head(const std::string& type) {
  if (root_.name != "VTKFile") fail(root_, "the root element is <" + root_.name + ">, but <VTKFile> was expected");
  const std::string& found = require(root_, "type");
  if (found != type)
    throw InputError(path_ + ": is a VTK file of type " + in_quotes(found) + ", but " + type + " was expected");
  data_set_ = root_.child(type);
  if (data_set_ == nullptr) fail(root_, "there is no element <" + type + ">");

  if (const std::string* order = root_.attribute("byte_order")) {
    if (*order != "LittleEndian" && *order != "BigEndian")
      fail(root_, "byte_order is " + in_quotes(*order) + ", but LittleEndian or BigEndian was expected");
    encoding_.big_endian = *order == "BigEndian";
    knows_byte_order_ = true;
  }
  if (const std::string* header = root_.attribute("header_type")) {
    if (*header != "UInt32" && *header != "UInt64")
      fail(root_, "header_type is " + in_quotes(*header) + ", but UInt32 or UInt64 was expected");
    encoding_.long_headers = *header == "UInt64";
  }
  if (const std::string* compressor = root_.attribute("compressor")) {
    if (*compressor != "vtkZLibDataCompressor")
      throw InputError(path_ + ": is compressed by " + in_quotes(*compressor) +
                       ", and only vtkZLibDataCompressor can be read; save it with compressor ZLib or without");
    encoding_.compressed = true;
  }
  appended_ = root_.child("AppendedData");
  if (appended_ == nullptr) return;
  const std::string& encoding = require(*appended_, "encoding");
  if (encoding != "raw" && encoding != "base64")
    fail(*appended_,
         "the encoding of the appended data is " + in_quotes(encoding) + ", but raw or base64 was expected");
  appended_is_base64_ = encoding == "base64";
  appended_text_ = appended_->text;
  if (!appended_is_base64_) return;
  const std::size_t mark = appended_text_.find_first_not_of(" \t\r\n");
  if (mark == std::string_view::npos || appended_text_[mark] != '_')
    fail(*appended_, "the appended data do not begin with '_'");
  appended_text_.remove_prefix(mark + 1);
}

const std::string& VtkXmlFile::require(const XmlElement& element, const char* name) const {
  const std::string* const value = element.attribute(name);
  if (value == nullptr) fail(element, "<" + element.name + "> has no attribute " + name);
  return *value;
}

std::vector<double> VtkXmlFile::numbers(const XmlElement& element, const char* name, std::size_t n) const {
  const std::string& text = require(element, name);
  std::vector<double> values;
  for (const std::string_view word : split_words(text)) {
    double value = 0;
    if (!parse_number(word, value)) break;
    values.push_back(value);
  }
  if (values.size() == n && split_words(text).size() == n) return values;
  fail(element, std::string(name) + " is " + in_quotes(text) + ", but " + std::to_string(n) +
                    " finite numbers, separated by blanks, were expected");
}

std::vector<long long> VtkXmlFile::integers(const XmlElement& element, const char* name, std::size_t n) const {
  constexpr long long kMost = std::numeric_limits<std::int32_t>::max();
  const std::string& text = require(element, name);
  std::vector<long long> values;
  for (const std::string_view word : split_words(text)) {
    long long value = 0;
    if (!parse_integer(word, value) || value > kMost || value < -kMost) break;
    values.push_back(value);
  }
  if (values.size() == n && split_words(text).size() == n) return values;
  fail(element, std::string(name) + " is " + in_quotes(text) + ", but " + std::to_string(n) +
                    (n == 1 ? " integer" : " integers, separated by blanks,") + " below 2^31 in size " +
                    (n == 1 ? "was" : "were") + " expected");
}

int VtkXmlFile::n_components(const XmlElement& array) const {
  constexpr long long kMost = 1000;
  if (array.attribute("NumberOfComponents") == nullptr) return 1;
  const long long n = integers(array, "NumberOfComponents", 1).front();
  if (n < 1 || n > kMost) fail(array, "NumberOfComponents is " + std::to_string(n) + ", but 1 to 1000 was expected");
  return static_cast<int>(n);
}

void VtkXmlFile::read_ascii(const XmlElement& array, std::size_t n,
                            const std::function<void(std::size_t, double)>& take) const {
  const std::string& type_name = require(array, "type");
  const auto& type =
      *std::find_if(kTypes.begin(), kTypes.end(), [&](const NumberType& t) { return t.name == type_name; });
  TextCursor cursor(array.text, path_);
  const auto fail_here = [&](const std::string& problem) {
    throw FormatError(path_, array.line + cursor.line() - 1, problem + "; write or fetch the file again");
  };
  for (std::size_t i = 0; i < n; ++i) {
    double value = 0;
    if (!cursor.try_number(value)) {
      const std::string_view word = cursor.next_word();
      if (word.empty())
        fail_here(array_in_words(array) + " has " + std::to_string(i) +
                  " values, but its type and the number of points ask for " + std::to_string(n));
      if (type.kind != NumberKind::kReal || !parse_special(word, value))
        fail_here("value " + std::to_string(i + 1) + " of " + array_in_words(array) + " is " + in_quotes(word) +
                  ", but a number was expected");
    }
    if (!fits(value, type))
      fail_here("value " + std::to_string(i + 1) + " of " + array_in_words(array) + " is no " + type_name);
    // Written with as few digits as identify a float, the number is that float, not the nearest double.
    const bool is_float = type.kind == NumberKind::kReal && type.n_bytes == 4;
    take(i, is_float ? static_cast<double>(static_cast<float>(value)) : value);
  }
  if (!cursor.at_end()) {
    cursor.next_word();
    fail_here(array_in_words(array) + " has more than the " + std::to_string(n) +
              " values that its type and the number of points ask for");
  }
}

/// The bytes of an array that is not ascii.
std::string_view VtkXmlFile::binary_bytes(const XmlElement& array, std::uint64_t n_bytes, std::string& storage) const {
  if (!knows_byte_order_) fail(root_, "<VTKFile> has no attribute byte_order, which binary values need");
  const std::string* const format = array.attribute("format");
  std::size_t n_read = 0;
  if (format != nullptr && *format == "appended") {
    const std::string& text = require(array, "offset");
    long long offset = 0;
    if (appended_ == nullptr)
      fail(array, array_in_words(array) + " refers to appended data, which the file has none of");
    if (!parse_integer(text, offset) || offset < 0 || static_cast<std::uint64_t>(offset) > appended_text_.size())
      fail(array, "the offset of " + array_in_words(array) + " is " + in_quotes(text) +
                      ", but the appended data have " + std::to_string(appended_text_.size()) + " bytes");
    return decode_array(appended_text_.substr(static_cast<std::size_t>(offset)), appended_is_base64_, encoding_,
                        n_bytes, storage, n_read, path_, array.line, array_in_words(array));
  }
  std::string_view text = array.text;
  text.remove_prefix(std::min(text.size(), text.find_first_not_of(" \t\r\n")));
  const std::string_view bytes =
      decode_array(text, true, encoding_, n_bytes, storage, n_read, path_, array.line, array_in_words(array));
  if (!is_blank(text.substr(n_read)))
    fail(array, array_in_words(array) + " has more characters than its type and the number of points ask for");
  return bytes;
}

void VtkXmlFile::read_values(const XmlElement& array, std::size_t n,
                             const std::function<void(std::size_t, double)>& take) const {
  const std::string& type_name = require(array, "type");
  const auto type =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const NumberType& t) { return t.name == type_name; });
  if (type == kTypes.end())
    fail(array, "the type of " + array_in_words(array) + " is " + in_quotes(type_name) +
                    ", but a number type such as Float32 was expected");
  const std::string* const format = array.attribute("format");
  if (format != nullptr && *format != "ascii" && *format != "binary" && *format != "appended")
    fail(array, "the format of " + array_in_words(array) + " is " + in_quotes(*format) +
                    ", but ascii, binary or appended was expected");
  if (format == nullptr || *format == "ascii") return read_ascii(array, n, take);
  if (n == 0) return;
  std::string storage;
  const std::string_view bytes = binary_bytes(array, n * type->n_bytes, storage);
  for (std::size_t i = 0; i < n; ++i) {
    take(i, number_of(load_unsigned(bytes.data() + i * type->n_bytes, type->n_bytes, encoding_.big_endian), *type));
  }
}

std::string VtkXmlFile::read_text(const XmlElement& array) const {
  constexpr std::size_t kLongest = 10'000;
  std::string text;
  const std::string* const format = array.attribute("format");
  if (format != nullptr && *format != "ascii") {
    const std::string_view bytes = binary_bytes(array, kAnyLength, text);
    return std::string(bytes.substr(0, std::min({bytes.find('\0'), bytes.size(), kLongest})));
  }
  TextCursor cursor(array.text, path_);
  while (!cursor.at_end() && text.size() < kLongest) {
    const std::string_view word = cursor.next_word();
    long long code = 0;
    if (!parse_integer(word, code) || code < 0 || code > 255)
      fail(array,
           "the text of " + array_in_words(array) + " has " + in_quotes(word) + ", but character codes were expected");
    if (code == 0) break;
    text += static_cast<char>(static_cast<unsigned char>(code));
  }
  return text;
}

}  // namespace espdiff
