// planted_cases.cpp: builds the errors from real structures.
#include "input_checks/planted_cases.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "base/error.h"
#include "base/molecule/structure_options.h"
#include "base/progress.h"
#include "certificate/result.h"
#include "compare/compare.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/structures/structure_file.h"
#include "mapping/input.h"
#include "options/options.h"

namespace espdiff_test {
namespace {

using espdiff::Molecule;
using espdiff::Residue;
using espdiff::RigidTransform;
using espdiff::Vec3d;
using MoleculePair = std::pair<Molecule, Molecule>;

Molecule read(const std::string& path, int model = 1) {
  espdiff::StructureOptions options;
  options.model = model;
  return espdiff::read_structure(path, options);
}

Vec3d centroid(const Molecule& molecule, const std::function<bool(const Residue&)>& chosen) {
  Vec3d sum{};
  double n = 0;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (!chosen(molecule.residues[static_cast<std::size_t>(molecule.atoms[i].residue)])) continue;
    sum += molecule.positions[i];
    ++n;
  }
  return (1 / n) * sum;
}

/// Moves the atoms of the chosen residues.
void move(Molecule& molecule, const std::function<bool(const Residue&)>& chosen,
          const std::function<Vec3d(const Vec3d&)>& motion) {
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (chosen(molecule.residues[static_cast<std::size_t>(molecule.atoms[i].residue)]))
      molecule.positions[i] = motion(molecule.positions[i]);
  }
}

/// The residues in another order.
Molecule reordered(const Molecule& molecule, const std::vector<std::size_t>& residues) {
  Molecule result;
  result.name = molecule.name;
  result.radii_origin = molecule.radii_origin;
  for (const std::size_t r : residues) {
    result.residues.push_back(molecule.residues[r]);
    for (std::size_t i = 0; i < molecule.size(); ++i) {
      if (static_cast<std::size_t>(molecule.atoms[i].residue) != r) continue;
      result.atoms.push_back(molecule.atoms[i]);
      result.atoms.back().residue = static_cast<std::int32_t>(result.residues.size() - 1);
      result.positions.push_back(molecule.positions[i]);
      result.radii.push_back(molecule.radii[i]);
      if (!molecule.charges.empty()) result.charges.push_back(molecule.charges[i]);
    }
  }
  return result;
}

std::vector<std::size_t> polymer_residues(const Molecule& molecule) {
  std::vector<std::size_t> residues;
  for (const auto& atom : molecule.atoms) {
    const auto r = static_cast<std::size_t>(atom.residue);
    if (atom.name == "CA" && atom.element == "C" && (residues.empty() || residues.back() != r)) residues.push_back(r);
  }
  return residues;
}

/// Backbone and C-beta: any residue can have any name.
Molecule backbone(const Molecule& molecule) {
  Molecule result = reordered(molecule, polymer_residues(molecule)), trimmed;
  trimmed.name = result.name;
  trimmed.radii_origin = result.radii_origin;
  trimmed.residues = result.residues;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const std::string& name = result.atoms[i].name;
    if (name != "N" && name != "CA" && name != "C" && name != "O" && name != "CB") continue;
    trimmed.atoms.push_back(result.atoms[i]);
    trimmed.positions.push_back(result.positions[i]);
    trimmed.radii.push_back(result.radii[i]);
  }
  return trimmed;
}

/// The residue at position k gets the name and number of that at k + shift; the ends are cut.
Molecule shifted_register(const Molecule& molecule, std::size_t shift) {
  std::vector<std::size_t> kept(molecule.residues.size() - shift);
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  Molecule result = reordered(molecule, kept);
  for (std::size_t r = 0; r < kept.size(); ++r) {
    const std::string chain = result.residues[r].chain;
    result.residues[r] = molecule.residues[r + shift];
    result.residues[r].chain = chain;
  }
  return result;
}

