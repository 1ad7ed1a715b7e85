// fields.cpp: fields besides the potential through a whole comparison.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "compare/compare.h"
#include "compare/made_side.h"
#include "cuda/surface/back_ends.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/grids/write_grid.h"
#include "options/settings.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::FieldRequest;
using espdiff::FieldResult;
using espdiff::SurfaceParts;

namespace {

/// A table of the atoms with a value each.
template <typename Value>
std::string table_of(const Molecule& m, const Value& value) {
  std::string text = "chain,residue_number,atom_name,value\n";
  for (std::size_t i = 0; i < m.size(); ++i) {
    const espdiff::Residue& residue = m.residues[static_cast<std::size_t>(m.atoms[i].residue)];
    text += residue.chain + "," + std::to_string(residue.number) + "," + m.atoms[i].name + "," +
            std::to_string(value(i)) + "\n";
  }
  return text;
}

CompareOptions with_fields(std::vector<FieldRequest> fields) {
  CompareOptions options = quick_options();
  options.fields = std::move(fields);
  return options;
}

CompareResult compared(Engine& engine, const Side& source, const Side& target, const CompareOptions& options) {
  return compare(engine, source.input(), target.input(), options, {});
}

double largest_difference(const FieldResult& field) {
  double largest = 0;
  for (std::size_t v = 0; v < field.source.size(); ++v) {
    const double d = std::fabs(static_cast<double>(field.target[v]) - static_cast<double>(field.source[v]));
    if (std::isfinite(d)) largest = std::max(largest, d);
  }
  return largest;
}

}  // namespace

TEST_SUITE_BEGIN("fields");

TEST_CASE("a linear function of the place does not change with a rigid motion, nor a constant with any") {
  const ScratchFolder folder;
  const Side source = make_side(1, 0);
  Side moved = source, bent = make_side(1, 0.3);
  const auto motion = rigid({0, 0.6, 0.8}, 0.7, {11, -4, 6});
  for (auto& p : moved.molecule.positions) p = motion.apply(p);
  const std::string linear = folder.write("linear.csv", table_of(source.molecule, [&](std::size_t i) {
                                            const Vec3d p = source.molecule.positions[i];
                                            return 0.3 * p.x - 0.2 * p.y + 0.7 * p.z + 5;
                                          }));
  const std::string constant = folder.write("constant.csv", table_of(source.molecule, [](std::size_t) { return 0.7; }));
  const CompareOptions options =
      with_fields({{"linear", "atoms:" + linear}, {"constant", "atoms:" + constant}, {"charge", "charge"}});
  for (const auto& engine : back_ends()) {
    const CompareResult same = compare(*engine, source.shape(), source.shape(), options, {}),
                        r = compare(*engine, source.shape(), moved.shape(), options, {}),
                        other = compare(*engine, source.shape(), bent.shape(), options, {});
    REQUIRE(r.fields.size() == 3);
    CHECK(r.fields[0].metrics.area_A2 > 100);
    CHECK(r.fields[0].metrics.mean_abs_difference < 1e-4);  // of values up to 10
    CHECK(r.fields[0].metrics.correlation > 0.999999);
    CHECK(largest_difference(same.fields[0]) < 1e-4);
    CHECK(same.fields[2].metrics.mean_abs_difference < 1e-6);
    for (const CompareResult* result : {&same, &r, &other}) {
      CHECK(largest_difference(result->fields[1]) == 0);
      CHECK(std::isnan(result->fields[1].metrics.correlation));
    }
    CHECK(other.fields[0].metrics.mean_abs_difference > 0.01);
  }
}

TEST_CASE("the potential's numbers do not depend on other fields, and the mapping is one") {
  const Side source = make_side(1, 0), target = make_side(1, 0.3);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const CompareResult without = compared(*engine, source, target, quick_options()),
                      with = compared(*engine, source, target, with_fields({{"charge", "charge"}}));
  CHECK(hash_of(without) == hash_of(with));
  CHECK(with.fields.at(0).metrics.area_A2 == with.potential.metrics.area_A2);  // the same trusted area
}

TEST_CASE("fields have the same bits for 1, 2 and 4 threads") {
  const Side source = make_side(1, 0), target = make_side(1, 0.3);
  std::vector<std::uint64_t> hashes;
  for (const int n_threads : {1, 2, 4}) {
    const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, n_threads);
    const CompareResult r =
        compared(*engine, source, target,
                 with_fields({{"charge", "charge"}, {"lipo", "lipophilicity"}, {"h", "hydrophobicity"}}));
    Hash hash;
    for (const FieldResult& f : r.fields) {
      hash.add(f.source).add(f.target).add(f.metrics.mean_abs_difference).add(f.metrics.correlation);
      for (const auto& row : f.residues) hash.add(row.mean_source).add(row.mean_abs_difference);
    }
    hashes.push_back(hash.value());
  }
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] == hashes[2]);
}

