// view_program.cpp: `espdiff-view OUT.vtp`: runs `espdiff view OUT.vtp`, for file managers and menus.
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "base/system_message.h"

int main(int argc, char** argv) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  // Normally the two programs are in one folder; otherwise the one on PATH is used.
  const std::filesystem::path beside = self.parent_path() / "espdiff";
  const std::string program = !error && std::filesystem::exists(beside, error) ? beside.string() : "espdiff";
  std::string espdiff = "espdiff", view = "view";
  std::vector<char*> arguments = {espdiff.data(), view.data()};
  for (int i = 1; i < argc; ++i) arguments.push_back(argv[i]);
  arguments.push_back(nullptr);
  execvp(program.c_str(), arguments.data());
  std::fprintf(stderr, "espdiff-view: cannot start %s: %s\n", program.c_str(), espdiff::system_message(errno).c_str());
  return 1;
}
