// verify.cpp: `espdiff verify OUT`.
#include "base/error.h"
#include "base/formatted.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#if defined(ESPDIFF_HAVE_VTK)
#include <iostream>

#include "verify/verify.h"
#endif

namespace espdiff::cli {

#if defined(ESPDIFF_HAVE_VTK)
namespace {

int verify_verb(const std::string& prefix) {
  const Verification verification = verify(prefix);
  std::cout << formatted("%-58s %12s %12s %10s\n", "Number", "recorded", "recomputed", "tolerance");
  std::size_t n_different = 0;
  for (const VerifiedLine& line : verification.lines) {
    n_different += line.agrees() ? 0 : 1;
    std::cout << formatted("%-58s %12.6g %12.6g %10.2g%s\n", line.name.c_str(), line.recorded, line.recomputed,
                           line.tolerance, line.agrees() ? "" : "  DIFFERS");
  }
  std::cout << formatted("\nNot recomputed:\n");
  for (const std::string& name : verification.not_recomputed) std::cout << formatted("  - %s\n", name.c_str());
  if (n_different == 0) {
    std::cout << formatted("\nVERIFIED: %zu numbers agree\n", verification.lines.size());
    return 0;
  }
  std::cout << formatted("\nNOT VERIFIED: %zu of %zu numbers differ\n", n_different, verification.lines.size());
  return 1;
}

}  // namespace

Verb add_verify(CLI::App& app) {
  auto prefix = std::make_shared<std::string>();
  CLI::App* parser = app.add_subcommand("verify", "Recompute a result from its files by other code");
  parser->footer("Exit status 1 if a number differs.");
  parser->add_option("OUT", *prefix, "Prefix of OUT.json and OUT.vtp; the inputs must be where they were")->required();
  set_help(*parser, {"", {"espdiff compare a.pqr b.pqr -o result && espdiff verify result"}});
  return {parser, [prefix](const Context&) { return verify_verb(*prefix); }};
}

#else

Verb add_verify(CLI::App& app) {
  CLI::App* parser = app.add_subcommand("verify", "Recompute a result from its files (not in this build)");
  parser->allow_extras();
  return {
      parser, [](const Context&) -> int {
        throw InputError("this build cannot verify: VTK 9 was not found when it was configured (Debian: libvtk9-dev)");
      }};
}

#endif

}  // namespace espdiff::cli
