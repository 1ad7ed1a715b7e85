// viewer.cpp: an interactive window for a scene, controlled by keys and mouse.
#include "view/window/viewer.h"

#include <vtkActor.h>
#include <vtkCallbackCommand.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkSphereSource.h>
#include <iostream>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/formatted.h"
#include "base/progress.h"
#include "io/files/atomic_file.h"
#include "scene/scene_keys.h"
#include "view/comparison_scene.h"
#include "view/display.h"
#include "view/drawings/camera_view.h"
#include "view/render_surface.h"
#include "view/vtk_messages.h"
#include "view/window/orbit_style.h"
#include "view/window/overlay.h"
#include "view/window/pick.h"

namespace espdiff {
namespace {

/// Distance from a split view's line within which the mouse grabs it, pixels.
constexpr int kGrasp = 8;
/// How often a window without events looks whether it shall end, milliseconds.
constexpr unsigned long kReminderMs = 100;

class Viewer {
 public:
  Viewer(const std::string& vtp_path, const Scene& scene, std::string saved_prefix)
      : files_(read_for_viewer(vtp_path, scene)),
        drawn_(files_, scene),
        picker_(files_, drawn_.geometry().start()),
        overlay_(can_morph()),
        prefix_(std::move(saved_prefix)) {
    window_->SetSize(scene.width, scene.height);
    window_->SetWindowName(("espdiff: " + std::filesystem::path(vtp_path).filename().string()).c_str());
    drawn_.add_to(window_, 1);
    smooth_edges();
    overlay_.add_to(window_);
    interactor_->SetRenderWindow(window_);
    vtkNew<OrbitStyle> style;
    style->set_calls({[this] { return renderers(); }, [this] { drawn_.camera_moved(); },
                      [this](int x, int y) { return grab(x, y); }, [this](int x, int y) { drag(x, y); },
                      [this](int x, int y) { click(x, y); }, [this](const std::string& key) { press(key); }});
    interactor_->SetInteractorStyle(style);
    vtkNew<vtkCallbackCommand> resized;
    resized->SetClientData(this);
    resized->SetCallback([](vtkObject*, unsigned long, void* self, void*) { static_cast<Viewer*>(self)->resize(); });
    window_->AddObserver(vtkCommand::WindowResizeEvent, resized);
    vtkNew<vtkCallbackCommand> reminded;
    reminded->SetClientData(this);
    reminded->SetCallback([](vtkObject*, unsigned long, void* self, void*) { static_cast<Viewer*>(self)->look_up(); });
    interactor_->AddObserver(vtkCommand::TimerEvent, reminded);
  }

  void run() {
    interactor_->Initialize();
    refresh();
    std::cout << formatted("espdiff view: ready; h in the window shows the keys\n");
    std::fflush(stdout);
    interactor_->CreateRepeatingTimer(kReminderMs);
    interactor_->Start();
    if (cancel_.made()) throw Error(ErrorClass::kCancelled, "cancelled; what was saved is complete");
  }

 private:
  static ComparisonFiles read_for_viewer(const std::string& vtp_path, const Scene& scene) {
    ComparisonFiles files = read_comparison(vtp_path, scene);
    // Keys may need them later.
    if (!files.maps.complete() && files.maps.why_not.empty()) files.maps = read_map_pair(files.record, files.surface);
    try {
      Scene with_names = scene;
      with_names.n_labels = 1;
      read_missing_files(files, with_names);
    } catch (const Error&) {
      // Residues are then identified by number only.
    }
    return files;
  }

  bool can_morph() const { return files_.record.found && !files_.surface.source_positions.empty(); }

  std::vector<vtkRenderer*> renderers() const {
    std::vector<vtkRenderer*> all;
    for (const Panel& panel : drawn_.panels()) all.push_back(panel.renderer);
    return all;
  }

  void smooth_edges() {
    for (vtkRenderer* renderer : renderers()) renderer->UseFXAAOn();
  }

  /// VTK's loop of events knows nothing of signals.
  void look_up() {
    if (cancel_.made()) interactor_->TerminateApp();
  }

  void refresh() {
    overlay_.draw(drawn_.scene());
    show_marks();
    window_->Render();
  }

  /// Shows a changed scene. If it cannot be shown, reports the reason and keeps the old scene.
  void show(const Scene& scene) {
    try {
      read_missing_files(files_, scene);
      drawn_.change_to(scene);
      smooth_edges();
    } catch (const Error& error) {
      overlay_.say({error.what()});
    }
    refresh();
  }

  void resize() {
    const int* size = window_->GetSize();
    Scene scene = drawn_.scene();
    if (size[0] == scene.width && size[1] == scene.height) return;
    scene.width = size[0];
    scene.height = size[1];
    // Below this size the layout fails; the picture is cropped.
    constexpr int kSmallest = 400;
    if (std::min(size[0], size[1]) >= kSmallest) show(scene);
  }

  const Panel* panel_at(int x) const {
    for (const Panel& panel : drawn_.panels()) {
      if (x < panel.right * drawn_.scene().width) return &panel;
    }
    return nullptr;
  }

  double morph_at(const Panel& panel, int x) const {
    const Scene& scene = drawn_.scene();
    if (scene.layout == Layout::kSplit) return x < scene.split * scene.width ? 0 : 1;
    return panel.sheets.front().morph;
  }

