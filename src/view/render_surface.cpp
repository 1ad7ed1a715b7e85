// render_surface.cpp: draws a scene at twice the size, averages, and writes the PNG.
#include "view/render_surface.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkImageData.h>
#include <vtkRenderWindow.h>

#include <filesystem>

#include "base/error.h"
#include "base/formatted.h"
#include "base/progress.h"
#include "base/version.h"
#include "io/files/atomic_file.h"
#include "io/files/check_outputs.h"
#include "scene/comparison_files.h"
#include "view/comparison_scene.h"
#include "view/picture.h"
#include "view/render_window.h"
#include "view/vtk_messages.h"

namespace espdiff {
namespace {

/// Pixels drawn per pixel of the picture and axis. Smooths edges, since depth peeling excludes multisampling.
constexpr int kOversampling = 2;

std::string described(const ColourScale& scale, const std::string& unit) {
  const std::string what = std::string("coloured by ") + array_name(scale.array());
  if (!scale.has_bar()) return std::string("coloured by ") + to_string(scale.array());
  if (scale.two_classes()) return what;
  return what + formatted(", scale %.6g to %.6g ", scale.low(), scale.high()) + (is_length(scale.array()) ? "A" : unit);
}

std::string description(const ComparisonScene& scene) {
  std::string text;
  for (const Panel& panel : scene.panels()) {
    const std::string one = described(scene.scale(panel.sheets.front().array), scene.unit());
    if (text.find(one) == std::string::npos) text += (text.empty() ? "" : "; ") + one;
  }
  if (!scene.scene().field.empty()) return "field " + scene.scene().field + ": " + text;
  if (shows_potentials(scene.scene()))
    text +=
        scene.per_fragment() ? "; potentials of the maps at every pixel" : "; potentials interpolated between vertices";
  return text;
}

/// Name and SHA-256 only: a published figure should not reveal its author's folders.
std::string inputs(const RunRecord& record) {
  std::string text;
  const auto add = [&](const char* role, const RecordedInput& input) {
    if (!input.path.empty())
      text += std::string(role) + " " + std::filesystem::path(input.path).filename().string() + " sha256 " +
              input.sha256 + "\n";
  };
  add("source", record.source);
  add("target", record.target);
  add("source_map", record.source_map);
  add("target_map", record.target_map);
  return text;
}

std::vector<std::string> notes_on(const ComparisonFiles& files, const Scene& scene) {
  std::vector<std::string> notes;
  // Of computed potentials there are no maps, which is no surprise.
  const bool may_have_maps = !files.record.found || !files.record.maps_computed;
  if (shows_potentials(scene) && !scene.per_vertex && files.surface.field.empty() && may_have_maps &&
      !files.maps.complete()) {
    notes.push_back("potentials are interpolated between vertices, not looked up in the maps: " + files.maps.why_not);
  }
  if (files.record.found && !files.record.trustworthy) {
    std::string reasons;
    for (const std::string& reason : files.record.reasons) reasons += (reasons.empty() ? "" : "; ") + reason;
    notes.push_back("the comparison is not trustworthy: " + reasons);
  }
  return notes;
}

/// Draws. Between the parts of the scene the window asks whether to go on.
/// @throws Cancelled
void draw(vtkRenderWindow* window) {
  vtkNew<vtkCallbackCommand> ask;
  ask->SetCallback([](vtkObject* drawing, unsigned long, void*, void*) {
    if (CancelRequest().made()) vtkRenderWindow::SafeDownCast(drawing)->SetAbortRender(1);
  });
  const unsigned long observer = window->AddObserver(vtkCommand::AbortCheckEvent, ask);
  window->Render();
  window->RemoveObserver(observer);
  CancelRequest().check();
}

}  // namespace

std::vector<std::string> render_surface(const std::string& vtp_path, const std::string& png_path, const Scene& scene,
                                        AtomicFile* beside) {
  check(scene);
  return render_comparison(read_comparison(vtp_path, scene), png_path, scene, beside);
}

std::vector<std::string> render_comparison(const ComparisonFiles& files, const std::string& png_path,
                                           const Scene& scene, AtomicFile* beside) {
  check_outputs(files_of(files), {png_path, beside != nullptr ? beside->path() : std::string()});
  AtomicFile file(png_path);  // before drawing, to find an unwritable output early
  const CancelRequest cancel;
  cancel.check();
  ComparisonScene drawn(files, scene);
  cancel.check();
  const vtkSmartPointer<vtkRenderWindow> window = make_hidden_window();
  const VtkMessages messages;
  window->SetSize(scene.width * kOversampling, scene.height * kOversampling);
  drawn.add_to(window, kOversampling);
  cancel.check();
  draw(window);
  vtkNew<vtkImageData> image = grab_picture(window, scene.width, scene.height, kOversampling, messages);
  cancel.check();
  const PictureTexts texts = {{"Title", scene.title},
                              {"Software", std::string("espdiff ") + kVersion},
                              {"Source", std::filesystem::path(files.surface.path).filename().string()},
                              {"Description", description(drawn)},
                              {"Inputs", inputs(files.record)},
                              {"Scene", scene_json(scene)}};
  const std::string png = encode_png(image, texts, png_path);
  cancel.check();
  file.stream().write(png.data(), static_cast<std::streamsize>(png.size()));
  std::vector<AtomicFile*> all = {&file};
  if (beside != nullptr) all.push_back(beside);
  commit_all(all);
  return notes_on(files, scene);
}

}  // namespace espdiff
