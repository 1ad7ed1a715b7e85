// potential.cpp: `espdiff potential`, and `compare --potential pme`, through the command line.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "cli/run_espdiff.h"
#include "io/grids/read_grid.h"

using namespace espdiff_test;  // NOLINT: a test
using espdiff::read_grid;

namespace {

/// Models of a helix of charges; each turned and moved against the one before.
std::string helix(int n_models, bool with_cell = false) {
  std::string text;
  for (int model = 0; model < n_models; ++model) {
    if (with_cell) text += "CRYST1   40.000   41.000   42.000  90.00  90.00  90.00 P 1           1\n";
    text += "MODEL " + std::to_string(model + 1) + "\n";
    const double turn = 0.7 * model;
    for (int i = 0; i < 12; ++i) {
      const double angle = 1.7 * i + turn;
      char line[128];
      std::snprintf(line, sizeof line, "ATOM %d CA ALA %d %.6f %.6f %.6f %.4f 2.0\n", i + 1, i + 1,
                    2.3 * std::cos(angle) + model, 2.3 * std::sin(angle), 1.5 * i, i % 3 == 0 ? -0.7 : 0.4);
      text += line;
    }
    text += "ENDMDL\n";
  }
  return text;
}

/// pocketfft may be absent: then the command line says so.
bool lacks_fourier(const Outcome& outcome) {
  if (outcome.status != 1 || !contains(outcome.err, "has no pocketfft")) return false;
  MESSAGE("SKIPPED: ", outcome.err);
  return true;
}

}  // namespace

TEST_CASE("potential: a map as DX and as VTI, the same values, mean zero") {
  const ScratchFolder folder;
  const std::string molecule = folder.write("a.pqr", helix(1));
  const Outcome dx = run_espdiff("potential " + molecule + " --device cpu -o " + folder.file("a.dx"));
  if (lacks_fourier(dx)) return;
  CHECK_MESSAGE(dx.status == 0, dx.err);
  CHECK(contains(dx.out, "kT/e"));
  const espdiff::Grid map = read_grid(folder.file("a.dx"));
  CHECK(map.unit == espdiff::PotentialUnit::kKtPerE);
  double sum = 0, most = 0;
  for (const float v : map.values) {
    sum += static_cast<double>(v);
    most = std::max(most, std::fabs(static_cast<double>(v)));
  }
  CHECK(most > 1);
  CHECK(std::fabs(sum) < 1e-5 * most * static_cast<double>(map.values.size()));
  CHECK(run_espdiff("potential " + molecule + " --device cpu -q -o " + folder.file("a.vti")).status == 0);
  CHECK(read_grid(folder.file("a.vti")).values == map.values);
  // Any number of threads, the same file.
  CHECK(run_espdiff("potential " + molecule + " --device cpu --threads 4 -q -o " + folder.file("b.dx")).status == 0);
  CHECK(read_file(folder.file("a.dx")) == read_file(folder.file("b.dx")));
}

TEST_CASE("a verb whose output is not named names it after its input, in the working folder, and never replaces it") {
  const ScratchFolder folder;
  folder.write("helix.pqr", helix(1));
  const std::string here = "cd " + folder.file("") + "; ";
  for (const auto& [command, output] : std::vector<std::pair<std::string, std::string>>{
           {"potential helix.pqr --method coulomb", "helix.dx"}, {"surface helix.pqr", "helix.vtp"}}) {
    const Outcome first = run_espdiff(command + " --device cpu", here);
    CHECK_MESSAGE(first.status == 0, first.err);
    CHECK(contains(first.out, "written        " + output + "\n"));
    CHECK(std::filesystem::exists(folder.file(output)));
    const Outcome second = run_espdiff(command + " --device cpu", here);
    CHECK(second.status == 2);
    CHECK(contains(second.err, output));
    CHECK(contains(second.err, "--overwrite"));
  }
  // A structure with charges is prepared into itself.
  const Outcome prepare = run_espdiff("prepare helix.pqr", here);
  CHECK(prepare.status == 2);
  CHECK(contains(prepare.err, "helix.pqr"));
}

