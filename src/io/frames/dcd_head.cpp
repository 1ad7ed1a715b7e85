// dcd_head.cpp: FORTRAN records, each between two marks of its length: "CORD" and 20 numbers, titles, number of atoms.
#include "io/frames/dcd_head.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "base/error.h"
#include "system/open_file.h"

namespace espdiff {
namespace {

constexpr std::uint64_t kFirstRecord = 84;
// Places among the 20 numbers.
constexpr std::size_t kFrames = 0, kFixedAtoms = 8, kHasCell = 10, kHasFourth = 11, kCharmmVersion = 19;

/// Reads records from the front of a file.
class DcdReader {
 public:
  DcdReader(const OpenFile& file, const std::string& path) : file_(file), path_(path), n_bytes_(file.size()) {}

  /// Whether it begins with a record of 84 bytes that begin with CORD; finds the order and the size of its marks.
  bool begins_as_dcd() {
    std::array<unsigned char, 12> head{};
    if (file_.read_at(0, head.data(), head.size()) != 0) return false;
    for (const std::size_t mark : {std::size_t{4}, std::size_t{8}}) {
      for (const bool is_swapped : {false, true}) {
        mark_ = mark;
        is_swapped_ = is_swapped;
        if (number(head.data(), mark) != kFirstRecord) continue;
        std::array<char, 4> word{};
        if (file_.read_at(mark, word.data(), word.size()) == 0 && std::memcmp(word.data(), "CORD", 4) == 0) return true;
      }
    }
    return false;
  }

  /// The content of the next record, of at most `most` bytes. @throws FormatError
  std::string record(std::uint64_t most) {
    std::array<unsigned char, 8> before{}, after{};
    read(before.data(), mark_);
    const std::uint64_t n = number(before.data(), mark_);
    if (n > most)
      fail("has a record of " + std::to_string(n) + " bytes where at most " + std::to_string(most) + " are");
    std::string content(static_cast<std::size_t>(n), '\0');
    read(content.data(), content.size());
    read(after.data(), mark_);
    if (number(after.data(), mark_) != n) fail("has a record whose two lengths differ");
    return content;
  }
  void skip_record() {
    std::array<unsigned char, 8> mark{};
    read(mark.data(), mark_);
    at_ += number(mark.data(), mark_) + mark_;
  }

  std::int64_t integer(const std::string& record, std::size_t index) const {
    if (4 * index + 4 > record.size()) return 0;
    const std::uint64_t bits = number(reinterpret_cast<const unsigned char*>(record.data()) + 4 * index, 4);
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits));
  }

  std::uint64_t at() const { return at_; }
  std::size_t mark_bytes() const { return mark_; }
  bool is_swapped() const { return is_swapped_; }
  std::uint64_t n_left() const { return n_bytes_ > at_ ? n_bytes_ - at_ : 0; }
  /// Bytes of a record with its marks.
  std::uint64_t with_marks(std::uint64_t n) const { return n + 2 * mark_; }
  [[noreturn]] void fail(const std::string& what) const {
    throw FormatError(path_, 0, "the head of this DCD " + what + "; copy or write the file again");
  }

 private:
  void read(void* bytes, std::size_t n) {
    if (n_left() < n || file_.read_at(at_, bytes, n) != 0) fail("is cut off");
    at_ += n;
  }
  std::uint64_t number(const unsigned char* bytes, std::size_t n) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < n; ++i) value = value << 8U | bytes[is_swapped_ ? i : n - 1 - i];
    return value;
  }

  const OpenFile& file_;
  const std::string& path_;
  std::uint64_t n_bytes_, at_ = 0;
  std::size_t mark_ = 4;
  bool is_swapped_ = false;
};

/// From 0; the file counts from 1.
std::vector<std::size_t> moving_atoms(DcdReader& reader, std::int64_t n_atoms, std::int64_t n_fixed) {
  const std::string numbers = reader.record(4 * static_cast<std::uint64_t>(n_atoms));
  std::vector<std::size_t> moving;
  for (std::int64_t i = 0; i < n_atoms - n_fixed; ++i) {
    const std::int64_t atom = reader.integer(numbers, static_cast<std::size_t>(i));
    if (atom < 1 || atom > n_atoms) reader.fail("lists the moving atom " + std::to_string(atom));
    moving.push_back(static_cast<std::size_t>(atom - 1));
  }
  return moving;
}

}  // namespace

std::string DcdHead::missing() const {
  if (n_rest > 0)
    return "is cut off in frame " + std::to_string(n_whole) + " (" + std::to_string(n_rest) + " of " +
           std::to_string(n_frame) + " bytes)" +
           (n_promised > n_whole ? ", and its head promises " + std::to_string(n_promised) + " frames" : "");
  if (n_promised <= n_whole) return {};
  return "holds " + std::to_string(n_whole) + " of the " + std::to_string(n_promised) +
         " frames that its head promises: it is cut off, or its run ended early";
}

std::optional<DcdHead> read_dcd_head(const std::string& path) {
  const OpenFile file(path, FileAccess::kReadPipe);
  if (!file) return std::nullopt;
  DcdReader reader(file, path);
  if (!reader.begins_as_dcd()) return std::nullopt;
  const std::string numbers = reader.record(kFirstRecord).substr(4);
  reader.skip_record();  // titles
  DcdHead head;
  head.n_atoms = reader.integer(reader.record(4), 0);
  head.n_promised = std::max<std::int64_t>(0, reader.integer(numbers, kFrames));
  const std::int64_t n_fixed = reader.integer(numbers, kFixedAtoms);
  if (head.n_atoms <= 0 || n_fixed < 0 || n_fixed >= head.n_atoms)
    reader.fail("has " + std::to_string(head.n_atoms) + " atoms, of which " + std::to_string(n_fixed) + " are fixed");
  if (n_fixed > 0) head.moving = moving_atoms(reader, head.n_atoms, n_fixed);
  const bool is_charmm = reader.integer(numbers, kCharmmVersion) != 0;
  const bool has_cell = is_charmm && reader.integer(numbers, kHasCell) != 0;
  const std::uint64_t n_records = is_charmm && reader.integer(numbers, kHasFourth) != 0 ? 4 : 3;
  const auto frame_of = [&](std::int64_t n_atoms) {
    return (has_cell ? reader.with_marks(6 * sizeof(double)) : 0) +
           n_records * reader.with_marks(sizeof(float) * static_cast<std::uint64_t>(n_atoms));
  };
  const std::uint64_t n_first = frame_of(head.n_atoms), n_left = reader.n_left();
  head.begin = reader.at();
  head.n_first = n_first;
  head.mark_bytes = reader.mark_bytes();
  head.is_swapped = reader.is_swapped();
  head.has_cell = has_cell;
  head.n_fixed = n_fixed;
  head.n_frame = n_left < n_first ? n_first : frame_of(head.n_atoms - n_fixed);
  if (n_left < n_first) {
    head.n_rest = n_left;
    return head;
  }
  head.n_whole = 1 + static_cast<std::int64_t>((n_left - n_first) / head.n_frame);
  head.n_rest = (n_left - n_first) % head.n_frame;
  return head;
}

}  // namespace espdiff
