// view.cpp: frame rates of the viewer at 1024 x 1024, row by row as in the thesis' Table 5.4, beside VTK's own mapper
// on the same mesh.
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/files/atomic_file.h"
#include "io/files/write_csv.h"
#include "scene/comparison_files.h"
#include "view/comparison_scene.h"
#include "view/drawings/camera_view.h"
#include "view/render_window.h"

namespace {

using namespace espdiff;  // NOLINT: a program of one file

constexpr int kSize = 1024;

/// A timed picture, and the row to compare it with.
struct Row {
  std::string name;
  std::size_t peer = 0;
  std::unique_ptr<ComparisonScene> scene;  ///< none for VTK's own mapper
  vtkSmartPointer<vtkRenderWindow> window;
  std::vector<vtkRenderer*> turned;
  std::vector<double> times_ms;

  double frame_ms() const { return *std::min_element(times_ms.begin(), times_ms.end()); }
};

double time_frame(Row& row) {
  for (vtkRenderer* renderer : row.turned) renderer->GetActiveCamera()->Azimuth(2);
  const auto start = std::chrono::steady_clock::now();
  row.window->Render();
  row.window->WaitForCompletion();
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  return spent.count();
}

/// The same mesh, light and window with VTK's mapper and vertex colours.
Row plain_row(const std::string& name, std::size_t peer, const ComparisonFiles& files, const Scene& scene) {
  const ComparisonScene like(files, scene);
  Row row{name, peer, nullptr, make_hidden_window(), {}, {}};
  row.window->SetSize(kSize, kSize);
  row.window->SetMultiSamples(0);
  row.window->SetAlphaBitPlanes(1);
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  const auto surface = like.geometry().part(SurfacePart::kMatched);
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(4);
  const ColourScale& scale = like.scale(scene.array);
  const std::vector<float>& values = files.surface.values(scene.array);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Rgb colour = scale.colour(values[i]);
    const double opacity = scene.fade ? scene.opacity.opacity(files.surface.displacement[i]) : 1;
    colours->InsertNextTuple4(colour.red, colour.green, colour.blue, std::lround(255 * opacity));
  }
  surface->GetPointData()->SetScalars(colours);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(surface);
  mapper->SetColorModeToDirectScalars();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetInterpolationToPhong();
  actor->GetProperty()->SetSpecular(0.1);
  actor->GetProperty()->BackfaceCullingOn();
  if (scene.fade) actor->ForceTranslucentOn();
  renderer->UseDepthPeelingOn();
  renderer->SetMaximumNumberOfPeels(16);
  renderer->SetOcclusionRatio(0);
  renderer->AddActor(actor);
  add_lights(renderer);
  row.window->AddRenderer(renderer);
  place_camera(renderer, choose_camera(scene, files.surface.positions, {}, 1), 0);
  row.turned = {renderer};
  return row;
}

Row scene_row(const std::string& name, std::size_t peer, const ComparisonFiles& files, const Scene& scene) {
  Row row{name, peer, std::make_unique<ComparisonScene>(files, scene), make_hidden_window(), {}, {}};
  row.window->SetSize(scene.width, scene.height);
  row.scene->add_to(row.window, 1);
  // Linked views share one camera.
  row.turned = {row.scene->panels().front().renderer};
  return row;
}

Scene basic_scene() {
  Scene scene;
  scene.width = scene.height = kSize;
  scene.n_views = 1;
  scene.legend = false;
  scene.fade = false;
  return scene;
}

std::string driver() {
  const auto window = make_hidden_window();
  window->SetSize(64, 64);
  window->Render();
  const std::string report = window->ReportCapabilities();
  const std::size_t at = report.find("OpenGL renderer string:");
  const std::string name = report.substr(at, report.find('\n', at) - at);
  return name.substr(name.find_first_not_of(" ", name.find(':') + 1));
}

