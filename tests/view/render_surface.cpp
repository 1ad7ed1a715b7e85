// render_surface.cpp: pictures of a sphere with known colours, and every refusal to draw.
#include "view/render_surface.h"

#include <doctest/doctest.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/progress.h"
#include "base/vector.h"
#include "support/test_data.h"
#include "view/decoded_picture.h"
#include "view/display_here.h"

using namespace espdiff;  // NOLINT: a test of one header
using espdiff_test::can_draw;
using espdiff_test::DisplayName;
using espdiff_test::message_of;
using espdiff_test::Picture;
using espdiff_test::ScratchFolder;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// The sphere's values at a unit vector.
struct Paint {
  std::function<double(Vec3d)> difference = [](Vec3d n) { return 4 * n.x; };
  std::function<double(Vec3d)> displacement = [](Vec3d) { return 0.1; };
  std::function<bool(Vec3d)> corrupt = [](Vec3d) { return false; };
  std::function<double(Vec3d)> p_family_wise = nullptr;  // of an ensemble
};

vtkFloatArray* add_array(vtkPolyData* surface, const char* name, int n_components) {
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(n_components);
  surface->GetPointData()->AddArray(array);
  return array;
}

/// Writes a sphere of radius 12 A with the arrays that `espdiff compare` writes.
std::string write_sphere(const std::string& path, const Paint& paint) {
  vtkNew<vtkPolyData> surface;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> triangles;
  vtkNew<vtkUnsignedCharArray> corrupt;
  corrupt->SetName("corrupt");
  vtkFloatArray* normal = add_array(surface, "normal", 3);
  vtkFloatArray* difference = add_array(surface, "potential_difference", 1);
  vtkFloatArray* sign_change = add_array(surface, "sign_change", 1);
  vtkFloatArray* displacement = add_array(surface, "displacement", 1);
  vtkFloatArray* p_family_wise = paint.p_family_wise ? add_array(surface, "p_family_wise", 1) : nullptr;
  constexpr vtkIdType kRings = 24, kSegments = 48;
  for (vtkIdType i = 0; i < (kRings + 1) * kSegments; ++i) {
    const double polar = kPi * static_cast<double>(i / kSegments) / kRings;
    const double turn = 2 * kPi * static_cast<double>(i % kSegments) / kSegments;
    const Vec3d n{std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)};
    points->InsertNextPoint(12 * n.x, 12 * n.y, 12 * n.z);
    normal->InsertNextTuple3(n.x, n.y, n.z);
    difference->InsertNextValue(static_cast<float>(paint.difference(n)));
    sign_change->InsertNextValue(n.y > 0.3 ? 1.0F : 0.0F);
    displacement->InsertNextValue(static_cast<float>(paint.displacement(n)));
    if (p_family_wise != nullptr) p_family_wise->InsertNextValue(static_cast<float>(paint.p_family_wise(n)));
  }
  const auto add_triangle = [&](vtkIdType a, vtkIdType b, vtkIdType c) {
    triangles->InsertNextCell({a, b, c});
    const double* n = normal->GetTuple3(a);
    corrupt->InsertNextValue(paint.corrupt({n[0], n[1], n[2]}) ? 1 : 0);
  };
  for (vtkIdType ring = 0; ring < kRings; ++ring) {
    for (vtkIdType segment = 0; segment < kSegments; ++segment) {
      const vtkIdType a = ring * kSegments + segment, b = ring * kSegments + (segment + 1) % kSegments;
      if (ring > 0) add_triangle(a, a + kSegments, b);
      if (ring + 1 < kRings) add_triangle(b, a + kSegments, b + kSegments);
    }
  }
  vtkNew<vtkStringArray> unit;
  unit->SetName("potential_unit");
  unit->InsertNextValue("kT/e");
  surface->SetPoints(points);
  surface->SetPolys(triangles);
  surface->GetCellData()->AddArray(corrupt);
  surface->GetFieldData()->AddArray(unit);
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(surface);
  REQUIRE(writer->Write() == 1);
  return path;
}

bool is_red(int r, int g, int b) { return r > g + 60 && r > b + 60; }
bool is_blue(int r, int g, int b) { return b > r + 60 && b > g + 40; }
bool is_green(int r, int g, int b) { return g > r + 20 && g > b + 10; }
bool is_white(int r, int g, int b) { return r == 255 && g == 255 && b == 255; }
bool is_ink(int r, int g, int b) { return r < 90 && g < 90 && b < 90; }

Scene small_picture(RenderArray array = RenderArray::kDifference) {
  Scene options;
  options.array = array;
  options.width = 640;
  options.height = 400;
  options.title = "A sphere";
  return options;
}

Picture drawn_sphere(const ScratchFolder& scratch, const Paint& paint, const Scene& options) {
  render_surface(write_sphere(scratch.file("surface.vtp"), paint), scratch.file("picture.png"), options);
  return Picture(scratch.file("picture.png"));
}

}  // namespace

