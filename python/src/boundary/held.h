// held.h: objects of Python's that other threads hold.
#pragma once

#include <nanobind/nanobind.h>

#include <utility>

namespace espdiff::python {

/// An object of Python's that threads without its lock may let go.
struct Held {
  nanobind::object object;
  Held() = default;
  explicit Held(nanobind::object held) : object(std::move(held)) {}
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  ~Held() {
    const nanobind::gil_scoped_acquire locked;
    object.reset();
  }
};

}  // namespace espdiff::python
