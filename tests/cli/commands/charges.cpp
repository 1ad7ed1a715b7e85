// charges.cpp: charges from other files than the structures: --topology and --charges-from, from the files to the
// numbers; and structures that are prepared on the way, in potential and surface.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "base/formatted.h"
#include "cli/run_espdiff.h"
#include "io/files/read_csv.h"
#include "io/structures/structure_file.h"
#include "io/vtk/read_vtp.h"

using namespace espdiff_test;  // NOLINT: a test
using Json = nlohmann::json;

namespace {

const std::string kQuick = " --grid-spacing 2 --pb-spacing 1.5 --device cpu -q -o ";

/// The atoms of a PQR file as PDB, without charges and radii.
std::string as_pdb(const std::string& pqr) {
  std::string pdb;
  std::istringstream lines(pqr);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("ATOM", 0) == 0) pdb += line.substr(0, 54) + "  1.00  0.00\n";
  }
  return pdb;
}

Json run(const std::string& arguments, const std::string& output) {
  const Outcome outcome = run_espdiff(arguments + kQuick + output);
  // 3: compared, and not trusted
  REQUIRE_MESSAGE((outcome.status == 0 || outcome.status == 3), outcome.err);
  return Json::parse(read_file(output + ".json"));
}

/// Values in a section of a prmtop, n on a line.
template <typename Value>
void add_section(std::string& text, const std::string& flag, const char* format, std::size_t n_values, int n_on_line,
                 Value value) {
  text += "%FLAG " + flag + "\n%FORMAT(" + format + ")\n";
  for (std::size_t i = 0; i < n_values; ++i)
    text += value(i) + ((i + 1) % static_cast<std::size_t>(n_on_line) == 0 || i + 1 == n_values ? "\n" : "");
}

std::string prmtop_of(const espdiff::Molecule& m) {
  std::vector<std::size_t> first;  // [residue], from 1
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (static_cast<std::size_t>(m.atoms[i].residue) == first.size()) first.push_back(i + 1);
  }
  const auto integer = [](std::size_t n) { return espdiff::formatted("%8d", static_cast<int>(n)); };
  const auto name = [](const std::string& word) { return (word + "    ").substr(0, 4); };
  std::string text = "%VERSION  VERSION_STAMP = V0001.000\n";
  add_section(text, "POINTERS", "10I8", 1, 10, [&](std::size_t) { return integer(m.size()); });
  add_section(text, "ATOM_NAME", "20a4", m.size(), 20, [&](std::size_t i) { return name(m.atoms[i].name); });
  add_section(text, "CHARGE", "5E16.8", m.size(), 5,
              [&](std::size_t i) { return espdiff::formatted("%16.8E", 18.2223 * static_cast<double>(m.charges[i])); });
  add_section(text, "RESIDUE_LABEL", "20a4", first.size(), 20, [&](std::size_t r) { return name(m.residues[r].name); });
  add_section(text, "RESIDUE_POINTER", "10I8", first.size(), 10, [&](std::size_t r) { return integer(first[r]); });
  add_section(text, "RADII", "5E16.8", m.size(), 5,
              [&](std::size_t i) { return espdiff::formatted("%16.8E", static_cast<double>(m.radii[i])); });
  return text;
}

std::string restart_of(const espdiff::Molecule& m) {
  std::string text = "\n" + std::to_string(m.size()) + "\n";
  for (std::size_t i = 0; i < m.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) text += espdiff::formatted("%12.7f", m.positions[i][axis]);
    if (i % 2 == 1 || i + 1 == m.size()) text += "\n";
  }
  return text;
}

