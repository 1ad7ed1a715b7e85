// check_outputs.cpp: an output that is an input, by whatever name, is refused; so are two outputs of one name.
#include "io/files/check_outputs.h"

#include <unistd.h>

#include "base/error.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff;
using namespace espdiff_test;

TEST_CASE("one file by other names: links of both kinds, ways through folders, and names that do not exist yet") {
  const ScratchFolder folder;
  const std::string a = folder.write("a", "x"), b = folder.write("b", "x");
  std::filesystem::create_symlink("a", folder.file("soft"));
  std::filesystem::create_hard_link(a, folder.file("hard"));
  std::filesystem::create_directory(folder.file("sub"));
  std::filesystem::create_directory_symlink(folder.file(""), folder.file("sub/up"));
  std::filesystem::create_symlink("new", folder.file("dangling"));
  const auto is_one = [](const std::string& input, const std::string& output) {
    return message_of([&] { check_outputs({input}, {output}); }) != "(nothing thrown)";
  };
  CHECK(is_one(a, a));
  CHECK_FALSE(is_one(a, b));
  for (const char* name : {"soft", "hard", "./a", "sub/../a", "sub/up/a"}) CHECK(is_one(a, folder.file(name)));
  CHECK(is_one(folder.file("new"), folder.file("sub/../new")));
  CHECK(is_one(folder.file("new"), folder.file("dangling")));
  CHECK_FALSE(is_one(folder.file("new"), folder.file("newer")));
  CHECK_FALSE(is_one(folder.file("no/new"), folder.file("new")));
  CHECK_FALSE(is_one("/dev/null", a));
}

TEST_CASE("check_outputs names both files") {
  const ScratchFolder folder;
  const std::string a = folder.write("a", "x"), out = folder.file("out"), other = folder.file("./out");
  CHECK_NOTHROW(check_outputs({a, "", "absent"}, {out, "", ""}));
  CHECK(message_of([&] {
          check_outputs({a}, {out, a});
        }) == "an output would replace an input: '" + a + "'; choose another name for the output");
  const std::string link = folder.file("link");
  std::filesystem::create_symlink("a", link);
  CHECK(message_of([&] { check_outputs({a}, {link}); }) ==
        "an output would replace an input: '" + link + "' and '" + a +
            "', which are one file; choose another name for the output");
  CHECK(message_of([&] {
          check_outputs({}, {out, other});
        }) == "two outputs would have one name: '" + out + "' and '" + other +
                  "', which are one file; choose another for one of them");
}

TEST_CASE("check_outputs keeps a file that is there unless it may be replaced; a device is no file") {
  const ScratchFolder folder;
  const std::string there = folder.write("there", "x");
  CHECK(message_of([&] {
          check_outputs({}, {folder.file("new"), there}, false);
        }) == there + " exists; overwrite replaces it, another name keeps it");
  CHECK_NOTHROW(check_outputs({}, {there}, true));
  CHECK_NOTHROW(check_outputs({}, {folder.file("new"), "", "/dev/null"}, false));
}

TEST_CASE("a name that no JSON could hold is refused, whether it is read or written") {
  const auto refusal = [](const std::string& input, const std::string& output) {
    return message_of([&] { check_outputs({input}, {output}); });
  };
  // Latin-1, a lone continuation, cut off, too long for what it is, a surrogate, beyond the last character.
  for (const char* name : {"caf\xe9.pqr", "\x80", "\xe6\xbc", "\xc0\xaf", "\xe0\x9f\xbf", "\xf0\x8f\xbf\xbf",
                           "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xff"}) {
    CHECK(contains(refusal(name, "out"), "': this name is not UTF-8, so that no result can name the file; rename it"));
    CHECK(refusal("in", name) == refusal(name, "out"));
  }
  CHECK(refusal("caf\xe9.pqr", "out").rfind("'caf?.pqr'", 0) == 0);
  for (const char* name : {"caf\xc3\xa9", "\xe6\xbc\xa2\xe5\xad\x97", "\xf0\x9d\x94\xb8", "\xef\xbf\xbd",
                           "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf", "a\nb"})
    CHECK_NOTHROW(check_outputs({name}, {"out"}));
}
