// memory.cpp: what control groups and the address space leave to this process.
#include "base/memory.h"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <thread>

#include "base/error.h"
#include "support/limit_memory.h"
#include "support/test_data.h"
#include "system/control_groups.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

/// A made /sys/fs/cgroup.
class Groups {
 public:
  void set(const std::string& group, const std::string& file, const std::string& content) {
    std::filesystem::create_directories(folder_.file("fs" + group));
    folder_.write("fs" + group + "/" + file, content + "\n");
  }
  double left(const std::string& membership) {
    return left_in_groups(folder_.write("cgroup", membership), folder_.file("fs"));
  }
  int processors(const std::string& membership) {
    return usable_processors(folder_.write("cgroup", membership), folder_.file("fs"));
  }

 private:
  ScratchFolder folder_;
};

}  // namespace

TEST_CASE("control groups, version 2: the least of a group and those above it; file pages can be dropped") {
  Groups groups;
  CHECK(std::isinf(groups.left("0::/job/step\n")));
  groups.set("/job/step", "memory.max", "max");
  groups.set("/job/step", "memory.current", "500");
  CHECK(std::isinf(groups.left("0::/job/step\n")));
  groups.set("/job", "memory.max", "10000");
  groups.set("/job", "memory.current", "7000");
  CHECK(groups.left("0::/job/step\n") == 3000);
  groups.set("/job", "memory.stat", "anon 4000\nfile 3000\ninactive_file 2500\n");
  CHECK(groups.left("0::/job/step\n") == 5500);
  groups.set("/job/step", "memory.max", "2000");
  CHECK(groups.left("0::/job/step\n") == 1500);
  CHECK(groups.left("0::/job\n") == 5500);
}

TEST_CASE("control groups as a container sees them: its own limits lie at the root") {
  Groups groups;
  groups.set("", "memory.max", "8000");
  groups.set("", "memory.current", "1000");
  CHECK(groups.left("0::/\n") == 7000);
  CHECK(groups.left("0::/../elsewhere\n") == 7000);
  CHECK(groups.left("0::/not/shown/here\n") == 7000);
}

TEST_CASE("control groups, version 1, beside an empty version 2") {
  Groups groups;
  groups.set("/memory/slurm/job_7", "memory.limit_in_bytes", "6000");
  groups.set("/memory/slurm/job_7", "memory.usage_in_bytes", "2000");
  groups.set("/memory/slurm/job_7", "memory.stat", "cache 900\ntotal_inactive_file 800\n");
  groups.set("/memory", "memory.limit_in_bytes", "9223372036854771712");
  CHECK(groups.left("12:cpu,cpuacct:/slurm\n9:memory:/slurm/job_7\n0::/x\n") == 4800);
  CHECK(std::isinf(groups.left("12:cpu,cpuacct:/slurm\n")));
}

TEST_CASE("control groups with a share of the processors' time: as many threads as that keeps busy") {
  Groups groups;
  const int all = groups.processors("0::/pod\n");
  CHECK(all == static_cast<int>(std::thread::hardware_concurrency()));
  groups.set("/pod", "cpu.max", "max 100000");
  CHECK(groups.processors("0::/pod\n") == all);
  groups.set("", "cpu.max", "50000 100000");
  CHECK(groups.processors("0::/pod\n") == 1);
  groups.set("", "cpu.max", "150000 100000");
  CHECK(groups.processors("0::/pod\n") == std::min(2, all));
  groups.set("/cpu/job", "cpu.cfs_quota_us", "-1");
  groups.set("/cpu/job", "cpu.cfs_period_us", "100000");
  CHECK(groups.processors("4:cpu,cpuacct:/job\n") == all);
  groups.set("/cpu/job", "cpu.cfs_quota_us", "80000");
  CHECK(groups.processors("4:cpu,cpuacct:/job\n") == 1);
  CHECK(groups.processors("4:cpuset:/job\n") == all);
}

TEST_CASE("a limit on the address space is a limit on memory") {
  if (!espdiff_test::can_limit_memory()) return;
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_AS, &before) == 0);
  const double free = available_memory();
  CHECK(free > 0);
  // So much that whatever this process has mapped already counts for little.
  rlimit narrow = before;
  narrow.rlim_cur = rlim_t{64} << 30U;
  if (before.rlim_max != RLIM_INFINITY && before.rlim_max < narrow.rlim_cur) narrow.rlim_cur = before.rlim_max;
  REQUIRE(setrlimit(RLIMIT_AS, &narrow) == 0);
  const double left = available_memory();
  const std::string message = message_of([] { require_memory(100e9, "a.dx"); });
  setrlimit(RLIMIT_AS, &before);
  CHECK(left <= static_cast<double>(narrow.rlim_cur));
  CHECK(message.find("a.dx: needs 100.0 GB of memory, and ") == 0);
  CHECK_NOTHROW(require_memory(1e6, "a.dx"));
}
