// message.cpp: options in messages are spelled by whoever shows them, and survive being put together and thrown.
#include "base/message.h"

#include <doctest/doctest.h>

#include "base/error.h"

using namespace espdiff;

namespace {

std::string dashed(const NamedOption& o) {
  return "--" + o.name + (o.is_switch ? "!" : o.value.empty() ? "" : "=" + o.value);
}

}  // namespace

TEST_CASE("a message is plain text, or text with its options spelled") {
  const Message message = "use a larger " + option("grid-spacing") + ", " + option("align", "none") + ", or " +
                          switched_on("overwrite") + std::string(" at last");
  CHECK(message.plain() == "use a larger grid-spacing, align none, or overwrite at last");
  CHECK(message.spelled(dashed) == "use a larger --grid-spacing, --align=none, or --overwrite! at last");
  CHECK(Message().empty());
  CHECK(Message("").plain().empty());
  Message twice = option("mu");
  twice += twice;
  CHECK(twice.plain() == "mumu");
}

TEST_CASE("text that looks like an option is left alone") {
  CHECK(Message("file --align none.pqr").spelled(dashed) == "file --align none.pqr");
}

TEST_CASE("an error says its options plainly, and keeps them for who spells them, also in another error") {
  try {
    try {
      throw FormatError("a.json", 3, "no " + option("scene"));
    } catch (const Error& error) {
      throw Error(error.error_class(), "frame 5: " + error.message());
    }
  } catch (const Error& error) {
    CHECK(std::string(error.what()) == "frame 5: a.json:3: no scene");
    CHECK(error.message().spelled(dashed) == "frame 5: a.json:3: no --scene");
    const Error copy = error;
    CHECK(copy.message().spelled(dashed) == "frame 5: a.json:3: no --scene");
  }
}
