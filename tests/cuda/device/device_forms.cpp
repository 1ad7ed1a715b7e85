// device_forms.cpp: the parallel primitives of the CPU back end, compiled with its flags.
#include "cuda/device/device_forms.h"

TEST_CASE("the primitives of the CPU back end") { espdiff::cpu_backend::forms::check_all(); }