std::string mol2_of(const espdiff::Molecule& m) {
  std::string text = "@<TRIPOS>MOLECULE\nmade\n 0 0 0 0 0\nPROTEIN\nUSER_CHARGES\n\n@<TRIPOS>ATOM\n";
  for (std::size_t i = 0; i < m.size(); ++i) {
    const espdiff::Residue& residue = m.residues[static_cast<std::size_t>(m.atoms[i].residue)];
    text += std::to_string(i + 1) + " " + m.atoms[i].name +
            espdiff::formatted(" %.4f %.4f %.4f ", m.positions[i].x, m.positions[i].y, m.positions[i].z) +
            m.atoms[i].element + espdiff::formatted(" %d ", residue.number) + residue.name +
            espdiff::formatted("%d %.4f\n", residue.number, static_cast<double>(m.charges[i]));
  }
  return text;
}

/// The rows of a trajectory without its head, and without their checksums, which depend on the head.
std::string rows(const std::string& csv) {
  const espdiff::CsvTable table = espdiff::read_csv(csv);
  std::string text;
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (table.columns[i] != "reference_frame" && table.columns[i] != "checksum") text += row[i] + ",";
    }
    text += '\n';
  }
  return text;
}

}  // namespace

TEST_CASE("compare, trajectory and matrix --charges-from: the numbers of files that have these charges") {
  const auto first = real_input("series19_ubq_2k39/m00.pqr"), second = real_input("series19_ubq_2k39/m05.pqr");
  if (!first || !second) return;
  const ScratchFolder folder;
  const std::string a = folder.write("a.pdb", as_pdb(read_file(*first))),
                    b = folder.write("b.pdb", as_pdb(read_file(*second)));
  const std::string from = " --charges-from " + *first;
  const Json given = run("compare " + *first + " " + *second, folder.file("given")),
             taken = run("compare " + a + " " + b + from, folder.file("taken"));
  for (const char* metric : {"mean_abs_difference", "hodgkin_index", "mean_displacement_A", "rmsd_A"})
    CHECK(taken[metric] == given[metric]);
  CHECK(given["mean_abs_difference"].get<double>() > 0.1);
  bool is_listed = false;
  for (const Json& input : taken["inputs"])
    is_listed = is_listed || input["path"] == *first;  // beside the states that were kept
  CHECK_MESSAGE(is_listed, taken["inputs"].dump());
  const auto trajectory = [&](const std::string& arguments, const std::string& name) {
    const Outcome outcome = run_espdiff("trajectory " + arguments + " --potential pb" + kQuick + folder.file(name));
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    return rows(folder.file(name));
  };
  CHECK(trajectory(*first + " " + *second, "given.csv") == trajectory(a + " " + b + from, "taken.csv"));
  const Json matrix = run("matrix " + a + " " + b + from + " --potential pb", folder.file("m"));
  CHECK(matrix["metrics"]["mean_abs_difference"]["values"][0][1] == given["mean_abs_difference"]);
  // A state of other atoms.
  const std::string cut = folder.write("cut.pdb", as_pdb(read_file(*second)).substr(0, 81 * 600));
  const Outcome refused = run_espdiff("compare " + a + " " + cut + from + kQuick + folder.file("no"));
  CHECK(refused.status == 2);
  CHECK(n_lines(refused.err) == 1);
  CHECK_MESSAGE(contains(refused.err, "cut.pdb"), refused.err);
}