/// The chain begins at its middle; residues are numbered anew.
Molecule permuted(const Molecule& molecule) {
  std::vector<std::size_t> order = polymer_residues(molecule);
  std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2), order.end());
  Molecule result = reordered(molecule, order);
  for (std::size_t r = 0; r < order.size(); ++r) result.residues[r].number = static_cast<std::int32_t>(r + 1);
  return result;
}

/// Four of five residues with another name, drawn by a fixed rule.
Molecule renamed(const Molecule& molecule, std::size_t lost) {
  static const char* const names[] = {"ALA", "LEU", "SER", "GLU", "LYS", "VAL", "THR", "ASP", "ILE", "GLY"};
  std::vector<std::size_t> kept;
  for (std::size_t r = 0; r < molecule.residues.size(); ++r) {
    if (r < 40 || r >= 40 + lost) kept.push_back(r);
  }
  Molecule result = reordered(molecule, kept);
  std::size_t state = 12345;
  for (std::size_t r = 0; r < result.residues.size(); ++r) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    if (r % 5 != 0) result.residues[r].name = names[(state >> 33) % 10];
    result.residues[r].number = static_cast<std::int32_t>(r + 1);
  }
  return result;
}

std::function<bool(const Residue&)> in_chain(const std::string& chain) {
  return [chain](const Residue& residue) { return residue.chain == chain; };
}
std::function<bool(const Residue&)> named(const std::string& name) {
  return [name](const Residue& residue) { return residue.name == name; };
}
std::function<Vec3d(const Vec3d&)> by(const Vec3d& shift) {
  return [shift](const Vec3d& p) { return p + shift; };
}

/// Exchanges the names of two chains; `sorted` also lists the first name first, as programs do.
Molecule exchanged(Molecule molecule, const std::string& a, const std::string& b, bool sorted) {
  for (Residue& residue : molecule.residues)
    residue.chain = residue.chain == a ? b : residue.chain == b ? a : residue.chain;
  if (!sorted) return molecule;
  std::vector<std::size_t> order(molecule.residues.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return molecule.residues[i].chain < molecule.residues[j].chain;
  });
  return reordered(molecule, order);
}

struct Maker {
  const std::string folder;
  std::vector<PlantedCase> cases{};

  /// A structure against itself with an error.
  void plant(const std::string& name, const std::string& reason, const std::string& file,
             const std::function<void(MoleculePair&)>& error) {
    const std::string path = folder + "/" + file;
    cases.push_back({name, reason, {path}, [path, error] {
                       MoleculePair pair{read(path), read(path)};
                       error(pair);
                       return pair;
                     }});
  }
  void pair(const std::string& name, const std::string& reason, const std::string& a, int model_a, const std::string& b,
            int model_b) {
    const std::string source = folder + "/" + a, target = folder + "/" + b;
    cases.push_back({name, reason, {source, target}, [=] {
                       return MoleculePair{read(source, model_a), read(target, model_b)};
                     }});
  }
};

void add_mirrors(Maker& maker) {
  for (const char* const file : {"t4l/181L.pdb", "pairs/1hhp.pdb", "ubq/ubq.pqr"})
    maker.plant(std::string("mirror image of ") + file, "mirror image", file, [](MoleculePair& pair) {
      for (Vec3d& p : pair.second.positions) p.x = -p.x;
    });
}

void add_broken(Maker& maker) {
  for (const int n : {1, 5})
    maker.plant(std::to_string(n) + (n == 1 ? " residue" : " residues") + " 60 A away", "broken", "t4l/181L.pdb",
                [n](MoleculePair& pair) {
                  move(
                      pair.second,
                      [n](const Residue& residue) { return residue.number >= 20 && residue.number < 20 + n; },
                      by({60, 0, 0}));
                });
}

void add_registers(Maker& maker) {
  for (const std::size_t shift : {1, 3, 10})
    maker.plant("register shifted by " + std::to_string(shift), "shifted|slipped", "t4l/181L.pdb",
                [shift](MoleculePair& pair) {
                  pair.first = backbone(pair.first);
                  pair.second = shifted_register(pair.first, shift);
                });
}

