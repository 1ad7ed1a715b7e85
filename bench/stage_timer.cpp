// stage_timer.cpp: repetitions and their median; description of the machine.
#include "stage_timer.h"

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>
#include <vector>

#include "base/version.h"
#include "engine/engine.h"

namespace espdiff_bench {
namespace {

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace

void StageTimer::time(espdiff::Engine& engine, const std::function<void()>& call, int n_in_call) {
  if (n_repetitions_ > 1) call();
  std::vector<double> all;
  for (int repetition = 0; repetition < n_repetitions_; ++repetition) {
    double total_ms = 0;
    int n = 0;
    do {
      total_ms += engine.elapsed_ms(call);
      ++n;
    } while (total_ms < least_ms_);
    all.push_back(total_ms / n / n_in_call);
  }
  std::sort(all.begin(), all.end());
  median_ms_ = 0.5 * (all[(all.size() - 1) / 2] + all[all.size() / 2]);
}

nlohmann::ordered_json machine_context() {
  char date[32] = "";
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  if (localtime_r(&now, &local) != nullptr) std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &local);
  double load[3] = {0, 0, 0};
  const bool has_load = getloadavg(load, 3) == 3;
  nlohmann::ordered_json context;
  context["date"] = date;
  context["espdiff_version"] = espdiff::kVersion;
  context["cpu_model"] = processor();
  context["num_cpus"] = std::thread::hardware_concurrency();
  context["load_avg"] = has_load ? std::vector<double>(load, load + 3) : std::vector<double>();
  return context;
}

}  // namespace espdiff_bench
