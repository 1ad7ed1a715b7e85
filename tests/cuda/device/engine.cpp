// engine.cpp: choice and description of a back end; handles that do not fit a stage.
#include <doctest/doctest.h>

#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/certificate_stage.h"
#include "engine/deform_stage.h"
#include "engine/engine.h"
#include "engine/morph_stage.h"
#include "engine/potential_stage.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::DeviceChoice;

TEST_SUITE_BEGIN("engine");

TEST_CASE("the CPU back end is always available with the requested threads") {
  CHECK(espdiff::cpu_status().available);
  CHECK(espdiff::cpu_status().name == "cpu");
  for (const int n : {1, 2, 4}) {
    const auto engine = espdiff::select_engine(DeviceChoice::kCpu, n);
    CHECK(engine->back_end() == "cpu");
    CHECK(engine->n_threads() == n);
    CHECK(engine->description().find(std::to_string(n)) == 0);
  }
  CHECK(espdiff::select_engine(DeviceChoice::kCpu, 0)->n_threads() == espdiff::available_threads());
}

TEST_CASE("without a number of threads, OMP_NUM_THREADS is used, otherwise every core") {
  const char* const before = std::getenv("OMP_NUM_THREADS");
  const std::string kept = before != nullptr ? before : "";
  unsetenv("OMP_NUM_THREADS");
  const int all = espdiff::available_threads();
  CHECK(all >= 1);
  using TextAndNumber = std::pair<const char*, int>;
  for (const TextAndNumber& given : {TextAndNumber{"3", 3}, {"5,2", 5}, {"0", all}, {"many", all}, {"-1", all}}) {
    setenv("OMP_NUM_THREADS", given.first, 1);
    CAPTURE(given.first);
    CHECK(espdiff::available_threads() == given.second);
    CHECK(espdiff::select_engine(DeviceChoice::kCpu, 0)->n_threads() == given.second);
    CHECK(espdiff::select_engine(DeviceChoice::kCpu, 2)->n_threads() == 2);
  }
  if (before != nullptr)
    setenv("OMP_NUM_THREADS", kept.c_str(), 1);
  else
    unsetenv("OMP_NUM_THREADS");
}

TEST_CASE("every call of the CPU engine ends when its thread's request to cancel is made") {
  const auto engine = espdiff::select_engine(DeviceChoice::kCpu, 2);
  const AtomSet cloud = random_cloud(150, 3);
  const auto atoms = upload(*engine, cloud);
  const auto density = engine->density(atoms, 0.8);
  const auto rough = engine->isosurface(density, kIsovalue), mesh = engine->project(rough, atoms, kIsovalue, 0.4);
  const std::vector<float> charges(cloud.size(), 0.5F);
  const auto map = engine->isolated_charges(cloud.positions, charges, {}, {});
  const auto values = engine->sample(map, mesh);
  const auto field = engine->density_field(density, kIsovalue);
  espdiff::Progress progress;
  const espdiff::Progress blind;  // passes reports on, and is not asked itself
  const espdiff::CancelScope scope(progress);
  CHECK_NOTHROW(engine->sample(map, mesh));
  progress.request_cancel();
  const std::vector<std::pair<const char*, std::function<void()>>> calls = {
      {"density", [&] { engine->density(atoms, 0.8); }},
      {"isosurface", [&] { engine->isosurface(density, kIsovalue); }},
      {"project", [&] { engine->project(rough, atoms, kIsovalue, 0.4); }},
      {"normals", [&] { engine->level_set_normals(mesh, atoms, kIsovalue); }},
      {"field", [&] { engine->density_field(density, kIsovalue); }},
      {"sample", [&] { engine->sample(map, mesh); }},
      {"compare", [&] { engine->compare(mesh, mesh, values, values, nullptr); }},
      {"fit", [&] { engine->fit(mesh, atoms, kIsovalue); }},
      {"distances", [&] { engine->distances(mesh, mesh, 5); }},
      {"gvf", [&] { engine->gvf_field(density, nullptr, kIsovalue, {}, blind, nullptr); }},
      {"distance field", [&] { engine->distance_field(density, kIsovalue, mesh, 0.75, blind); }},
      {"deform", [&] { engine->deform(mesh, field, {}, "deform", blind, nullptr); }},
      {"morph",
       [&] { engine->morph(mesh, std::vector<espdiff::MovingAtom>(cloud.size()), atoms, atoms, {}, "morph", blind); }}};
  for (const auto& named : calls) {
    INFO(named.first);
    CHECK_THROWS_AS(named.second(), espdiff::Cancelled);
  }
}

