// worker.cpp: jobs one after the other, failures as they were thrown, cancelling at any moment, and the end of the
// thread.
#include "vmdplugin/bridge/worker.h"

#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "base/error.h"

using espdiff::Progress;
using espdiff::vmdplugin::Job;
using espdiff::vmdplugin::Worker;

namespace {

/// Computes until it is cancelled.
void run_for_ever(const Progress& progress) {
  for (;;) {
    progress.report("turning", 0.5);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace

TEST_SUITE_BEGIN("worker");

TEST_CASE("jobs run one after the other, in order") {
  std::vector<int> order;
  std::vector<std::shared_ptr<Job>> jobs;
  for (int i = 0; i < 20; ++i)
    jobs.push_back(Worker::instance().submit([&order, i](const Progress&) { order.push_back(i); }));
  for (const auto& job : jobs) {
    job->wait();
    CHECK(job->status().state == Job::State::kDone);
  }
  for (int i = 0; i < 20; ++i) CHECK(order[static_cast<std::size_t>(i)] == i);
}

TEST_CASE("a job reports its stage, and what it throws") {
  const auto turning = Worker::instance().submit(run_for_ever);
  while (turning->status().stage != "turning") std::this_thread::yield();
  CHECK(turning->status().state == Job::State::kRunning);
  CHECK(turning->status().fraction == 0.5);
  CHECK_FALSE(turning->wait(5));
  turning->cancel();
  turning->wait();
  CHECK(turning->status().state == Job::State::kCancelled);
  CHECK(std::string(turning->failure().error_class) == "CANCELLED");

  const auto failing = Worker::instance().submit([](const Progress&) { throw espdiff::InputError("no atoms"); });
  failing->wait();
  CHECK(failing->status().state == Job::State::kFailed);
  CHECK(failing->failure().message.plain() == "no atoms");
  const auto foreign = Worker::instance().submit([](const Progress&) { throw 7; });
  foreign->wait();
  CHECK(std::string(foreign->failure().error_class) == "INTERNAL");
}

TEST_CASE("a queued job that is cancelled never starts") {
  const auto running = Worker::instance().submit(run_for_ever);
  bool started = false;
  const auto queued = Worker::instance().submit([&started](const Progress&) { started = true; });
  queued->cancel();
  CHECK(queued->finished());
  running->cancel();
  running->wait();
  Worker::instance().submit([](const Progress&) {})->wait();
  CHECK_FALSE(started);
}

TEST_CASE("stopping cancels what runs and what waits, and a later job starts the thread again") {
  for (int round = 0; round < 20; ++round) {
    const auto running = Worker::instance().submit(run_for_ever);
    const auto queued = Worker::instance().submit(run_for_ever);
    std::this_thread::sleep_for(std::chrono::microseconds(200 * round));
    Worker::instance().stop();
    CHECK(running->status().state == Job::State::kCancelled);
    CHECK(queued->status().state == Job::State::kCancelled);
  }
  const auto again = Worker::instance().submit([](const Progress&) {});
  again->wait();
  CHECK(again->status().state == Job::State::kDone);
}

TEST_CASE("the thread keeps denormal numbers, whatever its starter does with them") {
  volatile float smallest = std::numeric_limits<float>::denorm_min();
  float half = 0;
  Worker::instance().stop();
#if defined(__SSE__)
  const unsigned before = __builtin_ia32_stmxcsr();
  __builtin_ia32_ldmxcsr(before | 0x8040);  // flush to zero, denormals are zero: as VMD's main thread
#endif
  const auto job = Worker::instance().submit([&](const Progress&) { half = smallest * 2.0F; });
  job->wait();
#if defined(__SSE__)
  __builtin_ia32_ldmxcsr(before);
#endif
  CHECK(half > 0);
  Worker::instance().stop();
}

TEST_SUITE_END();
