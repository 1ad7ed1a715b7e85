// make_engine.h: the entry point of each compiled back end.
#pragma once

#include <memory>
#include <string>

#include "engine/engine.h"

namespace espdiff {

namespace cpu_backend {
std::unique_ptr<Engine> make_engine(int n_threads);
/// Whether potentials can be computed; returns the library of Fourier transforms, or why there is none and what to do.
std::string probe_fourier(bool* available);
}  // namespace cpu_backend

namespace cuda_backend {
std::unique_ptr<Engine> make_engine(int n_threads);
/// Whether a device answers; returns its name, or why there is none and what to do.
std::string probe_device(bool* available);
std::string probe_fourier(bool* available);
}  // namespace cuda_backend

}  // namespace espdiff