TEST_CASE("a picture shows both signs, a legend in both colours, and white paper") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  const Picture picture = drawn_sphere(scratch, {}, small_picture());
  REQUIRE(picture.width() == 640);
  REQUIRE(picture.height() == 400);
  CHECK(picture.count(0, 0.25, 1, 0.9, is_red) > 2000);
  CHECK(picture.count(0, 0.25, 1, 0.9, is_blue) > 2000);
  CHECK(picture.count(0.5, 0.05, 0.7, 0.15, is_blue) > 100);
  CHECK(picture.count(0.3, 0.05, 0.5, 0.15, is_red) > 100);
  CHECK(picture.count(0.3, 0.91, 0.7, 1, is_ink) > 50);
  CHECK(picture.count(0.02, 0.05, 0.25, 0.15, is_ink) > 30);
  CHECK(picture.count(0, 0, 1, 1, is_white) > 640 * 400 / 4);
  CHECK(scratch.n_files() == 2);
}

TEST_CASE("the back view shows the other side") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  Paint paint;
  // More colour on one side: it becomes the front. Both halves of the picture then differ.
  paint.difference = [](Vec3d n) { return n.x > 0.2 ? 5.0 : 0.0; };
  const Picture picture = drawn_sphere(scratch, paint, small_picture());
  const int front = picture.count(0, 0.25, 0.5, 0.9, is_blue), back = picture.count(0.5, 0.25, 1, 0.9, is_blue);
  CHECK(front + back > 1000);
  CHECK(front != back);
}

TEST_CASE("each array has its colours") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  Paint paint;
  paint.displacement = [](Vec3d n) { return 1 + n.z; };
  CHECK(drawn_sphere(scratch, paint, small_picture(RenderArray::kDisplacement)).count(0, 0.25, 1, 0.9, is_green) >
        2000);
  const Picture sign = drawn_sphere(scratch, {}, small_picture(RenderArray::kSign));
  CHECK(sign.count(0, 0.25, 1, 0.9, is_red) > 1000);
  CHECK(sign.count(0, 0.25, 1, 0.9, [](int r, int g, int b) { return b > r + 15 && b > g; }) > 1000);
}

TEST_CASE("large displacements can fade to dark grey instead, which no difference has") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  Paint far, none;
  far.displacement = [](Vec3d) { return 9.0; };
  none.difference = [](Vec3d) { return 0.0; };
  Scene options = small_picture();
  options.opacity.to_grey = true;
  const auto is_dark_grey = [](int r, int g, int b) { return r == g && g == b && r < 150; };
  const auto is_bright = [](int r, int g, int b) { return std::min({r, g, b}) > 150 && !is_white(r, g, b); };
  const Picture grey = drawn_sphere(scratch, far, options);
  const int n_grey = grey.count(0, 0.25, 1, 0.85, is_dark_grey);
  CHECK(n_grey > 5000);
  CHECK(grey.count(0, 0.25, 1, 0.85, is_blue) + grey.count(0, 0.25, 1, 0.85, is_red) == 0);
  CHECK(drawn_sphere(scratch, none, options).count(0, 0.25, 1, 0.85, is_bright) > n_grey / 2);
}

TEST_CASE("large displacements and corrupt triangles are paler than trusted parts") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  Paint far;
  far.displacement = [](Vec3d) { return 9.0; };
  Paint corrupt;
  corrupt.corrupt = [](Vec3d) { return true; };
  const int trusted_blue = drawn_sphere(scratch, {}, small_picture()).count(0, 0.25, 1, 0.9, is_blue);
  const Picture faint = drawn_sphere(scratch, far, small_picture());
  CHECK(faint.count(0, 0.25, 1, 0.9, is_blue) < trusted_blue / 10);
  CHECK(faint.count(0, 0.25, 1, 0.9, [](int r, int g, int b) { return !is_white(r, g, b); }) > 5000);
  const Picture grey = drawn_sphere(scratch, corrupt, small_picture());
  CHECK(grey.count(0, 0.25, 1, 0.9, [](int r, int g, int b) { return r != g || g != b; }) == 0);
}

TEST_CASE("a request to cancel ends a drawing, and leaves nothing") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  const std::string surface = write_sphere(scratch.file("surface.vtp"), {});
  espdiff::Progress progress;
  const espdiff::CancelScope scope(progress);
  progress.request_cancel();
  CHECK_THROWS_AS(render_surface(surface, scratch.file("picture.png"), small_picture()), espdiff::Cancelled);
  CHECK(scratch.n_files() == 1);
}

