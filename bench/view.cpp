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
#include <string>
#include <vector>

#include "base/error.h"
#include "view/camera_view.h"
#include "view/comparison_files.h"
#include "view/comparison_scene.h"
#include "view/render_window.h"

namespace {

using namespace espdiff;  // NOLINT: a program of one file

constexpr int kSize = 1024;

struct Row {
  std::string name;
  double frame_ms = 0;
  std::size_t peer = 0;  ///< row that it is compared with
};

/// Median time of a frame while the camera turns; the first frames upload and compile.
double frame_ms(vtkRenderWindow* window, const std::vector<vtkRenderer*>& turned, int n_frames) {
  std::vector<double> times;
  for (int i = -3; i < n_frames; ++i) {
    for (vtkRenderer* renderer : turned) renderer->GetActiveCamera()->Azimuth(2);
    const auto start = std::chrono::steady_clock::now();
    window->Render();
    window->WaitForCompletion();
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
    if (i >= 0) times.push_back(spent.count());
  }
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
  return times[times.size() / 2];
}

/// The same mesh, light and window with VTK's mapper and one colour a vertex.
double plain_ms(const ComparisonScene& scene, const ComparisonFiles& files, bool faint, int n_frames) {
  const auto window = make_hidden_window();
  window->SetSize(kSize, kSize);
  window->SetMultiSamples(0);
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  const auto surface = scene.geometry().part(SurfacePart::kTrusted);
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(4);
  const ColourScale& scale = scene.scale(scene.scene().array);
  const std::vector<float>& values = files.surface.values(scene.scene().array);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Rgb colour = scale.colour(values[i]);
    const double opacity = faint ? scene.scene().opacity.opacity(files.surface.displacement[i]) : 1;
    colours->InsertNextTuple4(colour.red, colour.green, colour.blue, std::lround(255 * opacity));
  }
  surface->GetPointData()->SetScalars(colours);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(surface);
  mapper->SetColorModeToDirectScalars();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetInterpolationToPhong();
  actor->GetProperty()->BackfaceCullingOn();
  if (faint) actor->ForceTranslucentOn();
  renderer->UseDepthPeelingOn();
  renderer->SetMaximumNumberOfPeels(16);
  renderer->SetOcclusionRatio(0);
  renderer->AddActor(actor);
  add_lights(renderer);
  window->AddRenderer(renderer);
  place_camera(renderer, choose_camera(scene.scene(), files.surface.positions, {}, 1), 0);
  return frame_ms(window, {renderer}, n_frames);
}

double scene_ms(const ComparisonFiles& files, const Scene& scene, int n_frames) {
  ComparisonScene drawn(files, scene);
  const auto window = make_hidden_window();
  window->SetSize(scene.width, scene.height);
  drawn.add_to(window, 1);
  std::vector<vtkRenderer*> turned;
  for (const Panel& panel : drawn.panels()) {
    // Linked views share one camera.
    if (turned.empty() || scene.layout == Layout::kTurned) turned.push_back(panel.renderer);
  }
  return frame_ms(window, turned, n_frames);
}

Scene basic_scene() {
  Scene scene;
  scene.width = scene.height = kSize;
  scene.n_views = 1;
  scene.legend = false;
  scene.fade = false;
  return scene;
}

int run(const std::string& vtp, int n_frames) {
  const ComparisonFiles files = read_comparison(vtp, basic_scene());
  if (!files.maps.complete()) throw InputError("no maps: " + files.maps.why_not);
  std::vector<Row> rows;
  const Scene opaque = basic_scene();
  {
    const ComparisonScene scene(files, opaque);
    rows.push_back({"VTK's mapper, colours of the vertices, opaque", plain_ms(scene, files, false, n_frames), 0});
    rows.push_back({"VTK's mapper, the same semi-transparent", plain_ms(scene, files, true, n_frames), 1});
  }
  const auto add = [&](const std::string& name, const Scene& scene) {
    const std::size_t peer = scene.fade && scene.layout == Layout::kTurned ? 1 : 0;
    rows.push_back({name, scene_ms(files, scene, n_frames), peer});
  };
  Scene vertices = opaque, faint = opaque, linked = opaque;
  vertices.per_vertex = true;
  faint.fade = true;
  linked.layout = Layout::kLinked;
  linked.fade = true;
  add("opaque, between the vertices' values", vertices);
  add("opaque, both maps at every pixel", opaque);
  add("semi-transparent", faint);
  const auto with_cartoon = [](Scene scene) {
    scene.molecule = MoleculeStyle::kCartoon;
    return scene;
  };
  add("semi-transparent, with cartoon", with_cartoon(faint));
  add("linked: semi-transparent and two opaque", linked);
  add("linked, with cartoon", with_cartoon(linked));

  const auto window = make_hidden_window();
  window->SetSize(64, 64);
  window->Render();
  const std::string report = window->ReportCapabilities();
  const std::size_t renderer = report.find("OpenGL renderer string:");
  std::printf("%zu vertices, %zu triangles, %d x %d pixels, median of %d frames\n%s\n\n",
              files.surface.positions.size(), files.surface.triangles.size(), kSize, kSize, n_frames,
              report.substr(renderer, report.find('\n', renderer) - renderer).c_str());
  std::printf("| picture | ms a frame | frames a second | times VTK's mapper |\n|---|---|---|---|\n");
  for (const Row& row : rows) {
    std::printf("| %s | %.1f | %.1f | %.2f |\n", row.name.c_str(), row.frame_ms, 1000 / row.frame_ms,
                row.frame_ms / rows[row.peer].frame_ms);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Frame rates of espdiff's viewer at 1024 x 1024 pixels.");
  std::string vtp;
  int n_frames = 40;
  app.add_option("SURFACE", vtp, "OUT.vtp of espdiff compare, with its maps where OUT.json says")->required();
  app.add_option("--frames", n_frames, "Frames a row")->capture_default_str()->check(CLI::Range(3, 10000));
  CLI11_PARSE(app, argc, argv);
  try {
    return run(vtp, n_frames);
  } catch (const Error& error) {
    std::fprintf(stderr, "espdiff_view_bench: %s\n", error.what());
    return error.exit_status();
  }
}
