// worker.cpp: the queue of jobs and the thread that runs them.
#include "worker.h"

#include <chrono>
#include <deque>
#include <thread>

#include "engine/compute_thread.h"

namespace espdiff::vmdplugin {

const char* name_of(Job::State state) {
  switch (state) {
    case Job::State::kQueued: return "queued";
    case Job::State::kRunning: return "running";
    case Job::State::kDone: return "done";
    case Job::State::kFailed: return "failed";
    case Job::State::kCancelled: break;
  }
  return "cancelled";
}

Job::Job(Body body)
    : body_(std::move(body)), progress_([this](const std::string& stage, double fraction) {
        const std::lock_guard<std::mutex> lock(mutex_);
        status_.stage = stage;
        status_.fraction = fraction;
      }) {}

Job::Status Job::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

bool Job::finished() const {
  const State state = status().state;
  return state != State::kQueued && state != State::kRunning;
}

bool Job::wait(int milliseconds) const {
  std::unique_lock<std::mutex> lock(mutex_);
  return ended_.wait_for(lock, std::chrono::milliseconds(milliseconds),
                         [this] { return status_.state != State::kQueued && status_.state != State::kRunning; });
}

void Job::wait() const {
  std::unique_lock<std::mutex> lock(mutex_);
  ended_.wait(lock, [this] { return status_.state != State::kQueued && status_.state != State::kRunning; });
}

void Job::cancel() {
  progress_.request_cancel();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (status_.state != State::kQueued) return;
  status_.state = State::kCancelled;
  const Cancelled reason;
  failure_ = {error_class_name(reason.error_class()), reason.message()};
  ended_.notify_all();
}

Failure Job::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

void Job::end(State state, const Failure& failure) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.state = state;
  status_.fraction = 1;
  failure_ = failure;
  ended_.notify_all();
}

void Job::run() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (status_.state != State::kQueued) return;
    status_.state = State::kRunning;
  }
  Failure why{"", ""};
  const State state = boundary(
      [this] {
        const CancelScope scope(progress_);
        body_(progress_);
        return State::kDone;
      },
      [&why](const Failure& failure) {
        why = failure;
        return failure.error_class == std::string(error_class_name(ErrorClass::kCancelled)) ? State::kCancelled
                                                                                            : State::kFailed;
      });
  body_ = nullptr;  // frees its memory on the thread that allocated most of it
  end(state, why);
}

struct Worker::Queue {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::shared_ptr<Job>> jobs;
  std::shared_ptr<Job> running;
  bool stopping = false;
  std::thread thread;

  void serve() {
    set_default_rounding();
    const SleepingTeam team;
    for (;;) {
      std::shared_ptr<Job> job;
      {
        std::unique_lock<std::mutex> lock(mutex);
        running = nullptr;
        changed.wait(lock, [this] { return stopping || !jobs.empty(); });
        if (stopping) return;
        job = running = jobs.front();
        jobs.pop_front();
      }
      job->run();
    }
  }
};

Worker::Worker() : queue_(std::make_shared<Queue>()) {}

Worker& Worker::instance() {
  // Never destroyed: static destruction may come while other threads still look at it.
  static Worker* const worker = new Worker;
  return *worker;
}

std::shared_ptr<Job> Worker::submit(Job::Body body) {
  auto job = std::make_shared<Job>(std::move(body));
  const std::lock_guard<std::mutex> lock(queue_->mutex);
  queue_->jobs.push_back(job);
  if (!queue_->thread.joinable()) queue_->thread = std::thread([queue = queue_] { queue->serve(); });
  queue_->changed.notify_all();
  return job;
}

void Worker::stop() {
  std::thread thread;
  {
    const std::lock_guard<std::mutex> lock(queue_->mutex);
    for (const auto& job : queue_->jobs) job->cancel();
    queue_->jobs.clear();
    if (queue_->running != nullptr) queue_->running->cancel();
    queue_->stopping = true;
    queue_->changed.notify_all();
    thread = std::move(queue_->thread);
  }
  if (thread.joinable()) thread.join();
  const std::lock_guard<std::mutex> lock(queue_->mutex);
  queue_->stopping = false;
}

}  // namespace espdiff::vmdplugin
