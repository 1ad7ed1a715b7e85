// read_dx.cpp: header, values and trailer of OpenDX text files.
#include "io/grids/read_dx.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include "base/error.h"
#include "base/text/printable.h"
#include "io/grids/grid_checks.h"
#include "io/grids/grid_format.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

/// Reads from top to bottom; each member function consumes one part of the file.
class DxReader {
 public:
  DxReader(const std::string& path, std::string_view text) : path_(path), cursor_(text, path) { grid_.name = path; }

  Grid read() {
    while (!read_header_line()) continue;
    read_values();
    read_trailer();
    if (grid_.unit != PotentialUnit::kUnknown) grid_.contradicting_title.clear();  // a comment beside the title
    return std::move(grid_);
  }

 private:
  using Words = std::vector<std::string_view>;

  /// True when the array's values come next.
  bool read_header_line() {
    const std::string keyword = lower_case(cursor_.next_word());
    if (keyword.empty()) cursor_.fail("the file ends before its values; 'object 3 class array ...' was expected");
    if (keyword[0] == '#') {
      note_unit(cursor_.rest_of_line());
    } else if (keyword == "object") {
      return read_object(object_words());
    } else if (keyword == "origin") {
      grid_.lattice.origin = read_vector("origin");
    } else if (keyword == "delta") {
      if (n_deltas_ == 3) cursor_.fail("a fourth delta; three grid steps were expected");
      grid_.lattice.step[n_deltas_++] = read_vector("delta");
    } else if (keyword == "attribute" || keyword == "component") {
      cursor_.rest_of_line();
    } else {
      cursor_.fail("OpenDX header has " + in_quotes(keyword) + "; object, origin, delta or a comment was expected");
    }
    return false;
  }

  /// The words of an object, which may continue on the next lines.
  Words object_words() {
    constexpr int kMostLines = 20;
    Words words = split_words(cursor_.rest_of_line());
    for (int n = 0; n < kMostLines && goes_on(words); ++n) {
      const Words more = split_words(cursor_.rest_of_line());
      words.insert(words.end(), more.begin(), more.end());
    }
    return words;
  }

  /// Whether the next line belongs to an object: it lacks its class, counts or "data follows", and no other part
  /// begins.
  bool goes_on(const Words& words) {
    const std::string kind = lower_case(word_after(words, "class")), next = next_word_ahead();
    for (const char* other : {"", "origin", "delta", "object", "attribute", "component", "end"}) {
      if (next == other) return false;
    }
    if (next[0] == '#') return false;
    double number = 0;
    const std::string last = words.empty() ? std::string() : lower_case(words.back());
    const bool wants_number = last == "counts" || last == "rank" || last == "shape" || last == "items";
    if (kind == "gridpositions" || kind == "gridconnections") {
      const auto counts = std::find_if(words.begin(), words.end(), [](auto w) { return lower_case(w) == "counts"; });
      return words.end() - counts < 4;
    }
    if (kind == "array") return !has_word(words, "follows") && (wants_number || !parse_number(next, number));
    return kind.empty() && !parse_number(next, number);
  }

  /// Without moving on, also of the place that errors name.
  std::string next_word_ahead() const {
    TextCursor ahead = cursor_;
    return lower_case(ahead.next_word());
  }

  static bool has_word(const Words& words, std::string_view wanted) {
    return std::any_of(words.begin(), words.end(), [&](auto word) { return lower_case(word) == wanted; });
  }

  bool read_object(const Words& words) {
    const std::string kind = lower_case(word_after(words, "class"));
    if (kind == "gridpositions") {
      read_counts(words);
    } else if (kind == "array") {
      check_array(words);
      return true;
    } else if (kind != "gridconnections") {
      throw_input("OpenDX object of class " + in_quotes(kind) +
                  "; only regular grids (gridpositions) with one text array are read");
    }
    return false;
  }

