// make_seeds.cpp: writes the seeds of binary formats anew, after a format has changed: make_seeds tests/fuzz/seeds
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "io/structures/made_amber.h"
#include "io/vtk/write_vtp.h"
#include "planted_ensemble.h"
#include "trajectory/series_csv.h"
#include "trajectory/series_file.h"

using namespace espdiff;  // NOLINT: a program of one file

namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write(const std::string& path, const std::string& bytes) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

/// The state inside the file, without its check sum; and the file.
void write_series_states(const std::string& folder) {
  SeriesState state{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 0, 0}, {1, 2, 3}}, std::nullopt};
  const std::string path = folder + "/whole";
  for (const char* const name : {"deform", "morph"}) {
    if (std::string(name) == "morph") {
      SeriesState::Morph morph{
          state.mapped, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}, {0, 0, 1, 0}, {0, 1, 2, 3}, {}, 0.01, 0.005};
      morph.target.name = "a";
      morph.target.residues.push_back({"ALA", "A", 1, ' '});
      morph.target.atoms = {{"N", "N", 0, false}, {"CA", "C", 0, false}};
      morph.target.positions = {{0, 0, 0}, {1.5, 0, 0}};
      morph.target.radii = {1.6F, 1.7F};
      state.morph = std::move(morph);
    }
    write_series_state(path, state, "f");
    const std::vector<std::uint8_t> inner = nlohmann::json::from_cbor(bytes_of(path)).at("state").get_binary();
    write(folder + "/" + name, {inner.begin(), inner.end()});
  }
  write(path, "!" + bytes_of(path));
}

void write_series_csv(const std::string& folder) {
  std::filesystem::create_directories(folder);
  const std::string path = folder + "/rows";
  {
    SeriesCsv csv(path, {{"source", "a.pqr"}, {"options", "grid-spacing 1"}}, ExistingFile::kReplace);
    csv.add(SeriesRow(1, "source", "the atoms, \"all\", are missing"));
    csv.add(SeriesRow(2, "source", ""));
  }
  const std::string text = bytes_of(path);
  write(folder + "/row_only", text.substr(text.find("\n1,") + 1));
}

/// The beginning of the file, with all that is in it but the frames; and the description of the run.
void write_ensemble(const std::string& folder) {
  std::filesystem::create_directories(folder);
  const std::string path = folder + "/whole.h5";
  espdiff_fuzz::plant_ensemble(path);
  std::string head = bytes_of(path).substr(0, 8192);
  std::filesystem::remove(path);
  head.resize(head.find_last_not_of('\0') + 1);
  write(folder + "/tetrahedron", head);
  write(folder + "_plan/plan.json", plan_text(espdiff_fuzz::planted_plan()));
}

/// A square of two triangles, of which three corners are in the patch; both files behind one another.
void write_earlier_patch(const std::string& folder) {
  const std::vector<Vec3d> positions{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {1, 3, 2}};
  const std::vector<std::int32_t> patch{1, 1, 1, 0}, residue{0, 0, 1, -1};
  VtpSurface surface;
  surface.points = {"", positions};
  surface.triangles = &triangles;
  surface.point_arrays = {{"patch", patch}, {"residue_index", residue}};
  std::ostringstream text;
  write_vtp(text, surface);
  write(folder + "/square",
        R"({"plan": {"residues": ["ALA 1 of chain A", "GLY 2B of chain A"], "replicates": [{"sha256": ["ab"]}]}, )"
        R"("patches": [{"area_A2": 3.3333333333333335}, {"area_A2": 0.0}]})"
        "\n" +
            text.str());
}

}  // namespace

void write_netcdf(const std::string& folder) {
  espdiff_test::NetcdfForm form;
  write(folder + "/trajectory.nc", espdiff_test::made_netcdf({{1, 2}, {3, 4}}, form));
  form.version = 5;
  form.is_trajectory = false;
  write(folder + "/restart.nc", espdiff_test::made_netcdf({{1, 2}}, form));
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::string seeds = argv[1];
  std::filesystem::create_directories(seeds + "/series_state");
  write_series_states(seeds + "/series_state");
  write_series_csv(seeds + "/series_csv");
  write_ensemble(seeds + "/ensemble");
  write_earlier_patch(seeds + "/earlier_patch");
  write_netcdf(seeds + "/netcdf");
}
