// ensemble_file.cpp: frames written to their places, with a checksum after them.
#include "ensemble/file/ensemble_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "base/formatted.h"
#include "base/text/system_message.h"
#include "ensemble/file/hdf5_layout.h"
#include "ensemble/file/hdf5_reader.h"
#include "io/files/sibling_file.h"
#include "system/open_file.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNotRead = "cannot be read back as it was written; is the disk full, or damaged?";

/// Never 0, which means that a frame was not written.
/// @param trusted empty in files of earlier versions
std::uint64_t checksum(std::size_t frame, const std::vector<float>& values, const std::vector<std::uint8_t>& trusted,
                       const std::vector<double>& numbers, const std::string& note) {
  std::uint64_t sum = add_to_checksum(kChecksumStart ^ frame, values.data(), values.size() * sizeof(float));
  sum = add_to_checksum(sum, trusted.data(), trusted.size());
  sum = add_to_checksum(sum, numbers.data(), numbers.size() * sizeof(double));
  sum = add_to_checksum(sum, note.data(), note.size());
  return sum == 0 ? 1 : sum;
}

/// Far beyond what charges in a molecule give, in any unit. Not finite: no counterpart.
template <typename Number>
void check_potentials(const std::string& path, std::size_t frame, const std::vector<Number>& values) {
  constexpr double kMost = 1e9;
  for (const Number number : values) {
    const auto value = static_cast<double>(number);
    if (std::isnan(value) || std::fabs(value) <= kMost) continue;
    throw FormatError(path, 0,
                      "frame " + std::to_string(frame) + formatted(" has a value of %g", value) +
                          formatted(", and potentials are within %g; its map or charges cannot be right", kMost));
  }
}

void write_at(OpenFile& file, const std::string& path, std::uint64_t offset, const void* bytes, std::size_t n) {
  const int error = file.write_at(offset, bytes, n);
  if (error != 0) throw IoError(path, std::string("cannot be written: ") + system_message(error));
}

/// A note of exactly kNoteBytes.
std::string padded(std::string note) {
  note.resize(kNoteBytes, '\0');
  return note;
}

void extend(OpenFile& file, const std::string& path) {
  const std::uint64_t intended = intended_size(path);
  if (intended <= fs::file_size(path)) return;
  const int error = file.truncate(intended);
  if (error != 0) throw IoError(path, std::string("lost its end, and cannot be extended: ") + system_message(error));
}

IoError busy(const std::string& path) {
  return {path, "another run is writing this file; wait for its end, or name another output"};
}

/// @returns false if another run holds the lock, or has put another file in this one's place meanwhile
bool lock(OpenFile& file, const std::string& path) { return file.lock() == LockResult::kLocked && file.is_named(path); }

/// Gives a new file its name: over a file that no run writes, or where there is none. Of two runs that begin together
/// one gets the name.
void put_in_place(const std::string& temporary, const std::string& path) {
  std::error_code error;
  if (OpenFile earlier(path, FileAccess::kRead); earlier) {
    if (!lock(earlier, path)) throw busy(path);
    fs::rename(temporary, path, error);
  } else {
    fs::create_hard_link(temporary, path, error);
    if (error == std::errc::file_exists) throw busy(path);
    if (error) {
      fs::rename(temporary, path, error);  // a file system without links
    } else {
      fs::remove(temporary, error);
    }
  }
  if (error) throw IoError(path, "cannot be written: " + system_message(error.value()));
}

}  // namespace

struct EnsembleFile::Contents {
  std::string path;
  OpenFile file;
  EnsemblePlan plan;
  TemplateSurface surface;
  EnsembleLayout layout;
  std::vector<char> done;
  std::size_t n_damaged = 0;
  std::vector<std::size_t> chosen;  ///< [frame] its place in the file; see choose()

  void open(bool for_writing) {
    file = OpenFile(path, for_writing ? FileAccess::kReadWrite : FileAccess::kRead);
    if (!file) throw IoError(path, std::string("cannot be opened: ") + system_message(file.error()));
    if (for_writing && !lock(file, path)) throw busy(path);
    const bool lacks_end = intended_size(path) > fs::file_size(path);
    if (lacks_end) check_ensemble_head(file, path);  // without it nothing can be computed again
    if (lacks_end && !for_writing)
      throw FormatError(path, 0, "lost its end; " + switched_on("resume") + " computes again what is missing");
    if (for_writing) extend(file, path);
  }