void write_csv(const std::string& path, const std::string& name, const ComparisonFiles& files,
               const std::vector<Row>& rows) {
  AtomicFile file(path);
  write_csv_row(file.stream(), {"case", "vertices", "triangles", "renderer", "picture", "ms", "peer_ms"});
  for (const Row& row : rows) {
    write_csv_row(file.stream(),
                  {name, std::to_string(files.surface.positions.size()), std::to_string(files.surface.triangles.size()),
                   driver(), row.name, csv_number(row.frame_ms(), 4), csv_number(rows[row.peer].frame_ms(), 4)});
  }
  file.commit();
}

int run(const std::string& vtp, int n_frames, const std::string& csv, const std::string& name) {
  const Scene opaque = basic_scene();
  Scene vertices = opaque, faint = opaque, linked = opaque;
  vertices.per_vertex = true;
  faint.fade = true;
  linked.layout = Layout::kLinked;
  linked.fade = true;
  const auto with_cartoon = [](Scene scene) {
    scene.molecule = MoleculeStyle::kCartoon;
    return scene;
  };
  const ComparisonFiles bare = read_comparison(vtp, opaque),
                        with_molecules = read_comparison(vtp, with_cartoon(opaque));
  if (!bare.maps.complete()) throw InputError("no maps: " + bare.maps.why_not);
  std::vector<Row> rows;
  rows.push_back(plain_row("VTK's mapper, vertex colours, opaque", 0, bare, opaque));
  rows.push_back(plain_row("VTK's mapper, the same semi-transparent", 1, bare, faint));
  rows.push_back(scene_row("opaque, interpolated vertex values", 0, bare, vertices));
  rows.push_back(scene_row("opaque, both maps at every pixel", 0, bare, opaque));
  rows.push_back(scene_row("semi-transparent", 1, bare, faint));
  rows.push_back(scene_row("semi-transparent, with cartoon", 1, with_molecules, with_cartoon(faint)));
  rows.push_back(scene_row("linked: semi-transparent and two opaque", 1, bare, linked));
  rows.push_back(scene_row("linked, with cartoon", 1, with_molecules, with_cartoon(linked)));
  // Rows take turns in bursts, as when a user rotates a molecule, so that other load on the machine affects all rows.
  // The fastest frame counts, because nothing disturbed it. The first frames of a burst fill the caches.
  constexpr int kBurst = 8, kWarmUp = 2;
  for (int frame = 0; frame < n_frames; frame += kBurst) {
    for (Row& row : rows) {
      for (int i = -kWarmUp; i < kBurst; ++i) {
        const double spent_ms = time_frame(row);
        if (i >= 0) row.times_ms.push_back(spent_ms);
      }
    }
  }
  std::printf("%zu vertices, %zu triangles, %d x %d pixels, fastest of %d frames\n%s\n\n",
              bare.surface.positions.size(), bare.surface.triangles.size(), kSize, kSize, n_frames, driver().c_str());
  std::printf("| picture | ms a frame | frames a second | times VTK's mapper |\n|---|---|---|---|\n");
  for (const Row& row : rows) {
    std::printf("| %s | %.1f | %.1f | %.2f |\n", row.name.c_str(), row.frame_ms(), 1000 / row.frame_ms(),
                row.frame_ms() / rows[row.peer].frame_ms());
  }
  if (!csv.empty()) write_csv(csv, name, bare, rows);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Frame rates of espdiff's viewer at 1024 x 1024 pixels.");
  std::string vtp, csv, name = "surface";
  int n_frames = 40;
  app.add_option("SURFACE", vtp, "OUT.vtp of espdiff compare, with its maps where OUT.json says")->required();
  app.add_option("--frames", n_frames, "Frames a row")->capture_default_str()->check(CLI::Range(3, 10000));
  app.add_option("--csv", csv, "Write the rows to this file");
  app.add_option("--name", name, "Name of the surface in that file");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(vtp, n_frames, csv, name);
  } catch (const Error& error) {
    std::fprintf(stderr, "espdiff_view_bench: %s\n", error.what());
    return error.exit_status();
  }
}
