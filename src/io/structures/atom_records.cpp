// atom_records.cpp: finds the models of PDB and PQR files, and tells the two formats apart.
#include "io/structures/atom_records.h"

#include <algorithm>

#include "base/error.h"
#include "base/memory.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

enum class Record { kOther, kAtom, kModel, kEndModel, kEnd };

Record record_of(std::string_view line) {
  const char initial = line.empty() ? ' ' : static_cast<char>(line[0] & ~0x20);
  if (initial != 'A' && initial != 'H' && initial != 'M' && initial != 'E') return Record::kOther;
  const std::string start = lower_case(line.substr(0, 6));
  if (start == "hetatm" || start == "atom" || start.substr(0, 5) == "atom " || start.substr(0, 5) == "atom\t") {
    return Record::kAtom;
  }
  if (start == "endmdl") return Record::kEndModel;
  const std::string_view word = trimmed(start);
  if (word == "model" || start.substr(0, 6) == "model ") return Record::kModel;
  return word == "end" || start.substr(0, 4) == "end " ? Record::kEnd : Record::kOther;
}

/// Collects lines into models while the file is read from top to bottom.
class ModelSplitter {
 public:
  explicit ModelSplitter(const std::string& path) : path_(path) {}

  void add(std::string_view line, long number, bool has_end) {
    switch (record_of(line)) {
      case Record::kAtom: add_atom({line, number, has_end}); break;
      case Record::kModel:
        models_.emplace_back();
        ++n_model_records_;
        is_open_ = is_inside_ = true;
        break;
      case Record::kEndModel: is_open_ = is_inside_ = false; break;
      case Record::kEnd:
        if (is_open_) last_end_ = number;
        is_open_ = is_inside_ = false;
        break;
      case Record::kOther: break;
    }
  }

  std::vector<AtomModel> finish() {
    // Behind the atoms, Rosetta's table of scores has a line "model 1".
    if (is_inside_ && models_.back().empty()) {
      models_.pop_back();
      --n_model_records_;
    }
    if (n_model_records_ > 0 && first_outside_ > 0) {
      throw FormatError(path_, first_outside_,
                        "an atom outside of MODEL ... ENDMDL (" + in_quotes(trimmed(first_outside_text_)) +
                            "), in a file that has MODEL records; move it into a model, or "
                            "delete the MODEL and ENDMDL lines");
    }
    if (models_.empty()) {
      throw InputError(path_ + ": has no ATOM or HETATM records; give a structure with atoms");
    }
    check_parts_around_end();
    return std::move(models_);
  }

 private:
  void add_atom(const AtomLine& atom) {
    if (!is_inside_ && first_outside_ == 0) {
      first_outside_ = atom.number;
      constexpr std::size_t kUpToResidue = 27;
      first_outside_text_ = atom.text.substr(0, kUpToResidue);
    }
    if (!is_open_) {
      if (last_end_ > 0 && split_by_end_ == 0) split_by_end_ = last_end_;
      models_.emplace_back();
      is_open_ = true;
    }
    models_.back().push_back(atom);
  }

  /// Parts of one size are frames. Parts of different size may be one molecule in pieces or several molecules: unclear.
  void check_parts_around_end() const {
    if (split_by_end_ == 0 || n_model_records_ > 0) return;
    for (const AtomModel& model : models_) {
      if (model.size() == models_.front().size()) continue;
      throw FormatError(path_, split_by_end_,
                        "atoms continue after END, and the parts differ (" + std::to_string(models_.front().size()) +
                            " and " + std::to_string(model.size()) +
                            " atoms); delete END if they are one molecule, or put them between MODEL and ENDMDL");
    }
  }

  const std::string& path_;
  std::vector<AtomModel> models_;
  int n_model_records_ = 0;
  bool is_open_ = false;    // the last model takes more atoms
  bool is_inside_ = false;  // between MODEL and its end
  long first_outside_ = 0;  // line of the first atom beside the models
  std::string_view first_outside_text_;
  long last_end_ = 0;      // line of the last END
  long split_by_end_ = 0;  // line of the first END that atoms follow
};

bool is_number(std::string_view text) {
  double value = 0;
  return parse_number(text, value);
}

