// linked_outputs.h: what a command writes, made to be a link to what it reads.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cli/run_espdiff.h"

namespace espdiff_test {

/// Runs a command in a folder to learn which files it writes. Then each of them is a link to an input, and each input
/// such a link's target: the command must be refused, and the inputs stay as they are.
/// @param again   what the command needs besides where its outputs exist, such as --overwrite
inline void check_linked_outputs(const ScratchFolder& folder, const std::string& command,
                                 const std::vector<std::string>& inputs, const std::string& again = "") {
  namespace fs = std::filesystem;
  CAPTURE(command);
  const auto names = [&] {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder.file(""))) all.insert(entry.path().filename().string());
    return all;
  };
  const std::set<std::string> before = names();
  const std::string where = "cd " + folder.file("") + " &&";
  const Outcome first = run_espdiff(command, where);
  REQUIRE_MESSAGE(first.status == 0, first.err);
  std::vector<std::string> outputs;
  const std::set<std::string> after = names();
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(), std::back_inserter(outputs));
  REQUIRE(!outputs.empty());
  std::map<std::string, std::string> content;
  for (const std::string& input : inputs) content[input] = read_file(folder.file(input));
  for (std::size_t k = 0; k < std::max(inputs.size(), outputs.size()); ++k) {
    const std::string &output = outputs[k % outputs.size()], &input = inputs[k % inputs.size()];
    CAPTURE(output);
    CAPTURE(input);
    for (const std::string& name : outputs) fs::remove(folder.file(name));
    fs::create_symlink(input, folder.file(output));
    const Outcome outcome = run_espdiff(command + " " + again, where);
    CHECK_MESSAGE(outcome.status == 2, outcome.err);
    CHECK_MESSAGE(contains(outcome.err, "an output would replace an input: "), outcome.err);
    CHECK(n_lines(outcome.err) == 1);
    for (const auto& [name, text] : content) CHECK(read_file(folder.file(name)) == text);
    fs::remove(folder.file(output));
    CHECK(names() == before);
  }
}

}  // namespace espdiff_test