  void read() {
    EnsembleContents contents = open_hdf5_file(file, path);
    plan = parse_ensemble_plan(contents.plan, path);
    layout = std::move(contents.layout);
    surface.positions = std::move(contents.positions);
    surface.normals = std::move(contents.normals);
    surface.triangles = std::move(contents.triangles);
    surface.residue = std::move(contents.residue);
    if (plan.n_frames() != layout.n_frames)
      throw FormatError(path, 0,
                        "has places for " + std::to_string(layout.n_frames) + " frames, and describes " +
                            std::to_string(plan.n_frames()) + "; it is damaged");
    for (const std::int32_t residue : surface.residue) {
      if (residue < -1 || residue >= static_cast<std::int64_t>(plan.residues.size()))
        throw FormatError(path, 0, "a vertex has a residue that the description of the run lacks; it is damaged");
    }
    check_frames();
    chosen.resize(layout.n_frames);
    std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  }

  void check_frames() {
    n_damaged = 0;
    done.assign(layout.n_frames, 0);
    std::vector<std::uint64_t> sums(layout.n_frames);
    read_file_at(file, path, layout.checksums, sums.data(), sums.size() * sizeof(std::uint64_t));
    std::vector<float> values(layout.n_vertices);
    for (std::size_t f = 0; f < layout.n_frames; ++f) {
      if (sums[f] == 0) continue;
      read_file_at(file, path, layout.values[f], values.data(), values.size() * sizeof(float));
      const std::vector<double> row = numbers(f);
      done[f] = sums[f] == checksum(f, values, trusted(f), row, note(f)) ? 1 : 0;
      if (done[f] == 0) ++n_damaged;
      if (done[f] == 0) continue;
      check_potentials(path, f, values);
      check_potentials(path, f, row);
    }
  }

  /// [vertex of `frame`, a place in the file]
  std::vector<std::uint8_t> trusted(std::size_t frame) const {
    if (layout.trusted.empty()) return {};
    std::vector<std::uint8_t> flags(layout.n_vertices);
    read_file_at(file, path, layout.trusted[frame], flags.data(), flags.size());
    return flags;
  }

  std::vector<double> numbers(std::size_t frame) const {
    std::vector<double> row(frame_columns().size());
    read_file_at(file, path, layout.numbers + frame * row.size() * sizeof(double), row.data(),
                 row.size() * sizeof(double));
    return row;
  }
  std::string note(std::size_t frame) const {
    std::string text(kNoteBytes, '\0');
    read_file_at(file, path, layout.notes + frame * kNoteBytes, text.data(), kNoteBytes);
    return text;
  }

  /// @param flags as trusted()
  void write(std::size_t frame, const std::vector<float>& values, std::vector<std::uint8_t> flags,
             const std::vector<double>& row, const std::string& text) {
    check_potentials(path, frame, values);
    check_potentials(path, frame, row);
    flags.resize(layout.trusted.empty() ? 0 : values.size(), 1);
    const std::uint64_t none = 0, sum = checksum(frame, values, flags, row, text);
    const std::uint64_t place = layout.checksums + frame * sizeof sum;
    write_at(file, path, place, &none, sizeof none);
    write_at(file, path, layout.values[frame], values.data(), values.size() * sizeof(float));
    if (!flags.empty()) write_at(file, path, layout.trusted[frame], flags.data(), flags.size());
    write_at(file, path, layout.numbers + frame * row.size() * sizeof(double), row.data(), row.size() * sizeof(double));
    write_at(file, path, layout.notes + frame * kNoteBytes, text.data(), text.size());
    write_at(file, path, place, &sum, sizeof sum);
    done[frame] = 1;
  }
};

void EnsembleFile::create(const std::string& path, const EnsemblePlan& plan, const TemplateSurface& surface,
                          const std::function<void(EnsembleFile&)>& fill) {
  const std::string target = followed_links(path);
  std::string temporary;
  EnsembleFile made;
  Contents& contents = *made.contents_;
  contents.path = path;
  contents.file = make_sibling(target, temporary);
  if (!contents.file) throw IoError(path, "cannot be written: " + system_message(contents.file.error()));
  try {
    const std::string own = contents.file.own_path();
    make_hdf5_file(contents.file, fs::exists(own) ? own : temporary, path, plan_text(plan), surface,
                   plan.potential_unit, plan.n_frames());
    contents.read();
    if (fill) {
      fill(made);
      contents.check_frames();
      if (contents.n_damaged > 0) throw IoError(path, kNotRead);
    }
    made.finish();
    put_in_place(temporary, target);
  } catch (const FormatError&) {
    std::remove(temporary.c_str());
    throw IoError(path, kNotRead);
  } catch (...) {
    std::remove(temporary.c_str());
    throw;
  }
}

