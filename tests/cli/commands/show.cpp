// show.cpp: the short answer of `espdiff compare`, and the whole of it by `espdiff show`.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_espdiff.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

/// Two rows of charged atoms that are compared with what most options add to a result.
struct ShownPair {
  ScratchFolder folder;
  std::string call;
  ShownPair() {
    const std::string a = folder.write("a.pqr", row_of_atoms(12)), b = folder.write("b.pqr", row_of_atoms(12, 0.25));
    call = "compare " + a + " " + b + " --device cpu --pb-spacing 1 --offset 0,1 --region //A/2-4 --causes region " +
           "--exit-zero --no-trials --overwrite -o " + folder.file("out");
  }
  std::string json() const { return folder.file("out.json"); }
  void change(const std::string& pointer, const nlohmann::ordered_json& value) const {
    nlohmann::ordered_json record = nlohmann::ordered_json::parse(read_file(json()));
    record[nlohmann::ordered_json::json_pointer(pointer)] = value;
    folder.write("out.json", record.dump());
  }
};

}  // namespace

TEST_CASE("compare prints the verdict first, the numbers next, and names the command that prints the rest") {
  const ShownPair pair;
  const Outcome answer = run_espdiff(pair.call);
  REQUIRE_MESSAGE(answer.status == 0, answer.err);
  const nlohmann::ordered_json record = nlohmann::ordered_json::parse(read_file(pair.json()));
  CHECK(answer.out.rfind(record["certificate"]["verdict"].get<std::string>(), 0) == 0);
  std::size_t at = 0;
  for (const char* part : {"\nMean absolute difference ", "\nMean signed difference ", "\nRegion ", "\nSource ",
                           "\nPotential ", "\nCauses of the difference, region\n", "\nEvery number: espdiff show "}) {
    const std::size_t found = answer.out.find(part);
    CHECK_MESSAGE(found != std::string::npos, part);
    CHECK_MESSAGE(found >= at, part);
    at = found;
  }
  CHECK(!contains(answer.out, "Certificate"));
  const Outcome brief = run_espdiff("show --brief " + pair.json());
  CHECK(brief.status == 0);
  CHECK(answer.out.rfind(brief.out, 0) == 0);
}

TEST_CASE("the answer has twenty lines without its causes, however much there is to say; show prints the rest") {
  const ShownPair pair;
  REQUIRE(run_espdiff(pair.call).status == 0);
  nlohmann::ordered_json notes, warnings;
  for (int i = 0; i < 9; ++i) {
    notes.push_back({{"label", "Note " + std::to_string(i)}, {"text", std::string(150, 'n')}});
    warnings.push_back("warning " + std::to_string(i) + " " + std::string(150, 'w'));
  }
  pair.change("/notes", notes);
  pair.change("/warnings", warnings);
  pair.change("/causes", nlohmann::ordered_json::array());
  pair.change("/certificate/trustworthy", true);
  const Outcome brief = run_espdiff("show --brief " + pair.json());
  CHECK_MESSAGE(n_lines(brief.out) == 19, brief.out);  // the twentieth names the command that prints the rest
  CHECK(contains(brief.out, "\nSource "));
  CHECK(contains(brief.out, "\nPotential "));
  CHECK_MESSAGE(contains(brief.out, "\nWarnings, 3 of 9\n  - warning 0 "), brief.out);
  const Outcome full = run_espdiff("show " + pair.json());
  for (const char* text : {"Note 8", "warning 8"}) CHECK(contains(full.out, text));
  // What refuses is said once.
  pair.change("/certificate/trustworthy", false);
  pair.change("/certificate/reasons", nlohmann::ordered_json::array({warnings[0]}));
  CHECK(contains(run_espdiff("show --brief " + pair.json()).out, " of 8\n  - warning 1 "));
}