TEST_CASE("residues and parts have the means of their own area") {
  const Side source = make_side(1, 0), target = make_side(1, 0.3);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  espdiff::CompareInput input = source.input();
  input.parts.region.assign(source.molecule.residues.size(), 0);
  for (const std::size_t r : {2, 3, 4}) input.parts.region[r] = 1;
  input.parts.patches.push_back({"site", input.parts.region});
  const CompareResult r = compare(*engine, input, target.input(), with_fields({{"charge", "charge"}}), {});
  const FieldResult& field = r.fields.at(0);
  double area = 0, sum = 0;
  for (const auto& row : field.residues) {
    if (!(row.area_A2 > 0)) continue;
    area += row.area_A2;
    sum += row.area_A2 * row.mean_abs_difference;
  }
  CHECK(sum / area == doctest::Approx(field.metrics.mean_abs_difference).epsilon(0.02));
  REQUIRE(r.parts.size() == 2);
  REQUIRE(r.parts[0].fields.size() == 1);
  const auto& part = r.parts[0].fields[0].metrics;
  CHECK(part.area_A2 > 0);
  CHECK(part.area_A2 < 0.9 * field.metrics.area_A2);
  CHECK(r.parts[1].fields.at(0).metrics.mean_abs_difference == part.mean_abs_difference);
}

TEST_CASE("atoms without a value leave vertices out, which are counted") {
  const ScratchFolder folder;
  const Side source = make_side(1, 0), target = make_side(1, 0.3);
  std::string text = "chain,residue_number,value\n";
  for (int r = 1; r <= 6; ++r) text += "A," + std::to_string(r) + "," + (r == 3 ? "nan" : std::to_string(r)) + "\n";
  const std::string path = folder.write("half.csv", text);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const CompareResult r = compared(*engine, source, target, with_fields({{"half", "residues:" + path}}));
  const FieldResult& field = r.fields.at(0);
  CHECK(field.n_missing_source > 0);
  CHECK(field.n_missing_target > 0);
  CHECK(field.metrics.area_A2 < 0.8 * r.potential.metrics.area_A2);
  CHECK(std::isfinite(field.metrics.mean_abs_difference));
  REQUIRE(!r.inputs.warnings.empty());
  CHECK(r.inputs.warnings.back().text.plain() ==
        "field half: " + path +
            ": 7 of 12 residues of the target (molecule.pqr) have no value there, the first is TYR 3 of chain A");
}

TEST_CASE("a map is read as the potential is, at the offset too") {
  const ScratchFolder folder;
  const Side source = make_side(1, 0), target = make_side(1, 0.3);
  const auto dx = [&](const char* name, const Grid& map) {
    espdiff::write_dx(folder.file(name), map);
    return folder.file(name);
  };
  const std::string from = dx("a.dx", source.map), to = dx("b.dx", target.map);
  for (const double offset_A : {0.0, 1.4}) {
    CompareOptions options = with_fields({{"same", "map:" + from + "," + to}});
    options.offsets_A = {offset_A};
    const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
    const CompareResult r = compared(*engine, source, target, options);
    CHECK(r.fields.at(0).metrics.mean_abs_difference ==
          doctest::Approx(r.potential.metrics.mean_abs_difference).epsilon(offset_A > 0 ? 0.05 : 1e-3));
    CHECK(r.fields.at(0).metrics.hodgkin_index ==
          doctest::Approx(r.potential.metrics.hodgkin_index).epsilon(offset_A > 0 ? 0.05 : 1e-3));
  }
}

TEST_CASE("a map that lies elsewhere compares nothing, which is said") {
  const ScratchFolder folder;
  const Side source = make_side(1, 0);
  Grid away = source.map;
  away.lattice.origin = away.lattice.origin + Vec3d{500, 0, 0};
  espdiff::write_dx(folder.file("away.dx"), away);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  const CompareResult r = compared(*engine, source, source, with_fields({{"water", "map:" + folder.file("away.dx")}}));
  CHECK(r.fields.at(0).metrics.area_A2 == 0);
  const std::string n = std::to_string(r.surface.positions.size());
  REQUIRE(!r.inputs.warnings.empty());
  CHECK(r.inputs.warnings.back().text.plain() ==
        "field water: no point has a value in both states (" + n + " vertices of the source and " + n +
            " of the target have none), so that nothing was compared; a map has to lie where its structure does");
}

TEST_CASE("a field that only one state has is refused before the work") {
  const Side source = make_side(1, 0);
  Side target = make_side(1, 0.3);
  target.molecule.charges.clear();
  target.molecule.name = "bare.pdb";
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  CHECK(message_of([&] {
          compare(*engine, source.shape(), target.shape(), with_fields({{"q", "charge"}}), {});
        }) ==
        "field q: the target (bare.pdb) has none of the field 'Charge', so that the states cannot be compared by "
        "it; leave the field out, or give a structure that has it");
}

TEST_SUITE_END();