TEST_CASE("potential: frames, their mean, variance and error, superposed") {
  const ScratchFolder folder;
  const std::string molecule = folder.write("a.pqr", helix(4));
  const std::string start = "potential " + molecule + " --device cpu -q --grid 1.2 ";
  const Outcome outcome = run_espdiff(start + "--align all --variance " + folder.file("v.dx") + " --standard-error " +
                                      folder.file("e.dx") + " --block 2 -o " + folder.file("m.dx"));
  if (lacks_fourier(outcome)) return;
  CHECK_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(folder.n_files() == 4);
  // Frames differ by a rigid motion: superposed, they are one.
  const auto mean = read_grid(folder.file("m.dx")), variance = read_grid(folder.file("v.dx"));
  double most = 0, spread = 0;
  for (const float v : mean.values) most = std::max(most, std::fabs(static_cast<double>(v)));
  for (const float v : variance.values) spread = std::max(spread, std::sqrt(static_cast<double>(v)));
  CHECK(spread < 1e-3 * most);
  CHECK(run_espdiff(start + "--averaging each --frames 1:2:end -o " + folder.file("each.dx")).status == 0);
  CHECK(std::filesystem::exists(folder.file("each.0001.dx")));
  CHECK(std::filesystem::exists(folder.file("each.0003.dx")));
  CHECK(folder.n_files() == 6);
}

TEST_CASE("potential: cells from CRYST1, --cell and --xscfile agree; PMEPot's mode and Coulomb's law run") {
  const ScratchFolder folder;
  const std::string with_cell = folder.write("a.pqr", helix(1, true)), bare = folder.write("b.pqr", helix(1));
  const auto map = [&](const std::string& arguments) {
    const Outcome outcome =
        run_espdiff("potential " + arguments + " --device cpu --overwrite -q -o " + folder.file("m.dx"));
    CHECK_MESSAGE(outcome.status == 0, outcome.err);
    return read_grid(folder.file("m.dx"));
  };
  if (lacks_fourier(run_espdiff("potential " + bare + " --device cpu --overwrite -q -o " + folder.file("m.dx"))))
    return;
  const auto own = map(with_cell);
  CHECK(own.lattice.size == std::array<int, 3>{40, 42, 42});
  // The centre of the atoms, to the digits of DX.
  const auto& l = own.lattice;
  espdiff::Vec3d centre = l.origin;
  for (std::size_t axis = 0; axis < 3; ++axis) centre += (0.5 * (l.size[axis] - 1)) * l.step[axis];
  char cell[256], xsc[256];
  std::snprintf(cell, sizeof cell, "'{{%.12g %.12g %.12g} {40 0 0} {0 41 0} {0 0 42}}'", centre.x, centre.y, centre.z);
  std::snprintf(
      xsc, sizeof xsc,
      "#$LABELS step a_x a_y a_z b_x b_y b_z c_x c_y c_z o_x o_y o_z\n0 40 0 0 0 41 0 0 0 42 %.12g %.12g %.12g\n",
      centre.x, centre.y, centre.z);
  for (const auto& given : {map(bare + " --cell " + cell), map(bare + " --xscfile " + folder.write("a.xsc", xsc))}) {
    double difference = 0;
    for (std::size_t i = 0; i < own.values.size(); ++i)
      difference = std::max(difference, std::fabs(static_cast<double>(own.values[i] - given.values[i])));
    CHECK(difference < 1e-4);
  }
  CHECK(map(with_cell + " --compatible").lattice.size == std::array<int, 3>{40, 48, 48});
  CHECK(map(bare + " --method coulomb --dielectric 4 --distance-dependent --grid 20").values.size() == 8000);
  CHECK(map(bare + " --precision double --spline 8 --ewaldfactor 0.3 --pad 6").values.size() > 0);
}

