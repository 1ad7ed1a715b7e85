// series_file.cpp: the state of a series as a file.
#include "pipeline/series_file.h"

#include <cstring>
#include <fstream>
#include <iterator>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/sha256.h"

namespace espdiff {
namespace {

constexpr const char* kTag = "espdiff series state 1\n";
constexpr std::size_t kHashDigits = 64;

template <typename T>
void append(std::string& bytes, const T* values, std::size_t n) {
  bytes.append(reinterpret_cast<const char*>(values), n * sizeof(T));
}

/// Takes values off the front of what is left of a file.
class Reader {
 public:
  Reader(const std::string& path, const std::string& bytes) : path_(path), bytes_(bytes) {}

  template <typename T>
  std::vector<T> take(std::size_t n) {
    if (n > (bytes_.size() - at_) / sizeof(T)) throw damaged(path_);
    std::vector<T> values(n);
    if (n > 0) std::memcpy(values.data(), bytes_.data() + at_, n * sizeof(T));
    at_ += n * sizeof(T);
    return values;
  }
  std::size_t take_count() { return static_cast<std::size_t>(take<std::uint64_t>(1)[0]); }
  bool at_end() const { return at_ == bytes_.size(); }

  static FormatError damaged(const std::string& path) {
    return FormatError(path, 0, "the saved state is damaged or cut off; delete it, and the run starts from the source");
  }

 private:
  const std::string& path_;
  const std::string& bytes_;
  std::size_t at_ = 0;
};

}  // namespace

void write_series_state(const std::string& path, const SeriesState& state, const std::string& fingerprint) {
  std::string bytes = kTag + fingerprint + '\n';
  const std::uint64_t counts[] = {state.mapped.size(), state.target.size()};
  append(bytes, counts, 2);
  append(bytes, state.mapped.data(), state.mapped.size());
  append(bytes, state.target.data(), state.target.size());
  AtomicFile file(path);
  file.stream() << bytes << sha256_of(bytes);
  file.commit();
}

SeriesState read_series_state(const std::string& path, const std::string& fingerprint) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(path, "cannot be read; without it the run starts from the source");
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (bytes.size() < kHashDigits) throw Reader::damaged(path);
  const std::string hash = bytes.substr(bytes.size() - kHashDigits);
  bytes.resize(bytes.size() - kHashDigits);
  if (sha256_of(bytes) != hash || bytes.compare(0, std::strlen(kTag), kTag) != 0) throw Reader::damaged(path);

  const std::size_t line = std::strlen(kTag), end = bytes.find('\n', line);
  if (end == std::string::npos) throw Reader::damaged(path);
  const std::string found = bytes.substr(line, end - line);
  if (found != fingerprint)
    throw InputError(path + ": the saved state is of another run (" + found + " instead of " + fingerprint +
                     "); delete it, and the run starts from the source");
  const std::string rest = bytes.substr(end + 1);
  Reader reader(path, rest);
  SeriesState state;
  const std::size_t n_vertices = reader.take_count(), n_atoms = reader.take_count();
  state.mapped = reader.take<Vec3f>(n_vertices);
  state.target = reader.take<Vec3d>(n_atoms);
  if (!reader.at_end()) throw Reader::damaged(path);
  return state;
}

}  // namespace espdiff