TEST_CASE("show prints what compare --full prints, from the files alone") {
  const ShownPair pair;
  const Outcome full = run_espdiff(pair.call + " --full");
  REQUIRE_MESSAGE(full.status == 0, full.err);
  for (const char* part : {"\nSuperposition\n", "\nRead outside the surfaces by", "\nCertificate\n", "\nRegion: "})
    CHECK_MESSAGE(contains(full.out, part), part);
  for (const std::string& name : {pair.json(), pair.folder.file("out"), pair.folder.file("out.vtp")})
    CHECK(run_espdiff("show " + name).out == full.out);
}

TEST_CASE("a result that is refused is shown with its reasons; control characters are not") {
  const ShownPair pair;
  REQUIRE(run_espdiff(pair.call).status == 0);
  pair.change("/certificate/trustworthy", false);
  pair.change("/certificate/verdict", "NOT TRUSTWORTHY");
  pair.change("/certificate/reasons", {"the map of the source does not belong to it"});
  pair.change("/names/source", "a\033[2Jb");
  const Outcome brief = run_espdiff("show --brief " + pair.json());
  CHECK(brief.status == 0);
  CHECK(brief.out.rfind("NOT TRUSTWORTHY:\n  - the map of the source does not belong to it\n", 0) == 0);
  CHECK(contains(brief.out, "a?[2Jb"));
}

TEST_CASE("show survives records with other types in every place") {
  const ShownPair pair;
  REQUIRE(run_espdiff(pair.call).status == 0);
  const std::string text = read_file(pair.json());
  const nlohmann::ordered_json record = nlohmann::ordered_json::parse(text);
  for (const auto& item : record.items()) {
    const std::string key = item.key();
    for (const nlohmann::ordered_json& other :
         {nlohmann::ordered_json(1), nlohmann::ordered_json("x"), nlohmann::ordered_json::array({1, "x"})}) {
      nlohmann::ordered_json changed = record;
      changed[key] = other;
      pair.folder.write("out.json", changed.dump());
      const Outcome shown = run_espdiff("show " + pair.json());
      const bool is_remedy = contains(shown.err, "compare again") || contains(shown.err, "compute the result again");
      const bool is_answer = shown.status == 0 || (shown.status == 2 && is_remedy);
      CHECK_MESSAGE(is_answer, key << ": " << other.dump() << ": " << shown.err);
    }
  }
}

TEST_CASE("two models of one file are told apart") {
  const ScratchFolder folder;
  const std::string both = folder.write("both.pqr", "MODEL        1\n" + row_of_atoms(12) + "ENDMDL\nMODEL        2\n" +
                                                        row_of_atoms(12, 0.25) + "ENDMDL\n");
  const Outcome answer = run_espdiff("compare " + both + " " + both +
                                     " --target-model 2 --potential none --exit-zero -o " + folder.file("out"));
  REQUIRE_MESSAGE(answer.status == 0, answer.err);
  CHECK_MESSAGE(contains(answer.out, "both.pqr\nTarget "), answer.out);
  CHECK_MESSAGE(contains(answer.out, "both.pqr, model 2\n"), answer.out);
  CHECK(contains(run_espdiff("show " + folder.file("out")).out, "both.pqr, model 2\n"));
  REQUIRE(run_espdiff("report " + folder.file("out")).status == 0);
  const std::string page = read_file(folder.file("out.html"));
  CHECK(contains(page, "both.pqr, model 2 against both.pqr"));
  CHECK(contains(page, "Target: both.pqr, model 2"));
  const std::string many = folder.file("many/");
  REQUIRE(run_espdiff("compare " + both + " " + both + " --target-model 2 --potential none --exit-zero -o " + many)
              .status == 0);
  CHECK(std::filesystem::exists(many + "both_both-model2.json"));
}

TEST_CASE("what is no comparison is refused in one line") {
  const ScratchFolder folder;
  const Outcome other = run_espdiff("show " + folder.write("out.json", "{}"));
  CHECK(other.status == 2);
  CHECK(contains(other.err, "not a record that `espdiff compare` wrote; compare again"));
  const Outcome none = run_espdiff("show " + folder.file("none"));
  CHECK(none.status == 2);
  CHECK(contains(none.err, "none.json: cannot be read: No such file or directory; give the prefix OUT of a result"));
}