TEST_CASE("auto uses a GPU if there is one; an explicit cuda without one is an error with a remedy") {
  const espdiff::BackEndStatus cuda = espdiff::cuda_status();
  CHECK(cuda.name == "cuda");
  CHECK(espdiff::select_engine(DeviceChoice::kAuto, 1)->back_end() == (cuda.available ? "cuda" : "cpu"));
  if (cuda.available) {
    const auto engine = espdiff::select_engine(DeviceChoice::kCuda, 3);
    CHECK(engine->n_threads() == 0);
    CHECK(engine->description().find(cuda.description.plain()) == 0);
  } else {
    CHECK_THROWS_AS(espdiff::select_engine(DeviceChoice::kCuda, 0), espdiff::DeviceError);
    const std::string text = message_of([] { espdiff::select_engine(DeviceChoice::kCuda, 0); });
    CHECK(text == "device cuda: " + cuda.description.plain());
    CHECK(text.find("device cpu") != std::string::npos);
  }
}

TEST_CASE("an invalid GPU index is an error that says how many GPUs there are") {
  const std::size_t n = espdiff::cuda_devices().size();
  const auto select = [&] { espdiff::select_engine({DeviceChoice::kCuda, 999}, 0); };
  CHECK_THROWS_AS(select(), espdiff::DeviceError);
  const std::string text = message_of(select);
  CHECK_MESSAGE(text.find("device cuda:999: ") == 0, text);
  if (n == 1) CHECK_MESSAGE(text.find("there is 1 GPU, cuda:0") != std::string::npos, text);
  if (n > 1) CHECK_MESSAGE(text.find("there are " + std::to_string(n) + " GPUs") != std::string::npos, text);
  if (n == 0) CHECK(text == "device cuda:999: " + espdiff::cuda_status().description.plain());
}

TEST_CASE("invalid device names and thread counts are refused") {
  CHECK(espdiff::parse_device("auto") == DeviceChoice::kAuto);
  CHECK(espdiff::parse_device("cpu") == DeviceChoice::kCpu);
  CHECK(espdiff::parse_device("cuda") == DeviceChoice::kCuda);
  CHECK(espdiff::parse_device("cuda:0") == DeviceChoice::kCuda);
  CHECK(espdiff::parse_device("cuda:12") == espdiff::DeviceRequest(DeviceChoice::kCuda, 12));
  for (const char* wrong : {"CPU", "", "cuda:", "cuda:x", "cuda:-1", "cuda: 1", "cuda:1 ", "cuda:99999", "cpu:0"})
    CHECK_THROWS_AS(espdiff::parse_device(wrong), espdiff::InputError);
  CHECK(message_of([] { espdiff::parse_device("gpu"); }) ==
        "device: 'gpu' is not auto, cpu, cuda or cuda:N, the GPU of that index");
  CHECK(message_of([] { espdiff::select_engine(DeviceChoice::kCpu, -2); }) ==
        "threads: '-2' is not a whole number from 0 to 1024");
}

TEST_CASE("a handle of another kind is an internal error, not a crash") {
  struct Stranger : espdiff::DeviceMesh {};
  for (const auto& engine : back_ends()) {
    const auto stranger = std::make_shared<Stranger>();
    const auto map = engine->upload_map(
        [] {
          espdiff::Grid grid;
          grid.lattice.size = {2, 2, 2};
          grid.lattice.step = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
          grid.values.assign(8, 1.0F);
          return grid;
        }(),
        {});
    for (const auto& call :
         {std::function<void()>([&] { engine->area(stranger); }), std::function<void()>([&] { engine->area(nullptr); }),
          std::function<void()>([&] { engine->isosurface(map, 0.5F); }), std::function<void()>([&] {
            const auto atoms = engine->upload_atoms({{0, 0, 0}}, {1.0F}, {0});
            espdiff::MorphResult so_far;
            so_far.source = so_far.mapped = stranger;
            engine->continue_morph(so_far, {}, atoms, atoms, {}, "morph", {});
          })}) {
      try {
        call();
        FAIL("nothing was thrown");
      } catch (const espdiff::Error& error) {
        CHECK(error.error_class() == espdiff::ErrorClass::kInternal);
      }
    }
  }
}

TEST_CASE("results outlive the handles that they were made from") {
  for (const auto& engine : back_ends()) {
    espdiff::MeshPtr mapped;
    {
      const auto atoms = upload(*engine, random_cloud(50, 160));
      const auto surface = engine->isosurface(engine->density(atoms, 1.0), 0.5F);
      mapped = engine->project(surface, atoms, 0.5F, 0.5);
    }
    CHECK(engine->area(mapped) > 0);
    CHECK(engine->download(mapped).triangles.size() == engine->n_triangles(mapped));
  }
}

TEST_SUITE_END();
