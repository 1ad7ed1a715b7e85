// molfile_vti.cpp: VTI files as VMD reads them: every scalar array, turned axes, a real file, damaged files.
#include "fake_vmd.h"
#include "io/grids/read_grid.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

std::string vti_text(const std::string& arrays) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
         "<ImageData WholeExtent=\"0 2 0 1 0 1\" Origin=\"1 2 3\" Spacing=\"0.5 0.25 2\" Direction=\"0 -1 0 1 0 0 0 0 "
         "1\">\n<Piece Extent=\"0 2 0 1 0 1\"><PointData>" +
         arrays + "</PointData></Piece></ImageData></VTKFile>\n";
}

std::string vti_array(const std::string& name, const std::string& values, const std::string& more = "") {
  return "<DataArray type=\"Float32\" Name=\"" + name + "\" format=\"ascii\"" + more + ">" + values + "</DataArray>";
}

}  // namespace

TEST_CASE("every scalar array of a VTI file is a volume, on axes that may be turned") {
  const ScratchFolder scratch;
  const std::string path = scratch.write(
      "a.vti", vti_text(vti_array("phi", "0 1 2 3 4 5 6 7 8 9 10 11") +
                        vti_array("v", "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0", " NumberOfComponents=\"2\"") +
                        vti_array("chi", "5 5 5 5 5 5 5 5 5 5 5 6")));
  auto& reader = plugin_named<18>(kVtiReader);
  CHECK(reader.file.filename_extension == std::string("vti"));
  int n_atoms = 7, n_sets = 0;
  void* const handle = reader.file.open_file_read(path.c_str(), kVtiReader, &n_atoms);
  REQUIRE(handle != nullptr);
  CHECK(n_atoms == 0);
  molfile::Volume<18>* metadata = nullptr;
  REQUIRE(reader.file.read_volumetric_metadata(handle, &n_sets, &metadata) == molfile::kSuccess);
  REQUIRE(n_sets == 2);
  CHECK(metadata[0].dataname == std::string("phi"));
  CHECK(metadata[1].dataname == std::string("chi"));
  CHECK(metadata[0].xsize == 3);
  CHECK(metadata[0].xaxis[0] == 0);
  CHECK(metadata[0].xaxis[1] == 1);  // two steps of 0.5, turned from x to y
  CHECK(metadata[0].yaxis[0] == -0.25F);
  CHECK(metadata[0].zaxis[2] == 2);
  CHECK(metadata[0].origin[2] == 3);
  std::vector<float> values(12);
  CHECK(reader.file.read_volumetric_data(handle, 0, values.data(), nullptr) == molfile::kSuccess);
  CHECK(values[11] == 11);
  CHECK(reader.file.read_volumetric_data(handle, 1, values.data(), nullptr) == molfile::kSuccess);
  CHECK(values[11] == 6);
  reader.file.close_file_read(handle);
}

TEST_CASE("VTI files that cannot be read are refused in one line") {
  const ScratchFolder scratch;
  auto& reader = plugin_named<18>(kVtiReader);
  const auto refusal = [&](const std::string& text) {
    int n_atoms = 0;
    const std::string path = scratch.write("a.vti", text);
    CHECK(reader.file.open_file_read(path.c_str(), kVtiReader, &n_atoms) == nullptr);
    std::string line = printed();
    CHECK(line.find('\n') + 1 == line.size());
    REQUIRE(line.find("espdiff) " + path) == 0);
    return line.substr(9 + path.size() - 5);
  };
  const std::string good = vti_text(vti_array("phi", "0 1 2 3 4 5 6 7 8 9 10 11"));
  CHECK(refusal(good.substr(0, good.size() - 20)) ==
        "a.vti: the VTI file is cut short: it does not end with </VTKFile>; write or fetch it again\n");
  CHECK(refusal(vti_text("")) ==
        "a.vti: has no point array with one number a point; VMD can show nothing else of a VTI file\n");
  CHECK(refusal(vti_text(vti_array("phi", "0 1 2 3"))) ==
        "a.vti:4: array 'phi' has 4 values, but its type and the number of points ask for 12; write or fetch the file "
        "again\n");
  int n_atoms = 0;
  CHECK(reader.file.open_file_read(scratch.file("absent.vti").c_str(), kVtiReader, &n_atoms) == nullptr);
  CHECK(printed().find("absent.vti") != std::string::npos);
}

TEST_CASE("a real VTI file is read as the library reads it") {
  const auto path = real_input("map_vti/hydrogen.vti");
  if (!path) return;
  const Grid grid = read_grid(*path);
  auto& reader = plugin_named<17>(kVtiReader);
  int n_atoms = 0, n_sets = 0;
  void* const handle = reader.file.open_file_read(path->c_str(), kVtiReader, &n_atoms);
  REQUIRE(handle != nullptr);
  molfile::Volume<17>* metadata = nullptr;
  REQUIRE(reader.file.read_volumetric_metadata(handle, &n_sets, &metadata) == molfile::kSuccess);
  REQUIRE(n_sets == 1);
  CHECK(metadata->dataname == std::string("probability_density"));
  CHECK(metadata->zsize == 64);
  CHECK(metadata->zaxis[2] == 63);
  std::vector<float> values(grid.values.size());
  CHECK(reader.file.read_volumetric_data(handle, 0, values.data(), nullptr) == molfile::kSuccess);
  CHECK(same_bytes(values, grid.values));
  reader.file.close_file_read(handle);
}
