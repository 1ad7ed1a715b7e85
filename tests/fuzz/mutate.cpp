// mutate.cpp: drives a fuzz target without libFuzzer: so many random changes of seed files, from a fixed seed. Blind,
// but it needs no clang and no coverage: mutate N SEED-FILE...
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

const char* const kWords[] = {"nan",  "inf",   "-1",  "0",  "1e999", "4294967297", "9223372036854775807",
                              "",     " ",     "\n",  "\"", "<",     ">",          "&",
                              "\x1b", "1.5.2", "1,5", "-"};

std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  for (std::size_t n = 1 + below(4); n > 0; --n) {
    const std::size_t at = below(text.size() + 1);
    switch (below(7)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 2: text.erase(at, below(8)); break;
      case 3: text.insert(at, text.substr(below(text.size() + 1), below(32))); break;
      case 4: text.insert(at, kWords[below(std::size(kWords))]); break;
      case 5: text.resize(at); break;
      default: {  // a number or word becomes another
        const std::size_t end = text.find_first_of(" \n\"<>", at);
        if (end != std::string::npos) text.replace(at, end - at, kWords[below(std::size(kWords))]);
      }
    }
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const long n = std::atol(argv[1]);
  std::vector<std::string> seeds;
  for (int i = 2; i < argc; ++i) {
    std::ifstream in(argv[i], std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  std::mt19937 random(20);
  double slowest = 0;
  for (long i = 0; i < n; ++i) {
    const std::string text = mutated(seeds[random() % seeds.size()], random);
    const char* const last = std::getenv("MUTATE_LAST");  // the input at hand, should the process die
    if (last != nullptr) std::ofstream(last, std::ios::binary) << text;
    const auto begin = std::chrono::steady_clock::now();
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    const double s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (s > slowest) slowest = s;
  }
  std::printf("%ld executions, slowest %.3f s\n", n, slowest);
}
