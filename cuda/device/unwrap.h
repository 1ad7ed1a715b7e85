// unwrap.h: from an opaque handle to what a stage of this back end made.
#pragma once

#include <memory>

#include "base/error.h"

namespace espdiff::ESPDIFF_BACKEND {

/// @throws Error (internal) for a handle of another engine, of another kind, or of nothing: a mistake of the caller's
template <typename Derived, typename Base>
const Derived& unwrap(const std::shared_ptr<Base>& handle) {
  const auto* derived = dynamic_cast<const Derived*>(handle.get());
  if (derived == nullptr)
    throw Error(ErrorClass::kInternal, "a handle of another engine, or of another kind, was passed to a stage");
  return *derived;
}

}  // namespace espdiff::ESPDIFF_BACKEND
