// small_result.h: a small comparison that tests of `espdiff verify` change.
#pragma once

#include <doctest/doctest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_espdiff.h"

namespace espdiff_test {

using OrderedJson = nlohmann::ordered_json;

inline void write_file(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// Sets up a comparison of a small protein's models in a folder of its own; empty prefix without real inputs.
struct SmallResult {
  ScratchFolder folder;
  std::string prefix;

  /// @param options empty: nothing is compared
  explicit SmallResult(const std::string& options = "--potential none") {
    if (options.empty()) return;
    const auto file = real_input("nmr/1l2y.pdb");
    if (!file) return;
    prefix = folder.file("result");
    const Outcome compared = run_espdiff("compare " + *file + " " + *file + " --target-model 5 " + options +
                                         " -q --exit-zero --overwrite -o " + prefix);
    REQUIRE(compared.status == 0);
  }
  OrderedJson record() const { return OrderedJson::parse(read_file(prefix + ".json")); }
  void set(const char* pointer, const OrderedJson& value) const {
    OrderedJson json = record();
    REQUIRE(json.contains(OrderedJson::json_pointer(pointer)));
    json[OrderedJson::json_pointer(pointer)] = value;
    write_file(prefix + ".json", json.dump(2));
  }
  Outcome verified() const { return run_espdiff("verify " + prefix); }
};

inline bool differs(const Outcome& outcome, const std::string& name) {
  std::size_t at = outcome.out.find("\n" + name + " ");
  if (at == std::string::npos) return false;
  const std::string line = outcome.out.substr(at + 1, outcome.out.find('\n', at + 1) - at - 1);
  return contains(line, "DIFFERS");
}

}  // namespace espdiff_test
