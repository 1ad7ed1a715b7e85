// volume_store.cpp: putting, replacing and taking volumes, and what is refused.
#include "vmdplugin/bridge/volume_store.h"

#include <doctest/doctest.h>

#include "fake_vmd.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

TEST_CASE("a volume is replaced by a later one of its name, and taken once") {
  put_volume("b", small_grid(1), "first");
  put_volume("a", small_grid(2), "second");
  put_volume("b", small_grid(3), "third");
  CHECK(volume_names() == std::vector<std::string>{"a", "b"});
  CHECK(describe_volume("b")->dataname == "third");
  CHECK(take_volume("b")->values == std::vector<float>(8, 3.0F));
  CHECK_FALSE(take_volume("b"));
  CHECK_FALSE(describe_volume("b"));
  take_volume("a");
  CHECK(volume_names().empty());
  Grid grid = small_grid(1);
  grid.values.pop_back();
  CHECK(message_of([&] { put_volume("c", grid, ""); }) ==
        "volume 'c': 7 values for 8 grid points; the numbers must be equal");
  grid.lattice.size = {7, 1, 1};
  CHECK(message_of([&] { put_volume("c", grid, ""); }) ==
        "volume 'c': an axis has 1 points; at least 2 along each axis were expected");
}