TEST_CASE("potential: wrong input gives one line and leaves nothing") {
  const ScratchFolder folder;
  const std::string molecule = folder.write("a.pqr", helix(2));
  const std::string no_charge =
      folder.write("zero.pqr", "ATOM 1 CA ALA 1 0 0 0 0.0 2.0\nATOM 2 CA ALA 2 3 0 0 0.0 2.0\n");
  const std::string plain =
      folder.write("a.pdb", "ATOM      1  CA  ALA A   1       0.000   0.000   0.000  1.00  0.00           C\n");
  const std::size_t n_before = folder.n_files();
  struct Case {
    std::string arguments;
    const char* expected;
  };
  for (const Case& c :
       {Case{no_charge, "zero.pqr: has no charges"},
        {plain, "has no charges"},
        {molecule + " --frames 2", "frame 2 is not among the frames 0 to 1"},
        {molecule + " --cell '0 0 0'", "has 3 numbers; give twelve"},
        {molecule + " --cell '0 0 0 10 0 0 0 10 0 0 0 -10'", "must be positive"},
        {molecule + " --cell '0 0 0 10 0 0 20 0 0 0 0 10'", "span a volume of 0"},
        {molecule + " --grid 0", "not above 0"},
        {molecule + " --grid '8 8'", "has 2 numbers"},
        {molecule + " --grid '4 8 8'", "each edge needs 6"},
        {molecule + " --grid 4096 --precision double", "would fit"},
        {molecule + " --order 12", "--spline: '12' is not a whole number from 4 to 8"},
        {molecule + " --compatible --order 6", "PMEPot's is 4"},
        {molecule + " --compatible --align ca", "`compatible` with superposition"},
        {molecule + " --cell '0 0 0 9 0 0 0 9 0 0 0 9' --pad 3", "a cell and a padding"},
        {molecule + " --method coulomb --dielectric 0", "--dielectric: '0' is not a number from 0.001 to 1e+06"},
        {molecule + " --variance " + folder.file("v.dx") + " --frames 0", "need at least 2 frames"},
        {folder.file("absent.pqr"), "absent.pqr"}}) {
    const Outcome outcome =
        run_espdiff("potential " + c.arguments + " --device cpu --overwrite -o " + folder.file("m.dx"));
    CAPTURE(c.arguments);
    if (lacks_fourier(outcome)) continue;
    CHECK_MESSAGE(outcome.status != 0, outcome.err);
    CHECK_MESSAGE(contains(outcome.err, c.expected), outcome.err);
    CHECK(n_lines(outcome.err) <= 2);  // usage is followed by where help is
    CHECK(outcome.out.empty());
    CHECK(folder.n_files() == n_before);
  }
  CHECK(contains(run_espdiff("potential " + molecule + " -o " + folder.file("m.ccp4")).err, "ends in .dx or .vti"));
  CHECK(contains(run_espdiff("potential " + molecule + " -o " + folder.file("absent/m.dx")).err, "absent"));
  CHECK(folder.n_files() == n_before);
}

TEST_CASE("compare --potential pme computes both maps; without charges it is refused") {
  const ScratchFolder folder;
  const std::string molecule = folder.write("a.pqr", row_of_atoms(8)),
                    other = folder.write("b.pqr", row_of_atoms(8, 0.2));
  const std::string start = "compare " + molecule + " " + other + " -o " + folder.file("out") + " --device cpu ";
  const Outcome outcome = run_espdiff(start + "--potential pme --ewaldfactor 0.3 --pme-grid 1");
  if (lacks_fourier(outcome)) return;
  CHECK_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(contains(outcome.out, "kT/e"));
  CHECK(contains(read_file(folder.file("out.json")), "\"potential_unit\": \"kT/e in vacuum\""));
  // OUT.json tells of the maps what is needed to compute them again.
  const std::string json = read_file(folder.file("out.json"));
  for (const char* part : {"\"role\": \"source_map\"", "\"path\": \"pme of ", "\"n_charges\": 8",
                           "\"cell_from\": \"padded\"", "\"ewald_factor\": 0.3", "\"sampling\": \"spline\""})
    CHECK_MESSAGE(contains(json, part), part);
  for (const char* suffix : {".json", ".vtp", ".residues.csv"}) std::filesystem::remove(folder.file("out") + suffix);
  const std::string map = folder.write("a.dx", constant_dx(33, 2.0, 1.0));
  const Outcome both = run_espdiff(start + "--potential pme --source-map " + map);
  CHECK(both.status == 2);
  CHECK(contains(both.err, "--potential computes both maps"));
  const std::string plain =
      folder.write("a.pdb",
                   "ATOM      1  CA  ALA A   1       0.000   0.000   0.000  1.00  0.00           C\n"
                   "ATOM      2  CA  ALA A   2       3.800   0.000   0.000  1.00  0.00           C\n"
                   "ATOM      3  CA  ALA A   3       5.000   3.600   0.000  1.00  0.00           C\n");
  const std::size_t n_before = folder.n_files();
  const Outcome none = run_espdiff("compare " + plain + " " + plain + " -o " + folder.file("out") + " --potential pme");
  CHECK(none.status == 2);
  for (const char* part : {"has no charges", "PQR", "PSF", "prmtop"}) CHECK_MESSAGE(contains(none.err, part), none.err);
  CHECK(run_espdiff(start + "--potential apbs").status == 2);
  CHECK(folder.n_files() == n_before);
}

