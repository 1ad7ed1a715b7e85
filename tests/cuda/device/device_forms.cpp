// device_forms.cpp: the forms that stages are written in, on the CPU back end. Compiled with its flags.
#include "cuda/device/device_forms.h"

TEST_CASE("the forms of the CPU back end") { espdiff::cpu_backend::forms::check_all(); }
