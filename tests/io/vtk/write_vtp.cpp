// write_vtp.cpp: what is written is what VTK's reader finds; wrong arrays are refused.
#include "io/vtk/write_vtp.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "base/error.h"
#include "support/test_data.h"

#ifdef ESPDIFF_HAVE_VTK
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>
#endif

using namespace espdiff;
using espdiff_test::message_of;
using espdiff_test::ScratchFolder;

namespace {

/// A tetrahedron with one array of each type. Values have no short decimal form, so that text would not carry them.
struct Tetrahedron {
  std::vector<Vec3d> points = {{1.0 / 3, 0, 0}, {1, 1e-17, 0}, {0, 1, -2e9}, {0, 0, 1}};
  std::vector<Triangle> triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  std::vector<float> potential = {0.1F, std::nanf(""), -2.5F, 1e-30F};
  std::vector<double> exact = {0.1, 0.2, 0.3, 1e300};
  std::vector<Vec3f> normal = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5F, 0.25F, 0.125F}};
  std::vector<std::int32_t> residue = {-1, 0, 70000, 7};
  std::vector<std::uint8_t> corrupt = {0, 1, 0, 255};

  VtpSurface surface() const {
    VtpSurface s;
    s.points = VtpArray("Points", points);
    s.triangles = &triangles;
    s.point_arrays = {{"potential", potential}, {"exact", exact}, {"normal", normal}, {"residue<&\">", residue}};
    s.cell_arrays = {{"corrupt", corrupt}};
    s.texts = {{"potential_unit", "kT/e"}, {"empty", ""}, {"note", "<\xc3\x85ngstr\xc3\xb6m & more>"}};
    s.active_scalars = "potential";
    s.active_normals = "normal";
    return s;
  }
};

std::string written(const VtpSurface& surface) {
  std::ostringstream out;
  write_vtp(out, surface);
  return out.str();
}

}  // namespace

TEST_CASE("appended blocks lie where the head says, each after its length") {
  const Tetrahedron shape;
  const std::string text = written(shape.surface());
  const std::size_t start = text.find("_", text.find("<AppendedData")) + 1;
  const std::size_t named = text.find("Name=\"corrupt\""), offset_at = text.find("offset=\"", named) + 8;
  const std::size_t block = start + std::stoul(text.substr(offset_at));
  std::uint64_t n_bytes = 0;
  std::memcpy(&n_bytes, text.data() + block, sizeof n_bytes);
  CHECK(n_bytes == 4);
  CHECK(text.substr(block + 8, 4) == std::string("\0\1\0\xff", 4));
  CHECK(text.find("header_type=\"UInt64\"") != std::string::npos);
}

TEST_CASE("arrays that do not fit the surface are refused") {
  const Tetrahedron shape;
  const std::vector<float> three(3);
  VtpSurface s = shape.surface();
  s.point_arrays.emplace_back("short", three);
  CHECK(message_of([&] { written(s); }) == "surface file: the array short has 3 entries for 4 points");
  s = shape.surface();
  s.cell_arrays.emplace_back("short", three);
  CHECK(message_of([&] { written(s); }) == "surface file: the array short has 3 entries for 4 triangles");
  const std::vector<Triangle> beyond = {{0, 1, 4}};
  s = shape.surface();
  s.cell_arrays.clear();
  s.triangles = &beyond;
  CHECK(message_of([&] { written(s); }) == "surface file: a triangle names vertex 4 of 4");
  s = shape.surface();
  s.points = VtpArray("Points", shape.exact);
  CHECK(message_of([&] { written(s); }).find("vectors of three real numbers") != std::string::npos);
  s = shape.surface();
  s.triangles = nullptr;
  CHECK_THROWS_AS(written(s), Error);
}

#ifdef ESPDIFF_HAVE_VTK

namespace {

vtkNew<vtkXMLPolyDataReader> read_by_vtk(const std::string& path) {
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  REQUIRE(reader->GetErrorCode() == 0);
  return reader;
}

std::string text_of(vtkPolyData* surface, const char* name) {
  auto* array = vtkStringArray::SafeDownCast(surface->GetFieldData()->GetAbstractArray(name));
  REQUIRE(array != nullptr);
  return array->GetValue(0);
}

}  // namespace

TEST_CASE("VTK reads back every point, triangle, array and text, bit by bit") {
  const ScratchFolder folder;
  const Tetrahedron shape;
  const auto reader = read_by_vtk(folder.write("shape.vtp", written(shape.surface())));
  vtkPolyData* surface = reader->GetOutput();
  REQUIRE(surface->GetNumberOfPoints() == 4);
  REQUIRE(surface->GetNumberOfPolys() == 4);
  vtkPointData* points = surface->GetPointData();
  REQUIRE(points->GetArray("residue<&\">") != nullptr);
  for (vtkIdType v = 0; v < 4; ++v) {
    const auto i = static_cast<std::size_t>(v);
    for (int c = 0; c < 3; ++c) {
      CHECK(surface->GetPoint(v)[c] == shape.points[i][c]);
      CHECK(points->GetArray("normal")->GetComponent(v, c) == static_cast<double>(shape.normal[i][c]));
    }
    const double potential = points->GetArray("potential")->GetComponent(v, 0);
    CHECK((potential == static_cast<double>(shape.potential[i]) || (std::isnan(potential) && i == 1)));
    CHECK(points->GetArray("exact")->GetComponent(v, 0) == shape.exact[i]);
    CHECK(points->GetArray("residue<&\">")->GetComponent(v, 0) == shape.residue[i]);
    CHECK(surface->GetCellData()->GetArray("corrupt")->GetComponent(v, 0) == shape.corrupt[i]);
    vtkIdList* corners = surface->GetCell(v)->GetPointIds();
    for (vtkIdType c = 0; c < 3; ++c) CHECK(corners->GetId(c) == shape.triangles[i][static_cast<std::size_t>(c)]);
  }
  CHECK(points->GetArray("exact")->GetDataType() == VTK_DOUBLE);
  CHECK(std::string(points->GetScalars()->GetName()) == "potential");
  CHECK(std::string(points->GetNormals()->GetName()) == "normal");
  CHECK(text_of(surface, "potential_unit") == "kT/e");
  CHECK(text_of(surface, "empty").empty());
  CHECK(text_of(surface, "note") == "<\xc3\x85ngstr\xc3\xb6m & more>");
}

TEST_CASE("VTK reads a surface of single-precision points without arrays, and an empty one") {
  const ScratchFolder folder;
  const std::vector<Vec3f> points = {{0, 0, 0}, {1, 0, 0}, {0, 1.5F, 0}}, none;
  const std::vector<Triangle> one = {{0, 1, 2}}, no_triangles;
  VtpSurface s;
  s.points = VtpArray("Points", points);
  s.triangles = &one;
  const auto reader = read_by_vtk(folder.write("plain.vtp", written(s)));
  CHECK(reader->GetOutput()->GetNumberOfPolys() == 1);
  CHECK(reader->GetOutput()->GetPoint(2)[1] == 1.5);
  s.points = VtpArray("Points", none);
  s.triangles = &no_triangles;
  const auto empty = read_by_vtk(folder.write("empty.vtp", written(s)));
  CHECK(empty->GetOutput()->GetNumberOfPoints() == 0);
}

#else

TEST_CASE("VTK reads back what is written") { MESSAGE("SKIPPED: this build has no VTK"); }

#endif