  void read_counts(const Words& words) {
    const auto keyword =
        std::find_if(words.begin(), words.end(), [](auto word) { return lower_case(word) == "counts"; });
    std::array<long long, 3> counts{};
    if (words.end() - keyword != 4) cursor_.fail("gridpositions without three counts; 'counts nx ny nz' was expected");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string_view word = *(keyword + 1 + static_cast<std::ptrdiff_t>(axis));
      if (!parse_integer(word, counts[axis]))
        cursor_.fail("a grid count is " + in_quotes(word) + "; an integer was expected");
    }
    grid_.lattice.size = check_counts(counts, path_, cursor_.line());
  }

  /// "type double rank 0 items N data follows", with variations.
  void check_array(const Words& words) {
    array_line_ = cursor_.line();
    const std::string rank = lower_case(word_after(words, "rank"));
    const std::string shape = lower_case(word_after(words, "shape"));
    if (!rank.empty() && rank != "0" && shape != "1") {
      throw_input("the OpenDX array holds vectors (rank " + rank + "); one number a point was expected");
    }
    for (const std::string_view word : words) {
      const std::string lower = lower_case(word);
      if (lower == "binary" || lower == "ieee" || lower == "lsb" || lower == "msb" || lower == "xdr") {
        throw_input("the OpenDX values are binary; write them as text");
      }
    }
    if (words.empty() || lower_case(words.back()) != "follows") {
      throw_input("the OpenDX values are not in this file; 'data follows' was expected");
    }
    const std::size_t n_points = grid_.lattice.n_points();
    if (n_points == 0 || n_deltas_ != 3) {
      cursor_.fail(
          "values before the grid is complete; gridpositions with counts, origin and three deltas were expected first");
    }
    long long n_items = 0;
    const std::string_view items = word_after(words, "items");
    if (!parse_integer(items, n_items) || n_items < 0 || static_cast<std::size_t>(n_items) != n_points) {
      cursor_.fail("the array has " + in_quotes(items) + " items, but the grid has " + std::to_string(n_points) +
                   " points; the numbers must be equal");
    }
  }

  void read_values() {
    check_axes(grid_.lattice, path_, array_line_);
    const std::size_t n_points = grid_.lattice.n_points();
    check_size_promise(n_points, 2 * n_points - 1, cursor_.n_bytes_left(), path_, array_line_);
    allocate_values(grid_);
    const auto [nx, ny, nz] = grid_.lattice.size;
    std::size_t n_read = 0;
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < ny; ++j) {
        // z runs fastest in the file, x in memory.
        float* value = grid_.values.data() + i + static_cast<std::ptrdiff_t>(nx) * j;
        const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(nx) * ny;
        for (int k = 0; k < nz; ++k, ++n_read, value += stride) *value = read_value(n_read);
      }
    }
  }

  float read_value(std::size_t n_read) {
    float value = 0;
    if (!cursor_.try_value(value)) fail_at_value(n_read);
    return value;
  }

  [[noreturn]] void fail_at_value(std::size_t n_read) {
    const std::string_view word = cursor_.peek_word();
    const std::string lower = lower_case(word);
    if (word.empty() || word[0] == '#' || lower == "attribute" || lower == "object" || lower == "component" ||
        lower == "end") {
      cursor_.fail("only " + std::to_string(n_read) + " values were found, but 'items' promises " +
                   std::to_string(grid_.values.size()) + "; is the file cut short?");
    }
    cursor_.fail("value " + std::to_string(n_read + 1) + " is " + in_quotes(word) + "; a finite number was expected");
  }

  void read_trailer() {
    while (!cursor_.at_end()) {
      const std::string_view word = cursor_.peek_word();
      double unused = 0;
      if (parse_number(word, unused)) {
        cursor_.fail("more values than the " + std::to_string(grid_.values.size()) +
                     " that 'items' promises, the first " + in_quotes(word) + "; correct the counts or the values");
      }
      note_unit(cursor_.rest_of_line());
    }
  }

  /// The unit of a potential; or another quantity that a title names.
  void note_unit(std::string_view line) {
    if (grid_.unit == PotentialUnit::kUnknown) grid_.unit = find_potential_unit(line);
    if (grid_.contradicting_title.empty()) grid_.contradicting_title = title_of_other_quantity(line);
  }

  Vec3d read_vector(const char* what) {
    Vec3d vector;
    for (int axis = 0; axis < 3; ++axis) vector[axis] = cursor_.next_number(what);
    return vector;
  }

  static std::string_view word_after(const Words& words, std::string_view keyword) {
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
      if (lower_case(words[i]) == keyword) return words[i + 1];
    }
    return {};
  }

  [[noreturn]] void throw_input(const std::string& message) const {
    throw InputError(path_ + ":" + std::to_string(cursor_.line()) + ": " + message);
  }

  const std::string& path_;
  TextCursor cursor_;
  Grid grid_;
  std::size_t n_deltas_ = 0;
  long array_line_ = 0;
};

}  // namespace

PotentialUnit find_potential_unit(std::string_view text) {
  const std::string lower = lower_case(text);
  const std::size_t word = lower.find("potential");
  const std::size_t open = word == std::string::npos ? word : lower.find('(', word);
  if (open == std::string::npos) return PotentialUnit::kUnknown;
  std::size_t end = open + 1;
  for (int depth = 1; end < lower.size(); ++end) {
    if (lower[end] == '(') ++depth;
    if (lower[end] == ')' && --depth == 0) break;
    if (lower[end] == ',' && depth == 1) break;
  }
  try {
    return parse_potential_unit(std::string(trimmed(text.substr(open + 1, end - open - 1))));
  } catch (const InputError&) {
    return PotentialUnit::kUnknown;  // some other quantity, such as "(e/A^3)"
  }
}

std::string title_of_other_quantity(std::string_view title) {
  constexpr std::size_t kLongest = 60;
  const std::string lower = lower_case(title);
  const auto has = [&](std::string_view word) { return lower.find(word) != std::string::npos; };
  // APBS: "LAPLACIAN OF POTENTIAL (kT/e/A^2)"; Gaussian: "Electrostatic pot from Total SCF Density".
  const bool derived = has("laplacian") || has("gradient") || has("dielectric") || has("kappa");
  bool other = derived;
  for (const char* word : {"density", "charge distribution", "charge map", "accessibility", "van der waals",
                           "occupancy", "orbital", "distance", "energy"})
    other = other || (has(word) && !has("pot"));
  return other ? printable(std::string(trimmed(title.substr(0, kLongest)))) : std::string();
}

PotentialUnit potential_unit_of_file(const std::string& path) {
  constexpr int kMostLines = 100;
  constexpr std::size_t kMostCharacters = 200;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return PotentialUnit::kUnknown;  // a pipe could block
  std::ifstream in(path);
  std::string line;
  for (int n = 0; n < kMostLines && std::getline(in, line); ++n) {
    const PotentialUnit unit = find_potential_unit(std::string_view(line).substr(0, kMostCharacters));
    if (unit != PotentialUnit::kUnknown) return unit;
  }
  return PotentialUnit::kUnknown;
}

Grid read_dx(const std::string& path, std::string_view text) { return DxReader(path, text).read(); }

GridFormat dx_format() {
  return {"OpenDX", [](std::string_view, FileKind kind) { return kind == FileKind::kDx; },
          [](FileContent file, const GridOptions& /*options*/) {
            unify_line_ends(file.content);
            return read_dx(file.path, file.content);
          }};
}

}  // namespace espdiff