TEST_CASE("what is not trusted has one grey, however far it slipped") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  Paint near;
  near.corrupt = [](Vec3d) { return true; };
  Paint far = near;
  far.displacement = [](Vec3d) { return 9.0; };
  const auto is_grey = [](int r, int g, int b) { return r == g && g == b && r < 150; };
  const int n_grey = drawn_sphere(scratch, near, small_picture()).count(0, 0.25, 1, 0.85, is_grey);
  CHECK(n_grey > 5000);
  CHECK(drawn_sphere(scratch, far, small_picture()).count(0, 0.25, 1, 0.85, is_grey) == n_grey);
}

TEST_CASE("the surface of an ensemble is pale where its difference is not significant") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  Paint nowhere, everywhere;
  nowhere.p_family_wise = [](Vec3d) { return 0.1; };
  everywhere.p_family_wise = [](Vec3d) { return 0.04; };
  everywhere.displacement = [](Vec3d) { return 9.0; };  // which does not count here
  const int significant = drawn_sphere(scratch, everywhere, small_picture()).count(0, 0.25, 1, 0.9, is_blue);
  CHECK(significant == drawn_sphere(scratch, {}, small_picture()).count(0, 0.25, 1, 0.9, is_blue));
  CHECK(drawn_sphere(scratch, nowhere, small_picture()).count(0, 0.25, 1, 0.9, is_blue) < significant / 10);
}

TEST_CASE("vertices without a value are grey") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  Paint paint;
  paint.difference = [](Vec3d n) { return n.x > 0 ? std::numeric_limits<double>::quiet_NaN() : -3.0; };
  const Picture picture = drawn_sphere(scratch, paint, small_picture());
  CHECK(picture.count(0, 0.25, 1, 0.9, is_blue) == 0);
  CHECK(picture.count(0, 0.25, 1, 0.9, is_red) > 1000);
  CHECK(picture.count(0, 0.25, 1, 0.9, [](int r, int g, int b) { return r == g && g == b && r < 200; }) > 1000);
}

TEST_CASE("drawing again gives the same bytes, including the provenance") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  const std::string vtp = write_sphere(scratch.file("sphere.vtp"), {});
  render_surface(vtp, scratch.file("first.png"), small_picture());
  render_surface(vtp, scratch.file("second.png"), small_picture());
  const std::string first = espdiff_test::read_file(scratch.file("first.png"));
  CHECK(first == espdiff_test::read_file(scratch.file("second.png")));
  CHECK(first.find("coloured by potential_difference, scale -4 to 4 kT/e") != std::string::npos);
  CHECK(first.find("sphere.vtp") != std::string::npos);
}

TEST_CASE("without a display drawing is refused, and no file remains") {
  const ScratchFolder scratch;
  const std::string vtp = write_sphere(scratch.file("sphere.vtp"), {});
  const auto draw_it = [&] { render_surface(vtp, scratch.file("out.png"), small_picture()); };
  {
    const DisplayName none("");
    CHECK_THROWS_AS(draw_it(), DeviceError);
    CHECK(message_of(draw_it).find("DISPLAY is not set; put `xvfb-run -a` before the command") != std::string::npos);
  }
  {
    const DisplayName wrong(":9876");
    CHECK(message_of(draw_it).find("the X display ':9876' (DISPLAY) cannot be opened; put `xvfb-run -a`") !=
          std::string::npos);
  }
  CHECK(scratch.n_files() == 1);
}

TEST_CASE("invalid surfaces are refused with the reason") {
  const ScratchFolder scratch;
  const std::string vtp = write_sphere(scratch.file("sphere.vtp"), {});
  const std::string png = scratch.file("out.png");
  const auto message = [&](const std::string& from, const std::string& to, const Scene& options) {
    return message_of([&] { render_surface(from, to, options); });
  };
  const auto contains = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  CHECK(contains(message(scratch.file("absent.vtp"), png, {}), "absent.vtp: no such file"));
  CHECK(contains(message(scratch.file(""), png, {}), "is a directory"));
  CHECK(contains(message(scratch.write("text.vtp", "hello\n"), png, {}), "not a VTK PolyData file"));
  const std::string whole = espdiff_test::read_file(vtp);
  CHECK(contains(message(scratch.write("half.vtp", whole.substr(0, whole.size() / 2)), png, {}),
                 "half.vtp: the VTP file is cut short"));
  Scene source;
  source.array = RenderArray::kSource;
  CHECK(contains(message(vtp, png, source),
                 "no point array 'potential_source' (there are: normal, potential_difference,"));
  CHECK(contains(message(vtp, scratch.file("no/such/folder.png"), {}), "cannot write: "));
  Scene options;
  options.width = 20000;
  CHECK(contains(message(vtp, png, options), "width: '20000' is not a whole number from 400 to 6000"));
  options = {};
  options.n_views = 0;
  CHECK(contains(message(vtp, png, options), "views: '0' is not a whole number from 1 to 4"));
  options = {};
  options.opacity.least = 2;
  CHECK_THROWS_AS(render_surface(vtp, png, options), InputError);
  CHECK(scratch.n_files() == 3);
}
