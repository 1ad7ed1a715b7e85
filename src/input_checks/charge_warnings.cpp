// charge_warnings.cpp: charges that a molecule cannot have, and charges of two origins.
#include "input_checks/charge_warnings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "align/pair_residues.h"
#include "align/paired_residues.h"
#include "align/protonation.h"
#include "align/residue_charges.h"
#include "base/formatted.h"
#include "base/molecule/residue_label.h"
#include "base/text/short_numbers.h"

namespace espdiff {
namespace {

/// Backbone O and phosphate oxygens have -0.31 to -0.83 e in the force fields that PDB2PQR ships, GROMOS' included.
constexpr double kLeastOxygenCharge = 0.2, kMostOxygenCharge = 1.0;
/// Amber's files multiply charges by the square root of Coulomb's constant in kcal A/(mol e^2).
constexpr double kAmberUnit = 18.2223;
constexpr double kWholeCharge = 0.05, kSignCharge = 0.1;
/// Nucleotides of Amber are not whole at the ends of a strand: 5' and 3'.
constexpr std::array<double, 2> kStrandEndsCharge{-0.3079, -0.6921};
/// Shares of the residues from which a fault is that of the whole file. A chance fault has one residue.
constexpr double kMostWrongSigns = 0.2, kMostFractional = 0.2, kMostImpossible = 0.1;
constexpr std::size_t kLeastFaulty = 3;
/// The same residue has the same charges in one force field, to the digits that files give.
constexpr double kSameChargeLimit = 0.011, kMostOfTwoFields = 0.5, kRefusedOfTwoFieldsCharge = 0.02;
constexpr std::size_t kLeastUnchanged = 5;
constexpr double kOtherNetCharge = 0.5;
constexpr std::size_t kNamed = 3;

/// The residues of a fault: how many, and the first ones in words.
struct FaultyResidues {
  std::size_t n = 0;
  std::string examples;

  void add(const Residue& residue, const std::string& what) {
    if (++n <= kNamed) examples += (n == 1 ? "" : ", ") + residue_label(residue) + " (" + what + ")";
  }
  std::string in_words() const { return examples + (n > kNamed ? ", ..." : ""); }
  std::string count() const { return std::to_string(n) + (n == 1 ? " residue" : " residues"); }
  bool is_systematic(double most_share, std::size_t n_all) const {
    return n >= kLeastFaulty && static_cast<double>(n) > most_share * static_cast<double>(n_all);
  }
};

std::string elementary_charges(double q) { return formatted("%.4g", std::fabs(q) < 5e-5 ? 0 : q) + " e"; }

/// The backbone of a residue: atoms by their normalized names, -1 where there is none.
struct ChargedBackbone {
  std::ptrdiff_t n = -1, c = -1, o = -1;
  bool begins_chain = false, ends_chain = false;  ///< by its atoms: H2 or H3, OXT

  ChargedBackbone(const ResidueView& view, std::size_t residue) {
    const bool is_nucleotide = view.kinds[residue] == ResidueKind::kNucleotide;
    for (const std::size_t i : view.atoms[residue]) {
      const std::string name = normalized_atom_name(view.molecule->atoms[i].name);
      const auto atom = static_cast<std::ptrdiff_t>(i);
      if (is_nucleotide) {
        if (name == "P") c = atom;
        if (name == "OP1") o = atom;
        if (name == "O5'") n = atom;
        continue;
      }
      if (name == "N") n = atom;
      if (name == "C") c = atom;
      if (name == "O") o = atom;
      begins_chain = begins_chain || name == "H2" || name == "H3";
      ends_chain = ends_chain || name == "OXT";
    }
  }
  bool is_whole() const { return n >= 0 && c >= 0 && o >= 0; }
};

/// One molecule's polymer with its charges.
class ChargedPolymer {
 public:
  explicit ChargedPolymer(const ResidueView& view) : view_(view), charges_(view.molecule->charges) {
    for (std::size_t r = 0; r < view.kinds.size(); ++r) {
      if (view.kinds[r] != ResidueKind::kAminoAcid && view.kinds[r] != ResidueKind::kNucleotide) continue;
      const ChargedBackbone backbone(view, r);
      if (!backbone.is_whole()) continue;
      residues_.push_back(r);
      backbones_.push_back(backbone);
    }
  }

  std::size_t size() const { return residues_.size(); }
  std::size_t residue(std::size_t k) const { return residues_[k]; }
  const ChargedBackbone& backbone(std::size_t k) const { return backbones_[k]; }

