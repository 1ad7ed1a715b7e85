// netcdf_file.cpp: the head's lists of dimensions, attributes and variables; numbers in big-endian order.
#include "io/structures/netcdf_file.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include "base/error.h"
#include "io/files/read_input.h"
#include "system/open_file.h"

namespace espdiff {
namespace {

constexpr std::uint32_t kDimensions = 10, kVariables = 11, kAttributes = 12;
constexpr int kTextType = 2, kFloatType = 5, kDoubleType = 6;
constexpr std::uint64_t kPadding = 4;

std::uint64_t padded(std::uint64_t n) { return (n + kPadding - 1) / kPadding * kPadding; }

/// Bytes of a value; 0 for an unknown type.
std::uint64_t bytes_of_type(int type) {
  constexpr std::uint64_t kBytes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
  return type >= 0 && type < static_cast<int>(std::size(kBytes)) ? kBytes[type] : 0;
}

template <typename T>
T number_at(const char* bytes) {
  char turned[sizeof(T)];
  std::reverse_copy(bytes, bytes + sizeof(T), turned);
  T value;
  std::memcpy(&value, turned, sizeof(T));
  return value;
}

}  // namespace

ByteSource bytes_of_file(const std::string& path) {
  require_regular_file(path);
  const auto file = std::make_shared<OpenFile>(path, FileAccess::kReadPipe);
  if (!*file) throw IoError(path, "cannot be read; check its permissions");
  return {path, file->size(),
          [file](std::uint64_t at, char* bytes, std::size_t n) { return file->read_at(at, bytes, n) == 0; }};
}

ByteSource bytes_of_text(const std::string& path, std::string content) {
  const auto text = std::make_shared<const std::string>(std::move(content));
  return {path, text->size(), [text](std::uint64_t at, char* bytes, std::size_t n) {
            if (at > text->size() || n > text->size() - at) return false;
            text->copy(bytes, n, static_cast<std::size_t>(at));
            return true;
          }};
}

std::size_t NetcdfVariable::n_values() const {
  std::size_t n = 1;
  for (const std::size_t length : lengths) n *= length;
  return n;
}

/// Reads the head from its front.
class NetcdfHead {
 public:
  explicit NetcdfHead(NetcdfFile& file) : file_(file), source_(file.source_) {}

  void read() {
    char mark[4];
    take(mark, sizeof mark);
    version_ = mark[3];
    if (std::memcmp(mark, "CDF", 3) != 0 || (version_ != 1 && version_ != 2 && version_ != 5))
      fail("this does not begin as a classic NetCDF file");
    file_.n_promised_ = size();
    file_.names_records_ = file_.n_promised_ != (version_ == 5 ? std::numeric_limits<std::uint64_t>::max()
                                                               : std::numeric_limits<std::uint32_t>::max());
    for (std::uint64_t n = list(kDimensions); n > 0; --n) {
      name();
      dimensions_.push_back(size());
    }
    attributes();
    for (std::uint64_t n = list(kVariables); n > 0; --n) variable();
    if (n_record_variables_ == 1) file_.n_record_bytes_ = only_record_bytes_;  // is not padded then
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw FormatError(source_.path, 0, what + "; copy or write the file again");
  }

  void take(char* bytes, std::size_t n) {
    if (!source_.read(at_, bytes, n)) fail("the head of this NetCDF file is cut off");
    at_ += n;
  }
  template <typename T>
  T number() {
    char bytes[sizeof(T)];
    take(bytes, sizeof(T));
    return number_at<T>(bytes);
  }
  /// A number whose width depends on the version.
  std::uint64_t size() { return version_ == 5 ? number<std::uint64_t>() : number<std::uint32_t>(); }

  /// The number of a list's entries.
  std::uint64_t list(std::uint32_t mark) {
    constexpr std::uint64_t kMost = 100'000;  // entries
    const std::uint32_t found = number<std::uint32_t>();
    const std::uint64_t n = size();
    if ((found != mark && (found != 0 || n != 0)) || n > kMost) fail("the head of this NetCDF file is damaged");
    return n;
  }

  std::string text(std::uint64_t n) {
    constexpr std::uint64_t kMost = 1 << 20;
    if (n > kMost || n > source_.n_bytes) fail("the head of this NetCDF file is damaged");
    std::string text(static_cast<std::size_t>(padded(n)), '\0');
    take(text.data(), text.size());
    text.resize(static_cast<std::size_t>(n));
    return text;
  }
  std::string name() { return text(size()); }