void add_moved_parts(Maker& maker) {
  maker.plant("ligand at a far site", "the ligand BNZ", "t4l/181L.pdb", [](MoleculePair& pair) {
    move(pair.second, named("BNZ"), by({0, 0, 25}));
  });
  maker.plant("cofactor at a far site", "the ligand AP5", "pairs/1ake.pdb", [](MoleculePair& pair) {
    for (Molecule* molecule : {&pair.first, &pair.second}) {
      std::vector<std::size_t> kept;
      for (std::size_t r = 0; r < molecule->residues.size(); ++r) {
        if (molecule->residues[r].chain == "A") kept.push_back(r);
      }
      *molecule = reordered(*molecule, kept);
    }
    move(pair.second, named("AP5"), by({0, 40, 0}));
  });
  maker.plant("a chain turned in place", "arranged differently", "fv_d13/1a2y.pdb", [](MoleculePair& pair) {
    const Vec3d c = centroid(pair.second, in_chain("C"));
    move(pair.second, in_chain("C"), [c](const Vec3d& p) { return Vec3d{2 * c.x - p.x, 2 * c.y - p.y, p.z}; });
  });
}

void add_wrong_molecules(Maker& maker) {
  maker.pair("lysozyme against protease", "|", "t4l/181L.pdb", 1, "pairs/1hhp.pdb", 1);
  maker.pair("isomerase against kinase", "|", "tim/2YPI.pdb", 1, "pairs/4ake.pdb", 1);
  maker.pair("ubiquitin against nucleocapsid", "|", "ubq/ubq.pqr", 1, "pairs/1aaf.pdb", 1);
  maker.pair("protease against kinase", "|", "pairs/3phv.pdb", 1, "pairs/1ake.pdb", 1);
  maker.plant("20 % identity, 12 residues lost", "=", "t4l/181L.pdb", [](MoleculePair& pair) {
    pair.first = backbone(pair.first);
    pair.second = renamed(pair.first, 12);
  });
  maker.plant("circular permutation", "=", "t4l/181L.pdb",
              [](MoleculePair& pair) { pair.second = permuted(pair.second); });
}

/// Right pairs under wrong names or in another order.
void add_right_pairs(Maker& maker) {
  maker.plant("chains of a dimer under exchanged names", "", "tim/2YPI.pdb",
              [](MoleculePair& pair) { pair.second = exchanged(pair.second, "A", "B", false); });
  maker.plant("chains of a dimer under exchanged names, sorted", "", "tim/2YPI.pdb",
              [](MoleculePair& pair) { pair.second = exchanged(pair.second, "A", "B", true); });
  maker.plant("residues in another order", "", "t4l/181L.pdb", [](MoleculePair& pair) {
    std::vector<std::size_t> order(pair.second.residues.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [](std::size_t a, std::size_t b) { return a * 37 % 101 < b * 37 % 101; });
    pair.second = reordered(pair.second, order);
  });
  maker.plant("exchanged chlorides", "", "t4l/181L.pdb", [](MoleculePair& pair) {
    std::vector<std::size_t> chlorides;
    for (std::size_t i = 0; i < pair.second.size(); ++i) {
      if (pair.second.atoms[i].name == "CL") chlorides.push_back(i);
    }
    std::swap(pair.second.positions[chlorides.at(0)], pair.second.positions[chlorides.at(1)]);
  });
}

}  // namespace

std::vector<PlantedCase> planted_cases(const std::string& folder) {
  Maker maker{folder};
  add_mirrors(maker);
  add_broken(maker);
  add_registers(maker);
  add_moved_parts(maker);
  add_wrong_molecules(maker);
  add_right_pairs(maker);
  return maker.cases;
}