TEST_CASE("compare and trajectory --topology: a PSF's charges beside coordinates, each side's own too") {
  const auto pdb = real_input("ubq/ubq.pdb"), psf = real_input("ubq/ubq.psf");
  if (!pdb || !psf) return;
  const ScratchFolder folder;
  // The same atoms, bent a little.
  std::string bent;
  std::istringstream lines(read_file(*pdb));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("ATOM", 0) == 0) {
      char x[16];
      const double z = std::stod(line.substr(46, 8));
      std::snprintf(x, sizeof x, "%8.3f", std::stod(line.substr(30, 8)) + 0.002 * z * z);
      line.replace(30, 8, x);
    }
    bent += line + "\n";
  }
  const std::string target = folder.write("bent.pdb", bent), pair = *pdb + " " + target;
  const Json both = run("compare " + pair + " --topology " + *psf, folder.file("both"));
  CHECK(both["potential"]["label"] == "Poisson-Boltzmann, 0.15 mol/l");
  CHECK(both["mean_abs_difference"].get<double>() > 0.001);
  double charge = 1, n = 0;
  for (const Json& input : both["inputs"]) {
    if (input["role"] == "source_map") charge = input["computed"]["net_charge"];
    n += input["role"] == "source_topology" || input["role"] == "target_topology" ? 1 : 0;
  }
  CHECK(std::fabs(charge) < 1e-3);
  CHECK_MESSAGE(n == 2, both["inputs"].dump());
  const Json sides =
      run("compare " + pair + " --source-topology " + *psf + " --target-topology " + *psf, folder.file("sides"));
  CHECK(sides["mean_abs_difference"] == both["mean_abs_difference"]);
  const Outcome trajectory =
      run_espdiff("trajectory " + pair + " --topology " + *psf + " --potential pb" + kQuick + folder.file("t.csv"));
  REQUIRE_MESSAGE(trajectory.status == 0, trajectory.err);
  const espdiff::CsvTable table = espdiff::read_csv(folder.file("t.csv"));
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i] == "mean_abs_difference")
      CHECK(std::stod(table.rows.at(0).at(i)) == both["mean_abs_difference"].get<double>());
  }
  const Outcome refused = run_espdiff("compare " + pair + " --topology " + *pdb + kQuick + folder.file("no"));
  CHECK(refused.status == 2);
  CHECK_MESSAGE(contains(refused.err, "ubq.pdb"), refused.err);
  const std::string cut = folder.write("cut.pdb", bent.substr(0, bent.find("ATOM   1000")));
  const Outcome fewer = run_espdiff("compare " + *pdb + " " + cut + " --topology " + *psf + kQuick + folder.file("no"));
  CHECK(fewer.status == 2);
  CHECK(n_lines(fewer.err) == 1);
  CHECK_MESSAGE(contains(fewer.err, "1231"), fewer.err);
}

TEST_CASE("trajectory: a topology and a structure of its atoms, as VMD takes them") {
  const auto pdb = real_input("ubq/ubq.pdb"), psf = real_input("ubq/ubq.psf");
  if (!pdb || !psf) return;
  const ScratchFolder folder;
  const auto rows_of = [&](const std::string& arguments, const std::string& name) {
    const Outcome outcome = run_espdiff("trajectory " + arguments + " --potential pb" + kQuick + folder.file(name));
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    return rows(folder.file(name));
  };
  CHECK(rows_of(*psf + " " + *pdb, "vmd.csv") == rows_of(*pdb + " " + *pdb + " --topology " + *psf, "option.csv"));
  const Outcome alone = run_espdiff("trajectory " + *psf + " " + *psf + kQuick + folder.file("no.csv"));
  CHECK(alone.status != 0);
  CHECK(n_lines(alone.err) <= 2);
}

