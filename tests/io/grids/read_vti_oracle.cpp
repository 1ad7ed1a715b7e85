// read_vti_oracle.cpp: files that VTK writes in every encoding are read as VTK reads them.
#include "support/test_data.h"

#ifdef ESPDIFF_HAVE_VTK
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <cmath>

#include "io/grids/read_vti.h"
#include "io/vtk/read_vtp.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

constexpr int kTypes[] = {VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT,     VTK_UNSIGNED_SHORT,
                          VTK_INT,         VTK_UNSIGNED_INT,  VTK_LONG_LONG, VTK_UNSIGNED_LONG_LONG,
                          VTK_FLOAT,       VTK_DOUBLE};

/// Calls use(text that names the encoding) after setting each encoding of a writer in turn.
template <typename Use>
void for_each_encoding(vtkXMLWriter* writer, Use use) {
  for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended}) {
    for (const bool base64 : {false, true}) {
      for (const int compressor : {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB}) {
        for (const int header : {32, 64}) {
          for (const int order : {vtkXMLWriter::LittleEndian, vtkXMLWriter::BigEndian}) {
            writer->SetDataMode(mode);
            writer->SetEncodeAppendedData(base64);
            writer->SetCompressorType(compressor);
            writer->SetHeaderType(header);
            writer->SetByteOrder(order);
            writer->SetBlockSize(64);  // several blocks, and a last one that is not full
            use("mode " + std::to_string(mode) + ", base64 " + std::to_string(base64) + ", compressor " +
                std::to_string(compressor) + ", header " + std::to_string(header) + ", order " + std::to_string(order));
          }
        }
      }
    }
  }
}

vtkSmartPointer<vtkImageData> make_image(int type) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(2, 5, -1, 3, 7, 12);
  image->SetOrigin(1.5, -2.25, 1.0 / 3);
  image->SetSpacing(0.1, 0.7, 2);
  image->GetDirectionMatrix()->DeepCopy(std::array<double, 9>{0, -1, 0, 1, 0, 0, 0, 0, 1}.data());
  const auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  values->SetName("phi psi");
  const bool is_signed = type != VTK_UNSIGNED_CHAR && type != VTK_UNSIGNED_SHORT && type != VTK_UNSIGNED_INT &&
                         type != VTK_UNSIGNED_LONG_LONG;
  const bool is_real = type == VTK_FLOAT || type == VTK_DOUBLE;
  for (int i = 0; i < 4 * 5 * 6; ++i)
    values->InsertNextTuple1(is_real ? std::sin(i) * std::pow(10.0, i % 40 - 20) : is_signed ? i - 60 : i);
  image->GetPointData()->SetScalars(values);
  return image;
}

void check_same(const std::string& path) {
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkImageData* const image = reader->GetOutput();
  vtkDataArray* const expected = image->GetPointData()->GetArray(0);
  const Grid grid = read_vti(VtkXmlFile(path, kImageData), {});
  REQUIRE(grid.values.size() == static_cast<std::size_t>(expected->GetNumberOfTuples()));
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    if (grid.values[i] != static_cast<float>(expected->GetComponent(static_cast<vtkIdType>(i), 0)))
      FAIL_CHECK("value ", i, " is ", grid.values[i]);
  }
  const int* const extent = image->GetExtent();
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(grid.lattice.size[static_cast<std::size_t>(axis)] == extent[2 * axis + 1] - extent[2 * axis] + 1);
    int ijk[3] = {extent[0], extent[2], extent[4]};
    double origin[3], next[3];
    image->TransformIndexToPhysicalPoint(ijk, origin);
    ++ijk[axis];
    image->TransformIndexToPhysicalPoint(ijk, next);
    for (int row = 0; row < 3; ++row) {
      CHECK(grid.lattice.origin[row] == doctest::Approx(origin[row]).epsilon(1e-14));
      CHECK(grid.lattice.step[static_cast<std::size_t>(axis)][row] ==
            doctest::Approx(next[row] - origin[row]).epsilon(1e-12));
    }
  }
}

}  // namespace

