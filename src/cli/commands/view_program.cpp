// view_program.cpp: `espdiff-view OUT.vtp`: runs `espdiff view OUT.vtp`, for file managers and menus.
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "base/text/system_message.h"
#include "system/this_process.h"

int main(int argc, char** argv) {
  // Normally the two programs are in one folder; otherwise the one on PATH is used.
  const std::filesystem::path beside = std::filesystem::path(espdiff::own_program()).parent_path() / "espdiff";
  std::error_code ignored;
  const bool is_beside = beside.is_absolute() && std::filesystem::exists(beside, ignored);
  const std::string program = is_beside ? beside.string() : "espdiff";
  std::vector<std::string> words = {"espdiff", "view"};
  words.insert(words.end(), argv + 1, argv + argc);
  const int error = espdiff::become_program(program, words);
  std::fprintf(stderr, "espdiff-view: cannot start %s: %s\n", program.c_str(), espdiff::system_message(error).c_str());
  return 1;
}