TEST_CASE("Amber's prmtop and restart: the numbers of a PQR with the same atoms, in every command") {
  const auto first = real_input("series19_ubq_2k39/m00.pqr"), second = real_input("series19_ubq_2k39/m05.pqr");
  if (!first || !second) return;
  const ScratchFolder folder;
  const auto write = [&](const std::string& pqr, const std::string& name) {
    const espdiff::Molecule molecule = espdiff::read_structure(pqr, {1, true, true, {}});
    folder.write(name + ".prmtop", prmtop_of(molecule));
    return folder.write(name + ".inpcrd", restart_of(molecule));
  };
  const std::string a = write(*first, "a"), b = write(*second, "b"), prmtop = folder.file("a.prmtop");
  const Json pqr = run("compare " + *first + " " + *second, folder.file("pqr")),
             amber = run("compare " + a + " " + b, folder.file("amber")),
             named = run("compare " + a + " " + b + " --topology " + prmtop, folder.file("named"));
  CHECK(amber["potential"]["label"] == "Poisson-Boltzmann, 0.15 mol/l");
  CHECK(amber["radii_origin"]["source"] == "file");
  CHECK(amber["mean_abs_difference"].get<double>() ==
        doctest::Approx(pqr["mean_abs_difference"].get<double>()).epsilon(1e-3));
  CHECK(named["mean_abs_difference"] == amber["mean_abs_difference"]);
  CHECK_MESSAGE(contains(amber["inputs"].dump(), "a.prmtop"), amber["inputs"].dump());
  for (const std::string& source : {prmtop + " " + a, a + " " + a}) {
    const std::string table = folder.file("frames.csv");
    const Outcome frames =
        run_espdiff("trajectory " + source + " " + b + " --potential pb --overwrite" + kQuick + table);
    REQUIRE_MESSAGE(frames.status == 0, frames.err);
    const espdiff::CsvTable read = espdiff::read_csv(table);
    CHECK(read.rows.size() == 2);
    CHECK(std::stod(read.rows.back().at(read.require("mean_abs_difference"))) ==
          doctest::Approx(amber["mean_abs_difference"].get<double>()).epsilon(1e-6));
  }
  CHECK(run_espdiff("prepare " + a + " -q -o " + folder.file("a.pqr")).status == 0);
  CHECK(espdiff::read_structure(folder.file("a.pqr")).size() == espdiff::read_structure(*first).size());
  // A plugin of VMD has the second ending.
  const std::string alone = folder.write("alone.inpcrd", read_file(a));
  const std::string other = folder.write("other.rst7", read_file(b)), table = folder.file("by_option.csv");
  const Outcome given =
      run_espdiff("trajectory " + alone + " " + other + " --potential pb --topology " + prmtop + kQuick + table);
  CHECK_MESSAGE(given.status == 0, given.err);
  const auto refusal_of = [&](const std::string& words) {
    const Outcome refused = run_espdiff(words + kQuick + folder.file("no"));
    CHECK(refused.status == 2);
    return refused.err;
  };
  const std::string several = refusal_of("compare " + alone + " " + other);
  CHECK_MESSAGE(contains(several, "atoms without their names; " + prmtop + " or " + folder.file("b.prmtop") +
                                      " in its folder list as many: choose one by --source-topology FILE"),
                several);
  const ScratchFolder apart;
  const std::string lonely = apart.write("lonely.rst7", read_file(a)), nothing = refusal_of("surface " + lonely);
  CHECK_MESSAGE(contains(nothing, "atoms without their names; give the topology"), nothing);
  CHECK(n_lines(nothing) == 1);
  const std::string frames = run_espdiff("trajectory " + lonely + " " + lonely + " -o " + apart.file("no.csv")).err;
  CHECK_MESSAGE(contains(frames, "atoms without their names; give the topology"), frames);
  const std::string beside = apart.write("made.parm7", read_file(prmtop)), one = refusal_of("surface " + lonely);
  CHECK_MESSAGE(contains(one, "atoms without their names; " + beside + " in its folder lists as many: --topology " +
                                  beside + "\nnext: espdiff surface " + lonely),
                one);
  CHECK(run_espdiff("surface " + lonely + " --topology " + beside + " --device cpu -q -o " + folder.file("yes.vtp"))
            .status == 0);
}