  /// The charge of the atom that is `shift` places later in the file.
  double charge(std::ptrdiff_t atom, std::ptrdiff_t shift = 0) const {
    const std::ptrdiff_t at = atom + shift;
    return at < 0 || at >= static_cast<std::ptrdiff_t>(charges_.size())
               ? 0
               : static_cast<double>(charges_[static_cast<std::size_t>(at)]);
  }
  double net(std::size_t k) const {
    double sum = 0;
    for (const std::size_t i : view_.atoms[residues_[k]]) sum += static_cast<double>(charges_[i]);
    return sum;
  }
  double median_oxygen() const {
    std::vector<double> of;
    for (const ChargedBackbone& backbone : backbones_) of.push_back(charge(backbone.o));
    const auto middle = of.begin() + static_cast<std::ptrdiff_t>(of.size() / 2);
    std::nth_element(of.begin(), middle, of.end());
    return *middle;
  }
  /// Whether some of the backbone is charged; in models of whole charges at charged groups it is not.
  bool has_charged_backbone() const {
    std::size_t n = 0;
    for (const ChargedBackbone& b : backbones_)
      n += std::fabs(charge(b.n)) + std::fabs(charge(b.c)) + std::fabs(charge(b.o)) > kSignCharge / 10 ? 1 : 0;
    return 2 * n > size();
  }
  /// C is positive and O negative in all force fields; N is negative but at the beginning of a chain.
  bool has_wrong_sign(std::size_t k) const {
    const ChargedBackbone& b = backbones_[k];
    const bool is_first = b.begins_chain || k == 0;
    return charge(b.c) < -kSignCharge || charge(b.o) > kSignCharge || (!is_first && charge(b.n) > kSignCharge);
  }
  double share_of_wrong_signs() const {
    double n = 0;
    for (std::size_t k = 0; k < size(); ++k) n += has_wrong_sign(k) ? 1 : 0;
    return n / static_cast<double>(std::max<std::size_t>(1, size()));
  }
  /// C and O have charges of their sign.
  double share_of_usual_signs(double sign, std::ptrdiff_t shift) const {
    double n = 0;
    for (const ChargedBackbone& b : backbones_)
      n += sign * charge(b.c, shift) > kSignCharge && sign * charge(b.o, shift) < -kSignCharge ? 1 : 0;
    return n / static_cast<double>(std::max<std::size_t>(1, size()));
  }
  /// Whether the chain begins or ends at a residue: by its atoms, or because its neighbour is another chain's.
  bool is_at_end(std::size_t k, bool begin) const {
    if (begin ? backbones_[k].begins_chain : backbones_[k].ends_chain) return true;
    if (begin ? k == 0 : k + 1 == size()) return true;
    const std::vector<Residue>& residues = view_.molecule->residues;
    const Residue &own = residues[residues_[k]], &other = residues[residues_[begin ? k - 1 : k + 1]];
    const std::int32_t step = begin ? own.number - other.number : other.number - own.number;
    return own.chain != other.chain || step < 0 || step > 1;
  }

 private:
  const ResidueView& view_;
  const std::vector<float>& charges_;
  std::vector<std::size_t> residues_;
  std::vector<ChargedBackbone> backbones_;
};

/// What is wrong with the charges of a whole molecule; empty if nothing is.
Message wrong_unit_or_place(const std::string& role, const ChargedPolymer& polymer) {
  const double oxygen = polymer.median_oxygen();
  const double size = std::fabs(oxygen);
  const std::string measured = "the median charge of its backbone oxygens is " + elementary_charges(oxygen) +
                               ", and -0.3 to -0.8 e in every force field";
  if (size / kAmberUnit > kLeastOxygenCharge && size / kAmberUnit < kMostOxygenCharge)
    return "the charges of the " + role + " are in Amber's internal unit, of which 18.2223 are 1 e: " + measured +
           "; divide them by 18.2223";
  if (size > kSignCharge / 10 && (size < kLeastOxygenCharge || size > kMostOxygenCharge))
    return "the charges of the " + role + " are scaled or in another unit: " + measured;
  const double wrong = polymer.share_of_wrong_signs();
  if (wrong <= kMostWrongSigns || wrong * static_cast<double>(polymer.size()) < kLeastFaulty) return {};
  if (polymer.share_of_usual_signs(-1, 0) >= 1 - kMostWrongSigns)
    return "all charges of the " + role + " have the wrong sign: " + measured;
  Message message = "the charges of the " + role + " do not belong to their atoms: in " + percent(wrong) +
                    " of its residues N, C or O of the backbone has a charge of the wrong sign";
  for (const std::ptrdiff_t shift : {1, -1, 2, -2}) {
    if (polymer.share_of_usual_signs(1, shift) < 1 - kMostWrongSigns) continue;
    const std::string places = std::to_string(shift < 0 ? -shift : shift);
    return message + "; they fit the atoms " + places + (shift > 0 ? " before" : " after") + " them in the file";
  }
  return message;
}

/// The net charges that a residue can have by its name, its hydrogens, and the ends of its chain.
std::set<int> expected_charges(const std::string& name, const std::string& state, bool begins, bool ends) {
  std::vector<int> within = charges_of_state(state);
  const std::vector<int> by_name = possible_charges(name);
  // A name that says a state counts as well as the hydrogens, which have other names in some files.
  if (within.empty() || by_name.size() == 1) within.insert(within.end(), by_name.begin(), by_name.end());
  std::set<int> all;
  for (const int charge : within) {
    for (int end = ends ? -1 : 0; end <= (begins ? 1 : 0); ++end) all.insert(charge + end);
  }
  return all;
}

std::string charges_in_words(const std::set<int>& charges) {
  std::string text;
  for (const int charge : charges) text += (text.empty() ? "" : " or ") + std::to_string(charge);
  return text;
}

/// Residues whose net charge is wrong, each under its first fault.
struct NetCharges {
  FaultyResidues fractional, impossible, turned;
  std::size_t n_known = 0;

