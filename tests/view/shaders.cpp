// shaders.cpp: the shaders' results, read back from the picture: potentials against the engine's, colours against the
// host's.
#include <doctest/doctest.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/comparison_files.h"
#include "scene/map_sampling.h"
#include "view/display_here.h"
#include "view/made_comparison.h"
#include "view/render_window.h"
#include "view/surface/shader_text.h"
#include "view/surface/surface_geometry.h"
#include "view/vtk_messages.h"

using namespace espdiff;  // NOLINT: a test of these headers
using espdiff_test::can_draw;
using espdiff_test::ScratchFolder;

namespace {

/// Draws each vertex of a surface, with its attributes, as one pixel and returns the pixels' colours.
std::vector<Rgb> draw_vertices(vtkPolyData* surface, const SurfaceLook& look, const MapPair& maps) {
  const int n = static_cast<int>(surface->GetNumberOfPoints());
  const int width = 256, height = (n + width - 1) / width;
  vtkNew<vtkPolyData> dots;
  dots->ShallowCopy(surface);
  vtkNew<vtkPoints> places;
  vtkNew<vtkCellArray> cells;
  for (vtkIdType i = 0; i < n; ++i) {
    places->InsertNextPoint(static_cast<double>(i % width) + 0.5, static_cast<double>(i / width) + 0.5, 0);
    cells->InsertNextCell({i});
  }
  dots->SetPoints(places);
  dots->SetPolys(nullptr);
  dots->SetVerts(cells);
  vtkNew<SurfaceMapper> mapper;
  mapper->SetInputData(dots);
  mapper->set_look(look);
  mapper->set_maps(std::make_shared<MapTexture>(maps.source), std::make_shared<MapTexture>(maps.target));
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetPointSize(1);
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  const auto window = make_hidden_window();
  const VtkMessages messages;
  window->SetMultiSamples(0);
  window->SetSize(width, height);
  window->AddRenderer(renderer);
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetParallelScale(height / 2.0);
  camera->SetFocalPoint(width / 2.0, height / 2.0, 0);
  camera->SetPosition(width / 2.0, height / 2.0, 100);
  camera->SetClippingRange(1, 200);
  window->Render();
  vtkNew<vtkUnsignedCharArray> bytes;
  window->GetRGBACharPixelData(0, 0, width - 1, height - 1, 0, bytes);
  CHECK(messages.first_error() == "");
  std::vector<Rgb> pixels;
  for (vtkIdType i = 0; i < n; ++i) {
    const unsigned char* p = bytes->GetPointer(4 * i);
    pixels.push_back({p[0], p[1], p[2]});
  }
  return pixels;
}

/// Decodes the output of surface.frag with kReadBack.
double decoded(Rgb pixel, const ColourScale& scale) {
  const double whole = 65536.0 * pixel.red + 256.0 * pixel.green + pixel.blue;
  return scale.low() + (scale.high() - scale.low()) * whole / 16777215.0;
}

/// Compares the fragments' difference with the engine's, as a fraction of the potentials' range.
double worst_share(const std::string& vtp, bool fetches) {
  const ComparisonFiles files = read_comparison(vtp, {});
  INFO(files.maps.why_not);
  REQUIRE(files.maps.complete());
  const SurfaceFile& surface = files.surface;
  double low = 1e30, high = -1e30;
  for (const std::vector<float>* values : {&surface.potential_source, &surface.potential_target}) {
    for (const float value : *values) {
      low = std::min<double>(low, value);
      high = std::max<double>(high, value);
    }
  }
  const SurfaceGeometry geometry(surface, files.record, files.maps);
  SurfaceLook look;
  ScaleRange range;
  range.limit = 2 * (high - low);
  look.scale = ColourScale(RenderArray::kDifference, surface.potential_difference, range);
  look.reads_back = true;
  look.fetches = fetches;
  look.inside_maps = !fetches && geometry.inside_maps();
  const auto part = geometry.part(SurfacePart::kMatched);
  // Removes the vertices' values, so that only the maps can provide them.
  auto* between = vtkFloatArray::SafeDownCast(part->GetPointData()->GetArray("vertexPotential"));
  between->FillValue(0);
  const std::vector<Rgb> pixels = draw_vertices(part, look, files.maps);
  double worst = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!std::isfinite(surface.potential_difference[i])) continue;
    worst = std::max(worst, std::abs(decoded(pixels[i], look.scale) - surface.potential_difference[i]));
    ++n;
  }
  CHECK(n > surface.positions.size() * 9 / 10);
  return worst / (high - low);
}

}  // namespace