std::vector<PlantedCase> easy_pairs(const std::string& folder) {
  Maker maker{folder};
  const std::vector<std::string> fv{"1a2y", "1kip", "1kiq", "1kir", "1vfb"};
  for (std::size_t i = 0; i < fv.size(); ++i) {
    for (std::size_t j = 0; j < fv.size(); ++j) {
      if (i != j) maker.pair(fv[i] + "/" + fv[j], "", "fv_d13/" + fv[i] + ".pdb", 1, "fv_d13/" + fv[j] + ".pdb", 1);
    }
  }
  maker.pair("2YPI/7TIM", "", "tim/2YPI.pdb", 1, "tim/7tim.pdb", 1);
  maker.pair("7TIM/2YPI", "", "tim/7tim.pdb", 1, "tim/2YPI.pdb", 1);
  maker.pair("1HHP/3PHV", "", "pairs/1hhp.pdb", 1, "pairs/3phv.pdb", 1);
  maker.pair("3PHV/1HHP", "", "pairs/3phv.pdb", 1, "pairs/1hhp.pdb", 1);
  maker.pair("3LZM/181L", "", "t4l/3lzm_from_bcif.pdb", 1, "t4l/181L.pdb", 1);
  maker.pair("181L/3LZM", "", "t4l/181L.pdb", 1, "t4l/3lzm_from_bcif.pdb", 1);
  maker.pair("3LZM/181L with hydrogens", "", "pair_t4l_maps/3lzm.pqr", 1, "pair_t4l_maps/181l_fit.pqr", 1);
  maker.pair("TIM sc/d", "", "pair_tim_maps/scTIM_chainA.pqr", 1, "pair_tim_maps/dTIM_chainA.pqr", 1);
  for (const auto& [a, b] : {std::pair("2", "7"), std::pair("14", "7"), std::pair("2", "14"), std::pair("7", "2")})
    maker.pair(std::string("1AJJ pH ") + a + "/" + b, "", std::string("pqr_pdb2pqr/1AJJ_pH") + a + "_AMBER.pqr", 1,
               std::string("pqr_pdb2pqr/1AJJ_pH") + b + "_AMBER.pqr", 1);
  for (int model = 2; model <= 38; ++model)
    maker.pair("1L2Y 1/" + std::to_string(model), "", "nmr/1l2y.pdb", 1, "nmr/1l2y.pdb", model);
  return maker.cases;
}

PlantedOutcome run_case(const PlantedCase& planted, int threads, const std::string& domains) {
  PlantedOutcome outcome;
  const bool must_map = planted.reason.empty() || planted.reason == "=";
  try {
    const MoleculePair pair = planted.load();
    const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, threads);
    espdiff::CompareOptions options;
    options.domains = domains;
    const espdiff::CompareResult result =
        espdiff::compare(*engine, {&pair.first, nullptr, nullptr}, {&pair.second, nullptr, nullptr}, options, {});
    const espdiff::Certificate& c = result.certificate;
    outcome.trustworthy = c.trustworthy;
    outcome.rmsd_A = result.rmsd_A;
    outcome.same_residue = c.same_residue_area_fraction;
    outcome.slip_area_fraction = c.slip ? c.slip->large_area_fraction : NAN;
    for (const espdiff::Message& reason : c.reasons)
      outcome.reasons += (outcome.reasons.empty() ? "" : "; ") + reason.plain();
  } catch (const espdiff::Error& error) {
    outcome.reasons = std::string("refused: ") + error.what();
  }
  if (must_map) {
    // "=": the same structure under other names; a small RMSD shows that it was paired rightly.
    outcome.right = outcome.trustworthy ? planted.reason.empty() || outcome.rmsd_A < 0.5 : planted.reason == "=";
    return outcome;
  }
  bool named = outcome.reasons.rfind("refused: ", 0) == 0;
  std::istringstream texts(planted.reason);
  for (std::string text; std::getline(texts, text, '|');)
    named = named || (text.empty() ? !outcome.reasons.empty() : outcome.reasons.find(text) != std::string::npos);
  outcome.right = !outcome.trustworthy && named;
  return outcome;
}

}  // namespace espdiff_test
