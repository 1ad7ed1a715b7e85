// variants.cpp: labels, lists and groups, and what is wrong with them.
#include "matrix/variants.h"

#include <doctest/doctest.h>

#include "base/error.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff_test;  // NOLINT: a test
using espdiff::Variant;
using espdiff::VariantFiles;

namespace {

constexpr const char* kAtom = "ATOM  1  CA  ALA A  1  0.0 0.0 0.0  0.5 1.7\n";

/// A PQR of so many models.
std::string models(int n) {
  std::string text;
  for (int i = 1; i <= n; ++i) text += "MODEL " + std::to_string(i) + "\n" + kAtom + "ENDMDL\n";
  return text;
}

}  // namespace

TEST_SUITE_BEGIN("variants");

TEST_CASE("files are labelled by their names, models by their numbers, and equal names by their paths") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.file("other"));
  const std::string one = folder.write("one.pqr", models(1)), three = folder.write("three.pdb.pqr", models(3));
  const std::string twin = folder.write("other/one.pqr", models(1));
  const auto variants = espdiff::variants_of_files({one, three});
  REQUIRE(variants.size() == 4);
  CHECK(variants[0].label == "one");
  CHECK(variants[1].label == "three.pdb:1");
  CHECK(variants[3].label == "three.pdb:3");
  CHECK(variants[3].model == 3);
  const auto twins = espdiff::variants_of_files({one, twin});
  CHECK(twins[0].label == one);
  CHECK(twins[1].label == twin);
}

TEST_CASE("a list says what it wants, relative to its folder") {
  const ScratchFolder folder;
  folder.write("a.pqr", models(3));
  folder.write("a.dx", "map");
  const std::string list = folder.write("list.csv",
                                        "# solvents\nlabel,structure,model,map,unit,group\n"
                                        "water,a.pqr,2,a.dx,mV,A\n,a.pqr,1,,,B\nall,a.pqr,,,,\n");
  const auto variants = espdiff::read_variant_list(list);
  REQUIRE(variants.size() == 5);
  CHECK(variants[0].label == "water");
  CHECK(variants[0].model == 2);
  CHECK(variants[0].map == folder.file("a.dx"));
  CHECK(variants[0].map_unit == "mV");
  CHECK(variants[0].group == "A");
  CHECK(variants[1].label == "a");
  CHECK(variants[2].label == "all:1");
  CHECK(variants[4].label == "all:3");
}

TEST_CASE("a list that is wrong is refused with its line") {
  const ScratchFolder folder;
  folder.write("a.pqr", models(1));
  const auto refusal = [&](const std::string& text) {
    const std::string list = folder.write("list.csv", text);
    return message_of([&] { espdiff::read_variant_list(list); });
  };
  CHECK(contains(refusal("label\nx\n"), "there is no column 'structure'"));
  CHECK(contains(refusal("structure,colour\na.pqr,red\n"), "the column 'colour' means nothing here"));
  CHECK(contains(refusal("structure\na.pqr\nb.pqr\n"), "list.csv:3: there is no file"));
  CHECK(contains(refusal("structure,label\n,x\n"), "list.csv:2: the structure is missing"));
  CHECK(contains(refusal("structure,model\na.pqr,0\n"), "model: '0' is no number from 1 on"));
}

TEST_CASE("groups go by label") {
  const ScratchFolder folder;
  auto variants = espdiff::variants_of_files({folder.write("a.pqr", models(2))});
  espdiff::read_groups(folder.write("g.csv", "label,group\na:2,late\n"), variants);
  CHECK(variants[0].group.empty());
  CHECK(variants[1].group == "late");
  const auto refusal = [&](const std::string& text) {
    return message_of([&] { espdiff::read_groups(folder.write("g.csv", text), variants); });
  };
  CHECK(contains(refusal("label,group\nb,x\n"), "g.csv:2: there is no variant 'b'; the first one is labelled 'a:1'"));
  CHECK(contains(refusal("label,group\na:1,x\na:1,y\n"), "g.csv:3: the variant 'a:1' is in a group already"));
  CHECK(contains(refusal("label\na:1\n"), "there is no column 'group'"));
}

TEST_CASE("labels are there and differ") {
  CHECK(contains(message_of([] { espdiff::check_labels({"a", "b", "a"}); }), "two variants are labelled 'a'"));
  CHECK(contains(message_of([] { espdiff::check_labels({"a", ""}); }), "an empty label"));
}

TEST_CASE("maps in several units become those of the first; some with and some without are refused") {
  std::vector<Variant> variants(3);
  for (std::size_t i = 0; i < 3; ++i) {
    variants[i].label = "v" + std::to_string(i);
    variants[i].map = espdiff::Grid();
    variants[i].map->values = {2};
    variants[i].map->unit = espdiff::PotentialUnit::kMillivolt;
  }
  variants[2].map->unit = espdiff::PotentialUnit::kVolt;
  espdiff::unite_map_units(variants, 300);
  CHECK(variants[1].map->values[0] == 2);
  CHECK(variants[2].map->values[0] == doctest::Approx(2000));
  CHECK(variants[2].map->unit == espdiff::PotentialUnit::kMillivolt);
  variants[1].map->unit = espdiff::PotentialUnit::kUnknown;
  CHECK(
      contains(message_of([&] { espdiff::unite_map_units(variants, 300); }), "the unit of the map of 'v1' is unknown"));
  variants[1].map.reset();
  CHECK(contains(message_of([&] { espdiff::unite_map_units(variants, 300); }), "missing for the variant 'v1'"));
}

TEST_SUITE_END();