  NetCharges(const ResidueView& view, const ChargedPolymer& polymer) {
    const std::vector<std::string> states = protonation_states(*view.molecule);
    for (std::size_t k = 0; k < polymer.size(); ++k) {
      const std::size_t r = polymer.residue(k);
      const Residue& residue = view.molecule->residues[r];
      const std::set<int> expected =
          expected_charges(residue.name, states[r], polymer.is_at_end(k, true), polymer.is_at_end(k, false));
      if (expected.empty()) continue;
      ++n_known;
      const double net = polymer.net(k), nearest = std::round(net);
      const bool is_strand_end = view.kinds[r] == ResidueKind::kNucleotide &&
                                 std::any_of(kStrandEndsCharge.begin(), kStrandEndsCharge.end(),
                                             [&](double end) { return std::fabs(net - end) < kWholeCharge; });
      if (is_strand_end) continue;
      if (std::fabs(net - nearest) > kWholeCharge) {
        fractional.add(residue, elementary_charges(net));
      } else if (expected.count(static_cast<int>(nearest)) == 0) {
        impossible.add(residue, elementary_charges(net) + ", not " + charges_in_words(expected));
      } else if (polymer.has_wrong_sign(k)) {
        turned.add(residue, "O " + elementary_charges(polymer.charge(polymer.backbone(k).o)));
      }
    }
  }
};

bool has_hydrogen(const Molecule& molecule) {
  return std::any_of(molecule.atoms.begin(), molecule.atoms.end(),
                     [](const Atom& atom) { return atom.element == "H"; });
}

void check_net_charges(const std::string& role, const ResidueView& view, const ChargedPolymer& polymer,
                       std::vector<Warning>& warnings) {
  const NetCharges net(view, polymer);
  const std::string of = " of the " + role;
  if (net.fractional.n > 0) {
    const bool refuses = net.fractional.is_systematic(kMostFractional, net.n_known);
    Message text = "the charges of " + net.fractional.count() + of +
                   " do not add up to a whole number: " + net.fractional.in_words();
    if (refuses)
      text += has_hydrogen(*view.molecule) ? "; atoms or charges are missing"
                                           : "; it has no hydrogens, whose charges are missing as well";
    warnings.push_back({text, refuses});
  }
  if (net.impossible.n > 0)
    warnings.push_back({net.impossible.count() + of +
                            (net.impossible.n == 1 ? " has a net charge" : " have net charges") +
                            " that name and hydrogens exclude: " + net.impossible.in_words(),
                        net.impossible.is_systematic(kMostImpossible, net.n_known)});
  if (net.turned.n > 0)
    warnings.push_back(
        {"the backbone of " + net.turned.count() + of + " has charges of the wrong sign: " + net.turned.in_words(),
         false});
}

/// Ions of one atom: the other sign, more than their charge, or none.
void check_ions(const std::string& role, const ResidueView& view, std::vector<Warning>& warnings) {
  FaultyResidues wrong;
  for (std::size_t r = 0; r < view.kinds.size(); ++r) {
    const Residue& residue = view.molecule->residues[r];
    if (view.kinds[r] != ResidueKind::kOther || view.atoms[r].size() != 1 || !is_ion_name(residue.name)) continue;
    const double q = static_cast<double>(view.molecule->charges[view.atoms[r].front()]);
    const int usual = *charge_of_group(residue.name, 1);
    // Models of bonded metals give part of the charge to the neighbours; iron and copper have two oxidation states.
    if (q * usual > 0 && std::fabs(q) < std::abs(usual) + 1 + kWholeCharge) continue;
    wrong.add(residue, elementary_charges(q) + ", usually " + std::to_string(usual));
  }
  if (wrong.n == 0) return;
  warnings.push_back({std::to_string(wrong.n) + (wrong.n == 1 ? " ion" : " ions") + " of the " + role +
                          (wrong.n == 1 ? " has a charge" : " have charges") +
                          " of the wrong sign or size: " + wrong.in_words(),
                      false});
}

bool has_any_charge(const Molecule& molecule) {
  return std::any_of(molecule.charges.begin(), molecule.charges.end(), [](float q) { return q != 0; });
}

/// Differences of the charges of two paired residues.
struct PairedCharges {
  double source = 0, target = 0, sum = 0, largest = 0;
  std::size_t n = 0;
};

/// [source residue]
std::vector<PairedCharges> charges_of_pairs(const Molecule& source, const Molecule& target,
                                            const AtomPairing& pairing) {
  std::vector<PairedCharges> all(source.residues.size());
  for (const auto& [s, t] : pairing.pairs) {
    const double a = static_cast<double>(source.charges[s]), b = static_cast<double>(target.charges[t]);
    PairedCharges& of = all[static_cast<std::size_t>(source.atoms[s].residue)];
    of.source += a;
    of.target += b;
    of.sum += std::fabs(a - b);
    of.largest = std::max(of.largest, std::fabs(a - b));
    ++of.n;
  }
  return all;
}

}  // namespace

bool check_charges(const char* role, const ResidueView& view, std::vector<Warning>& warnings) {
  if (!has_any_charge(*view.molecule)) return true;
  check_ions(role, view, warnings);
  const ChargedPolymer polymer(view);
  if (!polymer.has_charged_backbone()) return true;
  const Message systematic = wrong_unit_or_place(role, polymer);
  if (systematic.empty()) {
    check_net_charges(role, view, polymer, warnings);
    return true;
  }
  warnings.push_back({systematic, true});
  return false;
}

void check_paired_charges(const ResidueView& source, const ResidueView& target, const AtomPairing& pairing,
                          std::vector<Warning>& warnings) {
  const Molecule &a = *source.molecule, &b = *target.molecule;
  if (!has_any_charge(a) || !has_any_charge(b)) return;
  const std::vector<PairedCharges> pairs = charges_of_pairs(a, b, pairing);
  const std::vector<std::int32_t> partner = paired_residues(a, b, pairing);
  const std::vector<std::string> of_source = protonation_states(a), of_target = protonation_states(b);
  FaultyResidues charged_otherwise;
  std::size_t n_unchanged = 0, n_other = 0, n_atoms = 0;
  double sum = 0;
  for (std::size_t r = 0; r < partner.size(); ++r) {
    if (partner[r] < 0) continue;
    const auto t = static_cast<std::size_t>(partner[r]);
    const PairedCharges& of = pairs[r];
    if (source.kinds[r] == ResidueKind::kOther || of_source[r] != of_target[t]) continue;
    if (of.n != source.atoms[r].size() || of.n != target.atoms[t].size()) continue;
    if (!same_residue_name(a.residues[r].name, b.residues[t].name)) continue;
    if (std::fabs(of.source - of.target) > kOtherNetCharge) {
      charged_otherwise.add(a.residues[r],
                            elementary_charges(of.source) + ", " + elementary_charges(of.target) + " in the target");
      continue;
    }
    ++n_unchanged;
    n_other += of.largest > kSameChargeLimit ? 1 : 0;
    n_atoms += of.n;
    sum += of.sum;
  }
  if (charged_otherwise.n > 0)
    warnings.push_back({charged_otherwise.count() + " of one name and the same hydrogens differ" +
                            (charged_otherwise.n == 1 ? "s" : "") + " in net charge: " + charged_otherwise.in_words(),
                        false});
  if (n_unchanged < kLeastUnchanged ||
      static_cast<double>(n_other) <= kMostOfTwoFields * static_cast<double>(n_unchanged))
    return;
  const double mean = sum / static_cast<double>(n_atoms);
  warnings.push_back({"the charges are of two force fields: in " + std::to_string(n_other) + " of " +
                          std::to_string(n_unchanged) + " unchanged residues they differ, by " +
                          formatted("%.3f", mean) +
                          " e an atom on average, which makes a difference by itself; take the charges of one origin",
                      mean > kRefusedOfTwoFieldsCharge});
}

}  // namespace espdiff