TEST_CASE("read_vti: files of every encoding and type are read as VTK reads them") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.vti");
  int n = 0;
  for (const int type : kTypes) {
    vtkNew<vtkXMLImageDataWriter> writer;
    writer->SetFileName(path.c_str());
    writer->SetInputData(make_image(type));
    for_each_encoding(writer, [&](const std::string& encoding) {
      CAPTURE(type);
      CAPTURE(encoding);
      REQUIRE(writer->Write() == 1);
      check_same(path);
      ++n;
    });
  }
  CHECK(n == 10 * 48);
}

TEST_CASE("read_vti: a map from elsewhere is read as VTK reads it") {
  if (const auto path = real_input("map_vti/hydrogen.vti")) check_same(*path);
}

TEST_CASE("read_vtp: surfaces of every encoding are read as VTK reads them") {
  vtkNew<vtkPolyData> surface;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> triangles, vertices;
  vtkNew<vtkFloatArray> phi, normal;
  vtkNew<vtkStringArray> unit;
  phi->SetName("phi");
  normal->SetName("normal");
  normal->SetNumberOfComponents(3);
  unit->SetName("potential_unit");
  unit->InsertNextValue("kT/e");
  for (int i = 0; i < 40; ++i) {
    points->InsertNextPoint(std::cos(i), std::sin(i), 0.1 * i);
    phi->InsertNextValue(i == 7 ? std::nanf("") : 0.5F * static_cast<float>(i));
    normal->InsertNextTuple3(i, -i, 1.0 / (i + 1));
  }
  vtkNew<vtkFloatArray> flags;
  flags->SetName("flag");
  triangles->AllocateEstimate(38, 3);
  vertices->InsertNextCell({0});  // its entry of the cell arrays comes first
  flags->InsertNextValue(-5);
  for (vtkIdType i = 0; i < 38; ++i) {
    triangles->InsertNextCell({i, i + 1, i + 2});
    flags->InsertNextValue(static_cast<float>(i % 2));
  }
  surface->SetPoints(points);
  surface->SetVerts(vertices);
  surface->SetPolys(triangles);
  surface->GetPointData()->AddArray(phi);
  surface->GetPointData()->AddArray(normal);
  surface->GetCellData()->AddArray(flags);
  surface->GetFieldData()->AddArray(unit);

  const ScratchFolder scratch;
  const std::string path = scratch.file("a.vtp");
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(surface);
  for_each_encoding(writer, [&](const std::string& encoding) {
    CAPTURE(encoding);
    REQUIRE(writer->Write() == 1);
    const VtpContent read = read_vtp(path);
    REQUIRE(read.positions.size() == 40);
    REQUIRE(read.triangles.size() == 38);
    REQUIRE(read.point_arrays.size() == 2);
    for (std::size_t i = 0; i < 40; ++i) {
      const auto id = static_cast<vtkIdType>(i);
      for (int c = 0; c < 3; ++c) {
        CHECK(read.positions[i][c] == points->GetPoint(id)[c]);
        CHECK(find_array(read.point_arrays, "normal")->values[3 * i + static_cast<std::size_t>(c)] ==
              normal->GetComponent(id, c));
      }
      const double value = find_array(read.point_arrays, "phi")->values[i];
      CHECK((value == phi->GetComponent(id, 0) || (std::isnan(value) && i == 7)));
    }
    for (std::uint32_t i = 0; i < 38; ++i) {
      CHECK(read.triangles[i] == Triangle{i, i + 1, i + 2});
      CHECK(find_array(read.cell_arrays, "flag")->values[i] == i % 2);
    }
    REQUIRE(read.texts.size() == 1);
    CHECK(read.texts[0].second == "kT/e");
  });
}

#else

TEST_CASE("read_vti: as VTK reads it") { MESSAGE("SKIPPED: this build has no VTK to compare with"); }

#endif