TEST_CASE("without maps and with charges Poisson-Boltzmann is computed, and the result says so") {
  const ScratchFolder folder;
  const std::string molecule = folder.write("a.pqr", row_of_atoms(8)),
                    other = folder.write("b.pqr", row_of_atoms(8, 0.2));
  const std::string start = "compare " + molecule + " " + other + " -o " + folder.file("out") + " --device cpu ";
  const Outcome usual = run_espdiff(start + "--pb-spacing 1");
  REQUIRE_MESSAGE(usual.status == 0, usual.err);
  CHECK(contains(usual.out, "\nPotential        Poisson-Boltzmann, 0.15 mol/l\n"));
  const Outcome whole = run_espdiff("show " + folder.file("out"));
  CHECK(contains(whole.out, "Poisson-Boltzmann, 0.15 mol/l (charges without explicit water in a periodic cell)"));
  CHECK(contains(whole.out, "Mean absolute difference         kT/e "));
  const std::string json = read_file(folder.file("out.json"));
  for (const char* part :
       {"\"path\": \"pb of ", "\"relative_residual\"", "\"cycles\"", "\"spacing_A\": 1.0", "\"zero\": \"far away\"",
        "\"ionic_strength_M\": 0.15", "\"vacuum\": false", "\"grid\"", "\"dielectric_boundary\": \"molecular\""})
    CHECK_MESSAGE(contains(json, part), part);
  const Outcome none = run_espdiff(start + "--potential none --overwrite");
  REQUIRE(none.status == 0);
  CHECK(contains(none.out, "\nMean displacement "));
  CHECK(contains(read_file(folder.file("out.json")), "\"potential_unit\": null"));
}

TEST_CASE("vacuum is named wherever its numbers are") {
  const ScratchFolder folder;
  const std::string molecule = folder.write("a.pqr", row_of_atoms(8)),
                    other = folder.write("b.pqr", row_of_atoms(8, 0.2));
  const Outcome outcome = run_espdiff("compare " + molecule + " " + other + " -o " + folder.file("out") +
                                      " --device cpu --potential coulomb");
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(contains(outcome.out, "vacuum (Coulomb)"));
  CHECK_MESSAGE(contains(outcome.out, " kT/e in vacuum  whole surface: "), outcome.out);
  CHECK(contains(read_file(folder.file("out.json")), "\"potential_unit\": \"kT/e in vacuum\""));
  CHECK(contains(read_file(folder.file("out.residues.csv")), "mean_source [kT/e in vacuum]"));
}

TEST_CASE("a molecule that Poisson-Boltzmann cannot take is refused by one line that says what to do") {
  const ScratchFolder folder;
  // Another charge and radius for the last atom, at the end of the text.
  const auto atoms = [&](const std::string& name, const std::string& charge_and_radius) {
    std::string text = row_of_atoms(8);
    text.resize(text.size() - 16);
    return folder.write(name, text + " " + charge_and_radius + "\n");
  };
  const std::string molecule = folder.write("a.pqr", row_of_atoms(8)), bare = atoms("bare.pqr", "0.5000 0.0000"),
                    fraction = atoms("fraction.pqr", "0.3000 1.8000"), out = folder.file("out");
  const std::string other = folder.write("b.pqr", row_of_atoms(8, 0.2)), end = " --device cpu -q -o " + out;
  const std::size_t n_before = folder.n_files();
  const auto refused = [&](const std::string& arguments, int status, const std::string& spacing = "1") {
    const Outcome outcome = run_espdiff("compare " + molecule + " " + arguments + end + " --pb-spacing " + spacing);
    CHECK(outcome.status == status);
    CHECK(folder.n_files() == n_before);
    return outcome.err;
  };
  CHECK(refused(bare, 2) ==
        "espdiff: " + bare +
            ": atom 8 has a charge of 0.5 and a radius of 0, and lies in no other atom: its charge would "
            "be bare in the solvent; give it a radius\n");
  CHECK(contains(refused(other + " --pb-max-cycles 1", 1),
                 "espdiff: " + molecule + ": the Poisson-Boltzmann equation did not converge: the relative error is "));
  CHECK(contains(refused(other + " --pb-max-cycles 1", 1),
                 " after 1 cycles, 0.0001 is asked for; allow more cycles, or a larger tolerance\n"));
  const std::string too_large = refused(other, 1, "0.018");
  CHECK(contains(too_large, "espdiff: " + molecule + ": a grid of "));
  CHECK(contains(too_large, " points needs "));
  CHECK(contains(too_large, " A would fit\n"));
  // A sum of charges that is not whole is a note, not an error.
  const Outcome noted = run_espdiff("compare " + molecule + " " + fraction + end + " --pb-spacing 1");
  REQUIRE_MESSAGE(noted.status == 0, noted.err);
  CHECK(contains(read_file(out + ".json"), "the charges of the target add up to "));
  CHECK(contains(read_file(out + ".json"), " e, which is not a whole number: atoms or charges may be missing"));
}