TEST_CASE("each shader compiles here, and an error gives the driver's message") {
  if (!can_draw()) return;
  const auto window = make_hidden_window();
  window->SetSize(16, 16);
  window->Render();
  CHECK(compile_problem(shader_text("surface.vert"), true) == "");
  SurfaceLook look;
  std::string text;
  for (int array = 0; array <= static_cast<int>(RenderArray::kPlain); ++array) {
    look.scale = ColourScale(static_cast<RenderArray>(array), {1}, 0);
    for (int choice = 0; choice < 12; ++choice) {
      look.fades = choice % 2 == 0;
      look.splits = choice % 2 == 0;
      look.inside_maps = choice % 5 == 0;
      const auto part = static_cast<SurfacePart>(choice % 2);
      text =
          shader_text("surface.frag", shader_definitions(look, part, static_cast<Lookup>(choice / 4), choice % 4 < 2));
      CHECK(compile_problem(text, false) == "");
    }
  }
  const std::string problem = compile_problem(text + "void oops() { nothing(); }", false);
  CHECK(problem.find("nothing") != std::string::npos);
}

TEST_CASE("every file in shaders/ states its purpose in its first line, and includes existing files") {
  CHECK(embedded_shaders().size() == 5);
  for (const auto& [name, text] : embedded_shaders()) CHECK(text.find("// " + name + ": ") == 0);
  CHECK(shader_text("surface.frag").find("#include") == std::string::npos);
  CHECK_THROWS_AS(shader_text("absent.glsl"), Error);
}

TEST_CASE("potentials looked up by the shader equal the engine's, on skewed lattices") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  const std::string vtp = espdiff_test::compare_made_pair(scratch);
  CHECK(worst_share(vtp, false) < 1e-5);
  CHECK(worst_share(vtp, true) < 1e-5);
}

TEST_CASE("potentials looked up by the shader equal the engine's, on TIM") {
  if (!can_draw()) return;
  const auto folder = espdiff_test::real_input("pair_tim_maps");
  if (!folder) return;
  const ScratchFolder scratch;
  const auto run = espdiff_test::run_espdiff(
      "compare " + *folder + "/scTIM_chainA.pqr " + *folder + "/dTIM_chainA.pqr --quiet -o " + scratch.file("tim") +
      " --source-map " + *folder + "/scTIM_chainA_pot-PE0.dx --target-map " + *folder + "/dTIM_chainA_pot-PE0.dx");
  REQUIRE(run.status == 0);
  // 38,000 vertices, each as one pixel.
  const double worst = worst_share(scratch.file("tim.vtp"), false);
  MESSAGE("worst of TIM: ", worst, " of the range");
  CHECK(worst < 1e-3);
}