  bool grab(int x, int y) {
    const Scene& scene = drawn_.scene();
    const Panel& panel = drawn_.panels().front();
    const bool in_views = y > panel.bottom * scene.height && y < panel.top * scene.height;
    drags_split_ = scene.layout == Layout::kSplit && in_views && std::abs(x - scene.split * scene.width) <= kGrasp;
    return drags_split_ || overlay_.is_on_slider(scene, x, y);
  }

  void drag(int x, int) {
    Scene scene = drawn_.scene();
    if (drags_split_)
      scene.split = std::clamp(static_cast<double>(x) / scene.width, 0.0, 1.0);
    else
      scene.morph = overlay_.slider_value(scene, x);
    show(scene);
  }

  void click(int x, int y) {
    const Panel* panel = panel_at(x);
    if (panel == nullptr) return;
    const auto at_depth = [&](double depth) {
      double world[4];
      panel->renderer->SetDisplayPoint(x, y, depth);
      panel->renderer->DisplayToWorld();
      panel->renderer->GetWorldPoint(world);
      return Vec3d{world[0] / world[3], world[1] / world[3], world[2] / world[3]};
    };
    picked_ = picker_.pick(at_depth(0), at_depth(1), morph_at(*panel, x));
    std::vector<std::string> words = {"nothing there"};
    if (picked_) words = picked_in_words(*picked_, files_, drawn_.unit());
    for (const std::string& line : words) std::cout << formatted("%s\n", line.c_str());
    std::fflush(stdout);
    overlay_.say(picked_ ? words : std::vector<std::string>{});
    refresh();
  }

  /// Marks the picked point with a ball in every view.
  void show_marks() {
    for (const auto& [renderer, mark] : marks_) renderer->RemoveActor(mark);
    marks_.clear();
    if (!picked_) return;
    for (const Panel& panel : drawn_.panels()) {
      const double morph = panel.sheets.front().morph;
      if (morph > 0 && !picked_->is_matched) continue;
      const Vec3d place = picker_.place(*picked_, morph);
      vtkNew<vtkSphereSource> ball;
      ball->SetCenter(place.x, place.y, place.z);
      ball->SetRadius(0.5);
      vtkNew<vtkPolyDataMapper> mapper;
      mapper->SetInputConnection(ball->GetOutputPort());
      auto mark = vtkSmartPointer<vtkActor>::New();
      mark->SetMapper(mapper);
      mark->GetProperty()->SetColor(0.1, 0.1, 0.1);
      panel.renderer->AddActor(mark);
      marks_.emplace_back(panel.renderer, mark);
    }
  }

  void press(const std::string& key) {
    overlay_.say({});
    if (key == "q" || key == "Escape") {
      interactor_->TerminateApp();
    } else if (key == "h" || key == "question") {
      overlay_.toggle_help();
      refresh();
    } else if (key == "r") {
      drawn_.reset_camera();
      refresh();
    } else if (key == "p") {
      save_picture();
    } else if (key == "w") {
      save_scene();
    } else {
      Scene scene = drawn_.scene();
      if (change_by_key(scene, key, drawn_.scale(shown_array()).high())) show(scene);
    }
  }

  /// The array of the views' scale.
  RenderArray shown_array() const { return drawn_.panels().back().sheets.front().array; }

  Scene scene_as_seen() const {
    Scene scene = drawn_.scene();
    scene.camera = camera_of(drawn_.panels().front().renderer);
    scene.zoom = 1;
    return scene;
  }

  std::string free_path(const char* ending) const {
    std::string path = prefix_ + ending;
    for (int i = 2; std::filesystem::exists(path); ++i) path = prefix_ + "-" + std::to_string(i) + ending;
    return path;
  }

  template <typename Save>
  void save(const char* ending, const Save& write) {
    const std::string path = free_path(ending);
    try {
      write(path);
      std::cout << formatted("saved %s\n", path.c_str());
      std::fflush(stdout);
      overlay_.say({"saved " + path});
    } catch (const Error& error) {
      overlay_.say({error.what()});
    }
    refresh();
  }

  void save_picture() {
    save(".png", [&](const std::string& path) { render_comparison(files_, path, scene_as_seen()); });
  }

  void save_scene() {
    save(".json", [&](const std::string& path) {
      AtomicFile file(path);
      file.stream() << scene_json(scene_as_seen()) << '\n';
      file.commit();
    });
  }

  ComparisonFiles files_;
  vtkNew<vtkRenderWindow> window_;
  vtkNew<vtkRenderWindowInteractor> interactor_;
  ComparisonScene drawn_;
  SurfacePicker picker_;
  Overlay overlay_;
  std::string prefix_;
  bool drags_split_ = false;
  const CancelRequest cancel_;
  std::optional<PickedPoint> picked_;
  std::vector<std::pair<vtkSmartPointer<vtkRenderer>, vtkSmartPointer<vtkActor>>> marks_;
};

}  // namespace

void run_viewer(const std::string& vtp_path, const Scene& scene, const std::string& saved_prefix) {
  const std::string problem = display_problem();
  if (!problem.empty()) throw DeviceError(problem);
  const VtkMessages messages;
  Viewer(vtp_path, scene, saved_prefix).run();
  if (messages.has_error()) {
    throw DeviceError("drawing failed: " + messages.first_error() +
                      "; OpenGL 3.2 is needed, which `xvfb-run -a` provides");
  }
}

}  // namespace espdiff