/// Occupancy and B factor have two decimals each, at fixed columns.
bool has_pdb_decimals(std::string_view line) {
  const std::string_view tail = line.substr(54);
  return tail.size() >= 12 && tail[3] == '.' && tail[9] == '.';
}

/// PDB columns 31 to 54 hold three numbers, 55 to 66 two more or blanks, and 67 to 72 nothing, or behind occupancy and
/// B factor a whole number (an atomic number, as old programs write it).
bool fits_pdb(std::string_view line) {
  if (line.size() < 54) return false;
  for (std::size_t begin : {30, 38, 46}) {
    if (!is_number(trimmed(line.substr(begin, 8)))) return false;
  }
  for (std::size_t begin : {54, 60}) {
    const std::string_view field = begin < line.size() ? trimmed(line.substr(begin, 6)) : std::string_view();
    if (!field.empty() && !is_number(field)) return false;
  }
  if (line.size() < 67) return true;
  const std::string_view behind = trimmed(line.substr(66, 6));
  long long number = 0;
  return behind.empty() || (has_pdb_decimals(line) && parse_integer(behind, number));
}

/// PQR: at least name, number and five more fields, of which the last two (charge, radius) are numbers.
/// Amber writes the element behind them, as PDB files do behind numbers of two decimals.
bool fits_pqr(std::string_view line) {
  auto words = split_words(line);
  const auto has_many_decimals = [](std::string_view word) { return word.find('.') + 3 < word.size(); };
  if (words.size() > 8 && words.back().size() <= 2 && is_letter(words.back().front()) &&
      has_many_decimals(words[words.size() - 2]) && has_many_decimals(words[words.size() - 3]))
    words.pop_back();
  return words.size() >= 8 && is_number(words[words.size() - 1]) && is_number(words[words.size() - 2]);
}

bool has_pqr_name(const std::string& path) {
  const std::string lower = lower_case(path);
  return lower.find(".pqr") != std::string::npos && lower.find(".pqr") + 7 >= lower.size();  // .pqr, .pqr.gz
}

}  // namespace

std::vector<AtomModel> split_models(std::string_view text, const std::string& path) {
  // A line takes more than its bytes in the text, if it is short; the vector doubles.
  const auto n_lines = std::count(text.begin(), text.end(), '\n');
  require_memory(2.0 * sizeof(AtomLine) * static_cast<double>(n_lines), path);
  ModelSplitter splitter(path);
  long number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    splitter.add(line, ++number, end < text.size());
    begin = end + 1;
  }
  return splitter.finish();
}

const AtomModel& pick_model(const std::vector<AtomModel>& models, int number, const std::string& path) {
  if (number < 1 || static_cast<std::size_t>(number) > models.size()) {
    if (models.empty()) throw InputError(path + ": has no models; give a structure with atoms");
    throw InputError(path + ": model " + std::to_string(number) + " was asked for, but the file has models 1 to " +
                     std::to_string(models.size()));
  }
  return models[static_cast<std::size_t>(number) - 1];
}

bool looks_like_pqr(const AtomModel& model, const std::string& path) {
  constexpr std::size_t kEnoughLines = 5000;
  std::size_t only_pdb = 0, only_pqr = 0, both_as_pdb = 0, both_as_pqr = 0;
  bool negative_occupancy = false;
  for (std::size_t i = 0; i < std::min(model.size(), kEnoughLines); ++i) {
    const std::string_view line = model[i].text;
    const bool pdb = fits_pdb(line);
    const bool pqr = fits_pqr(line) && !(pdb && trimmed(line.substr(54)).empty());
    if (pdb && pqr) {
      ++(has_pdb_decimals(line) ? both_as_pdb : both_as_pqr);
      // B factors are used for any number, but an occupancy below zero is a charge.
      if (line.substr(54, 6).find('-') != std::string_view::npos) negative_occupancy = true;
    } else if (pdb || pqr) {
      ++(pdb ? only_pdb : only_pqr);
    }
  }
  if (negative_occupancy) {
    both_as_pqr += both_as_pdb;
    both_as_pdb = 0;
  }
  const bool nothing_tells = only_pdb + only_pqr + both_as_pqr == 0;
  if (nothing_tells || only_pdb + both_as_pdb == only_pqr + both_as_pqr) return has_pqr_name(path);
  return only_pqr + both_as_pqr > only_pdb + both_as_pdb;
}

}  // namespace espdiff