TEST_CASE("the shader's colours equal the legend's") {
  if (!can_draw()) return;
  constexpr vtkIdType kSteps = 1025;
  vtkNew<vtkPolyData> ramp;
  vtkNew<vtkPoints> points;
  ramp->SetPoints(points);
  const auto add_array = [&](const char* name, int n_components) {
    vtkNew<vtkFloatArray> array;
    array->SetName(name);
    array->SetNumberOfComponents(n_components);
    array->SetNumberOfTuples(kSteps);
    array->FillValue(0);
    ramp->GetPointData()->AddArray(array);
    return array.Get();
  };
  vtkFloatArray* potential = add_array("vertexPotential", 3);
  vtkFloatArray* displacement = add_array("displacement", 1);
  vtkFloatArray* residue = add_array("residueIndex", 1);
  vtkFloatArray* normal = add_array("normal", 3);
  ramp->GetPointData()->SetActiveNormals("normal");
  std::vector<float> values;
  for (vtkIdType i = 0; i < kSteps; ++i) {
    values.push_back(static_cast<float>(-4.5 + 9.0 * static_cast<double>(i) / (kSteps - 1)));
    points->InsertNextPoint(0, 0, 0);
    potential->SetTuple3(i, 0, values.back(), 1);
    displacement->SetValue(i, std::abs(values.back()));
    residue->SetValue(i, static_cast<float>(i) - 1);
    normal->SetTuple3(i, 0, 0, 1);
  }
  // Frontal light scales every pixel alike; white gives the factor.
  const auto draw = [&](const ColourScale& scale) {
    SurfaceLook look;
    look.scale = scale;
    return draw_vertices(ramp, look, {});
  };
  const auto lit = [](Rgb colour) {
    const double z[2] = {0.7581, 0.7950}, intensity[2] = {0.75, 0.35};
    double diffuse = 0, specular = 0;
    for (int i = 0; i < 2; ++i) {
      diffuse += intensity[i] * z[i];
      specular += intensity[i] * std::pow(std::sqrt((1 + z[i]) / 2), 32.0);
    }
    const auto channel = [&](int c) { return std::min(255.0, c * (0.28 + 0.82 * diffuse) + 25.5 * specular); };
    return std::array<double, 3>{channel(colour.red), channel(colour.green), channel(colour.blue)};
  };
  const auto check_colours = [&](const ColourScale& scale, const auto& value_of) {
    const std::vector<Rgb> pixels = draw(scale);
    double worst = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const auto expected = lit(scale.colour(value_of(i)));
      worst = std::max({worst, std::abs(pixels[i].red - expected[0]), std::abs(pixels[i].green - expected[1]),
                        std::abs(pixels[i].blue - expected[2])});
    }
    INFO(to_string(scale.array()));
    CHECK(worst < 1.6);
  };
  ScaleRange range;
  range.limit = 4;
  const auto value = [&](std::size_t i) { return values[i]; };
  check_colours(ColourScale(RenderArray::kDifference, values, range), value);
  check_colours(ColourScale(RenderArray::kTarget, values, range, kPurpleOrange), value);
  check_colours(ColourScale(RenderArray::kMagnitude, values, range), value);
  check_colours(ColourScale(RenderArray::kDisplacement, values, range),
                [&](std::size_t i) { return std::abs(values[i]); });
  check_colours(ColourScale(RenderArray::kPlain, values, range), value);
  check_colours(ColourScale(RenderArray::kResidue, values, range),
                [](std::size_t i) { return static_cast<float>(i) - 1; });
}

TEST_CASE("the host samples maps between grid points, and gives NaN outside") {
  const ScratchFolder scratch;
  const Grid map = espdiff_test::map_of({{{2, 3, 1}, 1}});
  const LatticeIndex index(map.lattice, map.name);
  const Vec3d a{2, 3.5, 1}, b{9, 3, 2};
  const Vec3d middle = 0.5 * (a + b);
  const float between = (sample_at(map, index(a)) + sample_at(map, index(b))) / 2;
  CHECK(std::abs(sample_at(map, index(middle)) - between) > 1);
  const Vec3d at = index(map.lattice.origin + 3.0 * map.lattice.step[1]);
  CHECK(std::abs(at.x) + std::abs(at.y - 3) + std::abs(at.z) < 1e-12);
  CHECK(sample_at(map, {4, 5, 6}) == map.values[4 + 33 * (5 + 27 * 6)]);
  CHECK(std::isnan(sample_at(map, {-0.1, 5, 6})));
  CHECK(std::isnan(sample_at(map, {4, 26.1, 6})));
}