EnsembleFile::EnsembleFile() : contents_(new Contents) {}
EnsembleFile::EnsembleFile(const std::string& path, bool for_writing) : EnsembleFile() {
  contents_->path = path;
  contents_->open(for_writing);
  contents_->read();
}
EnsembleFile::EnsembleFile(EnsembleFile&&) noexcept = default;
EnsembleFile::~EnsembleFile() = default;

const std::string& EnsembleFile::path() const { return contents_->path; }
const EnsemblePlan& EnsembleFile::plan() const { return contents_->plan; }
const TemplateSurface& EnsembleFile::surface() const { return contents_->surface; }
std::size_t EnsembleFile::n_vertices() const { return contents_->layout.n_vertices; }
bool EnsembleFile::has(std::size_t frame) const { return contents_->done.at(contents_->chosen.at(frame)) != 0; }
bool EnsembleFile::has_trust() const { return !contents_->layout.trusted.empty(); }
std::size_t EnsembleFile::n_damaged() const { return contents_->n_damaged; }
std::size_t EnsembleFile::n_done() const {
  const auto& chosen = contents_->chosen;
  return static_cast<std::size_t>(
      std::count_if(chosen.begin(), chosen.end(), [this](std::size_t f) { return contents_->done[f] == 1; }));
}

void EnsembleFile::finish() {
  const int error = contents_->file.close();
  if (error != 0) throw IoError(path(), "cannot be written: " + system_message(error));
}

void EnsembleFile::write(std::size_t frame, const std::vector<float>& values, const EnsembleFrame& n,
                         const std::vector<std::uint8_t>& trusted) {
  const std::vector<double> row = {
      n.rmsd_A,         n.unmatched_template,     n.unmatched_frame, n.distance_A, n.same_residue_area_fraction,
      n.mean_potential, n.trustworthy ? 1.0 : 0.0};
  contents_->write(frame, values, trusted, row, padded(n.note));
}

EnsembleFrame EnsembleFile::numbers(std::size_t frame) const {
  const std::size_t place = contents_->chosen.at(frame);
  const std::vector<double> row = contents_->numbers(place);
  const std::string note = contents_->note(place);
  return {row[0], row[1], row[2], row[3], row[4], row[5], row[6] != 0, note.substr(0, note.find('\0'))};
}

void EnsembleFile::read_values(std::size_t frame, std::size_t begin, std::size_t end, float* values) const {
  read_all_values(frame, begin, end, values);
  if (contents_->layout.trusted.empty()) return;
  std::vector<std::uint8_t> trusted(end - begin);
  read_file_at(contents_->file, contents_->path, contents_->layout.trusted[contents_->chosen[frame]] + begin,
               trusted.data(), trusted.size());
  for (std::size_t v = 0; v < trusted.size(); ++v)
    if (trusted[v] == 0) values[v] = std::numeric_limits<float>::quiet_NaN();
}

void EnsembleFile::read_all_values(std::size_t frame, std::size_t begin, std::size_t end, float* values) const {
  read_file_at(contents_->file, contents_->path,
               contents_->layout.values[contents_->chosen[frame]] + begin * sizeof(float), values,
               (end - begin) * sizeof(float));
}

void EnsembleFile::choose(EnsemblePlan plan, std::vector<std::size_t> frames) {
  contents_->plan = std::move(plan);
  contents_->chosen = std::move(frames);
}

std::size_t EnsembleFile::place_in_run(std::size_t frame) const {
  return contents_->chosen.empty() ? frame : contents_->chosen.at(frame);
}

void EnsembleFile::copy(std::size_t frame, const EnsembleFile& from) {
  std::vector<float> values(n_vertices());
  from.read_all_values(frame, 0, n_vertices(), values.data());
  contents_->write(frame, values, from.contents_->trusted(frame), from.contents_->numbers(frame),
                   from.contents_->note(frame));
}

bool is_hdf5_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  char head[8] = {};
  return in.read(head, sizeof head) && std::memcmp(head, "\x89HDF\r\n\x1a\n", sizeof head) == 0;
}

}  // namespace espdiff