  /// Those that are text.
  std::map<std::string, std::string> attributes() {
    std::map<std::string, std::string> notes;
    for (std::uint64_t n = list(kAttributes); n > 0; --n) {
      const std::string key = name();
      const int type = static_cast<int>(number<std::uint32_t>());
      const std::uint64_t n_values = size(), n_bytes = bytes_of_type(type);
      if (n_bytes == 0 || n_values > source_.n_bytes) fail("the head of this NetCDF file is damaged");
      if (type == kTextType) {
        notes[key] = text(n_values);
      } else {
        at_ += padded(n_values * n_bytes);
      }
    }
    return notes;
  }

  void variable() {
    const std::string key = name();
    NetcdfVariable variable;
    std::uint64_t n_values = 1;
    const std::uint64_t n_dimensions = size();
    for (std::uint64_t i = 0; i < n_dimensions; ++i) {
      const std::uint64_t dimension = size();
      if (dimension >= dimensions_.size() || i > dimensions_.size()) fail("the head of this NetCDF file is damaged");
      const std::uint64_t length = dimensions_[static_cast<std::size_t>(dimension)];
      if (length == 0 && i == 0) {
        variable.has_records = true;
        continue;
      }
      n_values *= std::min(length, source_.n_bytes + 1);
      if (n_values > source_.n_bytes) fail("variable " + key + " is larger than this NetCDF file");
      variable.lengths.push_back(static_cast<std::size_t>(length));
    }
    variable.notes = attributes();
    variable.type = static_cast<int>(number<std::uint32_t>());
    size();  // its bytes, which overflow for large ones
    variable.begin = version_ == 1 ? number<std::uint32_t>() : number<std::uint64_t>();
    if (variable.has_records) {
      ++n_record_variables_;
      only_record_bytes_ = n_values * bytes_of_type(variable.type);
      file_.n_record_bytes_ += padded(only_record_bytes_);
      file_.first_record_ = std::min(file_.first_record_, variable.begin);
    }
    file_.variables_.emplace(key, std::move(variable));
  }

  NetcdfFile& file_;
  const ByteSource& source_;
  int version_ = 0;
  std::uint64_t at_ = 0;
  std::vector<std::uint64_t> dimensions_;  // lengths; 0 for that of records
  std::size_t n_record_variables_ = 0;
  std::uint64_t only_record_bytes_ = 0;
};

NetcdfFile::NetcdfFile(ByteSource source) : source_(std::move(source)) {
  NetcdfHead(*this).read();
  if (n_record_bytes_ == 0 || first_record_ > source_.n_bytes) return;
  n_there_ = (source_.n_bytes - first_record_) / n_record_bytes_;
  n_records_ = static_cast<std::size_t>(names_records_ ? std::min(n_there_, n_promised_) : n_there_);
}

const NetcdfVariable* NetcdfFile::find(const std::string& name) const {
  const auto found = variables_.find(name);
  return found == variables_.end() ? nullptr : &found->second;
}

std::string NetcdfFile::missing() const {
  if (!names_records_ || n_there_ >= n_promised_) return {};
  return "holds " + std::to_string(n_there_) + " of the " + std::to_string(n_promised_) +
         " frames that its head promises: it is cut off";
}

std::vector<double> NetcdfFile::read(const NetcdfVariable& variable, std::size_t record) const {
  const auto n_bytes = static_cast<std::size_t>(bytes_of_type(variable.type));
  const std::size_t n = variable.n_values();
  if (variable.type != kFloatType && variable.type != kDoubleType)
    throw FormatError(source_.path, 0, "numbers of this NetCDF file are of another type than float and double");
  std::vector<char> bytes(n * n_bytes);
  if (!source_.read(variable.begin + (variable.has_records ? record * n_record_bytes_ : 0), bytes.data(), bytes.size()))
    throw FormatError(source_.path, 0, "this NetCDF file is cut off; copy or write it again");
  std::vector<double> values(n);
  for (std::size_t i = 0; i < n; ++i) {
    const char* const at = bytes.data() + i * n_bytes;
    values[i] = variable.type == kFloatType ? static_cast<double>(number_at<float>(at)) : number_at<double>(at);
  }
  return values;
}

}  // namespace espdiff
