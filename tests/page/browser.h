// browser.h: opens a page in headless Chromium, does what a person does, and returns what the page then shows.
#pragma once

#include <doctest/doctest.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "support/test_data.h"

namespace espdiff_test {

/// The document after `acts`, a script that runs when the page is ready and leaves what it sees in the root's
/// `data-seen`; nothing (after a line with SKIPPED) without Chromium. `data-failed` has errors of any script. The
/// window is `width` pixels wide.
inline std::optional<std::string> shown_in_browser(std::string page, const std::string& acts,
                                                   const ScratchFolder& folder, int width = 800) {
  if (std::system("command -v chromium >/dev/null") != 0) {
    MESSAGE("SKIPPED: chromium is not installed");
    return std::nullopt;
  }
  const std::string watched =
      "<script>window.onerror = (text) => { document.documentElement.dataset.failed = text; };"
      "const wait = setInterval(() => { if (!document.documentElement.dataset.ready) return; clearInterval(wait); " +
      acts + " }, 50);</script></body>";
  page.replace(page.rfind("</body>"), 7, watched);
  folder.write("page.html", page);
  const std::string command =
      "chromium --headless=new --no-sandbox --use-gl=angle --use-angle=swiftshader "
      "--enable-unsafe-swiftshader --virtual-time-budget=20000 --window-size=" +
      std::to_string(width) + ",600 --dump-dom file://" + folder.file("page.html") + " 2>/dev/null >" +
      folder.file("dom");
  REQUIRE(std::system(command.c_str()) == 0);
  return read_file(folder.file("dom"));
}

/// What stands in the script element of that id.
inline std::string element(const std::string& page, const std::string& id) {
  const std::size_t begin = page.find('>', page.find("id=\"" + id + "\"")) + 1;
  return page.substr(begin, page.find("</script>", begin) - begin);
}

}  // namespace espdiff_test
