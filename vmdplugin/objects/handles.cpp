// handles.cpp: finds objects by name, and ends their jobs.
#include "handles.h"

namespace espdiff::vmdplugin {
namespace {

/// The object as one of a kind. @throws InputError (another kind)
template <typename Kind>
std::shared_ptr<Kind> as(const std::shared_ptr<Object>& object, const std::string& handle, const char* wanted) {
  auto found = std::dynamic_pointer_cast<Kind>(object);
  if (found == nullptr) throw InputError(handle + " is " + kind_in_words(*object) + "; this needs a " + wanted);
  return found;
}

void stop(const Object& object) {
  if (object.job == nullptr) return;
  object.job->cancel();
  object.job->wait();
}

}  // namespace

std::string kind_in_words(const Object& object) {
  const std::string kind = object.kind();
  return (kind.find_first_of("aeiou") == 0 ? "an " : "a ") + kind;
}

Error error_of_class(const std::string& name, const Message& message) {
  for (const ErrorClass error_class :
       {ErrorClass::kInput, ErrorClass::kFormat, ErrorClass::kIo, ErrorClass::kGeometry, ErrorClass::kConvergence,
        ErrorClass::kDevice, ErrorClass::kMemory, ErrorClass::kCancelled}) {
    if (name == error_class_name(error_class)) return {error_class, message};
  }
  return {ErrorClass::kInternal, message};
}

void require_done(const std::string& handle, const Object& object) {
  if (object.job == nullptr) return;
  if (!object.job->finished())
    throw InputError(handle + " is still being computed; wait for it with `espdiff wait " + handle + "`");
  if (object.job->status().state == Job::State::kDone) return;
  const Failure failure = object.job->failure();
  throw error_of_class(failure.error_class, failure.message);
}

Handles::~Handles() {
  for (const auto& [name, object] : objects_) {
    if (object->job != nullptr) object->job->cancel();
  }
  for (const auto& [name, object] : objects_) stop(*object);
}

std::string Handles::add(const std::shared_ptr<Object>& object) {
  const std::string handle = object->kind() + std::to_string(++last_number_[object->kind()]);
  objects_[handle] = object;
  return handle;
}

std::shared_ptr<Object> Handles::find(const std::string& handle) const {
  const auto found = objects_.find(handle);
  if (found != objects_.end()) return found->second;
  std::string list;
  for (const std::string& name : names()) list += (list.empty() ? "" : ", ") + name;
  throw InputError("there is no handle '" + handle + "'; " +
                   (list.empty() ? std::string("none exists; `espdiff compare` makes one") : "there are " + list));
}

std::shared_ptr<ComparisonObject> Handles::finished_comparison(const std::string& handle) const {
  auto comparison = as<ComparisonObject>(find(handle), handle, "comparison");
  require_done(handle, *comparison);
  return comparison;
}

std::shared_ptr<MatrixObject> Handles::finished_matrix(const std::string& handle) const {
  auto matrix = as<MatrixObject>(find(handle), handle, "matrix");
  require_done(handle, *matrix);
  return matrix;
}

std::shared_ptr<TrajectoryObject> Handles::find_trajectory(const std::string& handle) const {
  return as<TrajectoryObject>(find(handle), handle, "trajectory");
}

std::shared_ptr<PotentialObject> Handles::find_potential(const std::string& handle) const {
  return as<PotentialObject>(find(handle), handle, "potential");
}

void Handles::remove(const std::string& handle) {
  const std::shared_ptr<Object> object = find(handle);
  objects_.erase(handle);
  stop(*object);
}

std::vector<std::string> Handles::names() const {
  std::vector<std::string> all;
  for (const auto& [name, object] : objects_) all.push_back(name);
  return all;
}

}  // namespace espdiff::vmdplugin