TEST_CASE("potential and surface prepare a structure without charges, as prepare does") {
  const auto entry = real_input("bad_parmed/2igd.pdb");
  if (!entry || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  const std::string pqr = folder.file("p.pqr");
  REQUIRE(run_espdiff("prepare " + *entry + " -q --ph 5 -o " + pqr).status == 0);
  const auto both = [&](const std::string& verb, const std::string& options, const std::string& ending) {
    const Outcome direct = run_espdiff(verb + " " + *entry + " --ph 5 " + options + " --device cpu --overwrite -o " +
                                       folder.file("direct" + ending));
    REQUIRE_MESSAGE(direct.status == 0, direct.err);
    CHECK_MESSAGE(contains(direct.out, "prepared by     PDB2PQR v"), direct.out);
    const Outcome step =
        run_espdiff(verb + " " + pqr + " " + options + " --device cpu --overwrite -o " + folder.file("step" + ending));
    REQUIRE_MESSAGE(step.status == 0, step.err);
    CHECK_FALSE(contains(step.out, "prepared by"));
    CHECK(read_file(folder.file("direct" + ending)) == read_file(folder.file("step" + ending)));
    return direct.out;
  };
  both("potential", "--method pb --pb-spacing 1.5", ".dx");
  both("potential", "--method pme --grid 2", ".vti");
  const std::string printed = both("surface", "--potential pb --pb-spacing 1.5 --grid-spacing 2", ".vtp");
  CHECK_MESSAGE(contains(printed, "kT/e, Poisson-Boltzmann, 0.15 mol/l"), printed);
  const std::string vacuum = both("surface", "--potential coulomb --grid-spacing 2", ".vtp");
  CHECK_MESSAGE(contains(vacuum, "kT/e in vacuum, vacuum (Coulomb)"), vacuum);
  const std::vector<std::pair<std::string, std::string>> texts = espdiff::read_vtp(folder.file("direct.vtp")).texts;
  REQUIRE(texts.size() == 1);
  CHECK(texts[0].second == "kT/e in vacuum");
  const Outcome shape = run_espdiff("surface " + *entry + " --device cpu -o " + folder.file("shape.vtp"));
  CHECK(shape.status == 0);
  CHECK_FALSE(contains(shape.out, "prepared by"));
}

TEST_CASE("potential, surface and prepare say that a molecule which its cell's border cuts was made whole") {
  const auto pqr = real_input("series19_ubq_2k39/m00.pqr");
  if (!pqr) return;
  const ScratchFolder folder;
  // The border cuts through the molecule, and the cell is wider.
  constexpr std::size_t kX = 30, kWidth = 8;
  constexpr double kBorder_A = 20, kCell_A = 90;
  std::string wrapped = "CRYST1   90.000   90.000   90.000  90.00  90.00  90.00 P 1           1\n";
  std::istringstream lines(as_pdb(read_file(*pqr)));
  for (std::string line; std::getline(lines, line);) {
    const double x = std::stod(line.substr(kX, kWidth)) - kBorder_A;
    wrapped += line.replace(kX, kWidth, espdiff::formatted("%8.3f", x < 0 ? x + kCell_A : x)) + "\n";
  }
  const std::string pdb = folder.write("cut.pdb", wrapped),
                    made = "cell            the molecule crossed the border of its periodic cell at ";
  const Outcome cut = run_espdiff("surface " + pdb + " --device cpu -o " + folder.file("cut.vtp")),
                whole = run_espdiff("surface " + *pqr + " --device cpu -o " + folder.file("whole.vtp"));
  CHECK_MESSAGE(contains(cut.out, made), (cut.out + cut.err));
  CHECK_MESSAGE(contains(cut.out, "1 component\n"), cut.out);
  CHECK_FALSE(contains(whole.out, made));
  if (!has_pdb2pqr()) return;
  for (const std::string& command :
       {"potential " + pdb + " --method pb --pb-spacing 2 --device cpu -o " + folder.file("cut.dx"),
        "prepare " + pdb + " -o " + folder.file("cut.pqr")}) {
    const Outcome outcome = run_espdiff(command);
    CHECK_MESSAGE(contains(outcome.out, made), (outcome.out + outcome.err));
  }
}

TEST_CASE("surface takes selections; what potential and surface cannot do is one line, and nothing is written") {
  const auto entry = real_input("pairs/1ake.pdb");
  if (!entry) return;
  const ScratchFolder folder;
  const std::string output = " --device cpu --grid-spacing 2 --overwrite -o " + folder.file("s.vtp");
  const auto area = [](const std::string& out) { return std::stod(out.substr(out.find("area") + 4)); };
  const Outcome all = run_espdiff("surface " + *entry + output),
                chain = run_espdiff("surface " + *entry + " --select '//A;polymer'" + output);
  REQUIRE_MESSAGE(chain.status == 0, chain.err);
  CHECK(area(chain.out) < 0.6 * area(all.out));
  std::filesystem::remove(folder.file("s.vtp"));
  const auto refused = [&](const std::string& arguments, int status, const std::string& words) {
    const Outcome outcome = run_espdiff(arguments);
    CHECK(outcome.status == status);
    CHECK(n_lines(outcome.err) == (contains(outcome.err, "\nnext: ") ? 2 : 1));
    CHECK_MESSAGE(contains(outcome.err, words), outcome.err);
    CHECK(folder.n_files() == 0);
  };
  refused("surface " + *entry + " --select //Q" + output, 2, "--select '//Q' selects no atom");
  refused("surface " + *entry + " --ionic-strength 0.1" + output, 2, "is of computed potentials, and none is computed");
  refused("surface " + *entry + " --potential pb --map x.dx" + output, 2, "leave out one of them");
  refused("potential " + *entry + " --select //Q -o " + folder.file("p.dx"), 2, "--select '//Q' selects no atom");
  refused("potential " + *entry + " --leave-out '(HEM)' --ligands files -o " + folder.file("p.dx"), 2,
          has_pdb2pqr() ? "get no charges" : "");
}

TEST_CASE("compare: a PSF beside a structure that PDB2PQR charged is named with the option that takes it") {
  const auto pdb = real_input("ubq/ubq.pdb"), psf = real_input("ubq/ubq.psf"), pqr = real_input("ubq/ubq.pqr");
  if (!pdb || !psf || !pqr || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  const std::string a = folder.write("a.pdb", read_file(*pdb)), topology = folder.write("a.psf", read_file(*psf));
  const std::string hint = "source-topology " + topology + " takes those of the file beside it";
  const std::string unasked = run("compare " + a + " " + *pqr, folder.file("unasked"))["warnings"].dump();
  CHECK_MESSAGE(contains(unasked, hint), unasked);
  CHECK_FALSE(contains(unasked, "target-topology"));
  const std::string taken =
      run("compare " + a + " " + *pqr + " --source-topology " + topology, folder.file("taken"))["warnings"].dump();
  CHECK_FALSE(contains(taken, "-topology"));
}

TEST_CASE("MOL2 files: states of comparisons, and frames of trajectories without VMD") {
  const auto first = real_input("series19_ubq_2k39/m00.pqr"), second = real_input("series19_ubq_2k39/m05.pqr");
  if (!first || !second) return;
  const ScratchFolder folder;
  const auto write = [&](const std::string& pqr, const std::string& name) {
    return folder.write(name, mol2_of(espdiff::read_structure(pqr, {1, true, true, {}})));
  };
  const std::string a = write(*first, "a.mol2"), b = write(*second, "b.mol2");
  const Json pqr = run("compare " + *first + " " + *second, folder.file("pqr")),
             mol2 = run("compare " + a + " " + b, folder.file("mol2"));
  CHECK(mol2["potential"]["label"] == "Poisson-Boltzmann, 0.15 mol/l");
  CHECK(mol2["radii_origin"]["source"] == "element");
  CHECK(mol2["n_paired_atoms"] == pqr["n_paired_atoms"]);
  CHECK(mol2["rmsd_A"].get<double>() == doctest::Approx(pqr["rmsd_A"].get<double>()).epsilon(1e-4));
  const std::string table = folder.file("frames.csv");
  const Outcome frames = run_espdiff("trajectory " + a + " " + b + " --potential pb" + kQuick + table);
  REQUIRE_MESSAGE(frames.status == 0, frames.err);
  const espdiff::CsvTable read = espdiff::read_csv(table);
  REQUIRE(read.rows.size() == 1);
  CHECK(std::stod(read.rows[0].at(read.require("mean_abs_difference"))) ==
        doctest::Approx(mol2["mean_abs_difference"].get<double>()).epsilon(1e-6));
}