TEST_CASE("a molecule without charges is refused by each verb that was asked for pb, in one line") {
  const ScratchFolder folder;
  std::string text = row_of_atoms(8);
  for (std::size_t at = text.find(" 0.5000"); at != std::string::npos; at = text.find(" 0.5000")) text[at + 3] = '0';
  const std::string zero = folder.write("zero.pqr", text), charged = folder.write("a.pqr", row_of_atoms(8));
  const std::size_t n_before = folder.n_files();
  for (const std::string& call :
       {"compare " + charged + " " + zero, "trajectory " + charged + " " + zero, "matrix " + charged + " " + zero}) {
    const Outcome outcome = run_espdiff(call + " --potential pb --device cpu -o " + folder.file("out"));
    CAPTURE(call);
    CHECK(outcome.status == 2);
    CHECK_MESSAGE(contains(outcome.err, "zero.pqr"), outcome.err);
    CHECK_MESSAGE(contains(outcome.err, "charge"), outcome.err);
    CHECK(n_lines(outcome.err) == 1);
    CHECK(outcome.out.empty());
    CHECK(folder.n_files() == n_before);
  }
}

TEST_CASE("options of potentials that cannot be are refused in one line, and nothing is written") {
  const ScratchFolder folder;
  const std::string molecule = folder.write("a.pqr", row_of_atoms(8)),
                    other = folder.write("b.pqr", row_of_atoms(8, 0.2));
  const std::size_t n_before = folder.n_files();
  struct Case {
    std::string arguments, part;
  };
  for (const auto& c : std::vector<Case>{
           {"--ionic-strength -0.1", "--ionic-strength: '-0.1' is not a number from 0 to 100"},
           {"--solute-dielectric 0", "--solute-dielectric: '0' is not a number from 0.001 to 1e+06"},
           {"--solvent-dielectric -2", "--solvent-dielectric: '-2' is not a number from 0.001 to 1e+06"},
           {"--temperature 0", "--temperature: '0' is not a number from 1 to 100000"},
           {"--temperature -5", "--temperature: '-5' is not a number from 1 to 100000"},
           {"--solute-dielectric nan", "--solute-dielectric: 'nan' is not a number from 0.001 to 1e+06"},
           {"--potential coulomb --dielectric 0", "--dielectric: '0' is not a number from 0.001 to 1e+06"},
           {"--pb-spacing 0", "--pb-spacing: '0' is not a number from 0.001 to 20"},
           {"--pb-spacing 0.01", "has more than 2e9 points"},
           {"--pb-max-cycles 0", "--pb-max-cycles: '0' is not a whole number from 1 to 1000000"},
           {"--potential pme --ionic-strength 0.1", "ionic-strength is an option of the potential pb"},
           {"--potential none --dielectric 4", "--dielectric is of computed potentials, and none is computed"},
           {"--offset -1", "--offset: '-1' is not a distance of 0 to 20 Angstrom"}}) {
    const Outcome outcome =
        run_espdiff("compare " + molecule + " " + other + " -o " + folder.file("out") + " --device cpu " + c.arguments);
    CHECK_MESSAGE(outcome.status != 0, c.arguments);
    CHECK_MESSAGE(contains(outcome.err, c.part), c.arguments << ": " << outcome.err);
    CHECK(n_lines(outcome.err) <= 2);  // usage is followed by where help is
    CHECK(folder.n_files() == n_before);
  }
}
