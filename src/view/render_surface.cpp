// render_surface.cpp: draws at twice the size, averages down, and writes the PNG.
#include "view/render_surface.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkRenderWindow.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "io/atomic_file.h"
#include "view/display.h"
#include "view/legend.h"
#include "view/surface_file.h"
#include "view/surface_scene.h"
#include "view/vtk_messages.h"

namespace espdiff {
namespace {

/// Pixels drawn per pixel of the picture and axis. Smooths edges where depth peeling rules out multisampling.
constexpr int kOversampling = 2;
constexpr int kMinSize = 400, kMaxSize = 6000;

void check(const RenderOptions& options) {
  for (const int size : {options.width, options.height}) {
    if (size < kMinSize || size > kMaxSize) {
      throw InputError("the image size " + std::to_string(options.width) + " x " + std::to_string(options.height) +
                       " is out of range; each side must be " + std::to_string(kMinSize) + " to " +
                       std::to_string(kMaxSize) + " pixels");
    }
  }
  if (options.n_views < 1 || options.n_views > 4) {
    throw InputError(std::to_string(options.n_views) + " views cannot be drawn; use 1 to 4");
  }
  const OpacityScale& opacity = options.opacity;
  if (!(opacity.least >= 0 && opacity.least <= 1) || !(opacity.opaque_below_A >= 0) ||
      !(opacity.faint_above_A > opacity.opaque_below_A)) {
    throw InputError(
        "the opacity scale must rise from a displacement >= 0 to a larger one, with a least opacity of 0 to 1");
  }
}

/// Mean of each square of kOversampling^2 pixels.
vtkNew<vtkImageData> reduce(vtkImageData* large, int width, int height) {
  vtkNew<vtkImageData> small;
  small->SetDimensions(width, height, 1);
  small->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const auto* from = static_cast<const unsigned char*>(large->GetScalarPointer());
  auto* to = static_cast<unsigned char*>(small->GetScalarPointer());
  const std::size_t row = static_cast<std::size_t>(large->GetDimensions()[0]) * 3;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (std::size_t channel = 0; channel < 3; ++channel) {
        unsigned int sum = 0;
        for (int dy = 0; dy < kOversampling; ++dy) {
          for (int dx = 0; dx < kOversampling; ++dx) {
            sum += from[static_cast<std::size_t>(y * kOversampling + dy) * row +
                        static_cast<std::size_t>(x * kOversampling + dx) * 3 + channel];
          }
        }
        constexpr unsigned int kSamples = kOversampling * kOversampling;
        *to++ = static_cast<unsigned char>((sum + kSamples / 2) / kSamples);
      }
    }
  }
  return small;
}

vtkNew<vtkImageData> draw(const SurfaceFile& surface, const ColourScale& scale, const RenderOptions& options,
                          const std::string& unit) {
  const std::string problem = display_problem();
  if (!problem.empty()) throw DeviceError(problem);
  const VtkMessages messages;
  vtkNew<vtkRenderWindow> window;
  window->SetShowWindow(false);
  window->SetUseOffScreenBuffers(true);
  window->SetDPI(72);
  window->SetSize(options.width * kOversampling, options.height * kOversampling);
  add_surface_scene(window, surface, scale, options, unit, kOversampling);
  window->Render();
  vtkNew<vtkWindowToImageFilter> grabber;
  grabber->SetInput(window);
  grabber->SetInputBufferTypeToRGB();
  grabber->ReadFrontBufferOff();
  grabber->Update();
  if (messages.has_error()) {
    throw DeviceError("drawing failed: " + messages.first_error() +
                      "; OpenGL 3.2 is needed, which `xvfb-run -a` provides");
  }
  vtkImageData* image = grabber->GetOutput();
  if (image->GetDimensions()[0] != options.width * kOversampling ||
      image->GetDimensions()[1] != options.height * kOversampling) {
    throw DeviceError("the display drew " + std::to_string(image->GetDimensions()[0]) + " x " +
                      std::to_string(image->GetDimensions()[1]) + " pixels, " +
                      std::to_string(options.width * kOversampling) + " x " +
                      std::to_string(options.height * kOversampling) + " were asked for; use a smaller size");
  }
  return reduce(image, options.width, options.height);
}

std::string describe(const ColourScale& scale, const RenderOptions& options, const std::string& unit) {
  const std::string what = std::string("coloured by ") + array_name(options.array);
  if (scale.two_classes()) return what;
  char range[96];
  std::snprintf(range, sizeof range, ", scale %.6g to %.6g ", scale.low(), scale.high());
  return what + range + (options.array == RenderArray::kDisplacement ? "A" : unit);
}

vtkSmartPointer<vtkUnsignedCharArray> encode_png(vtkImageData* image, const std::string& vtp_path,
                                                 const std::string& description, const std::string& title) {
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  if (!title.empty()) writer->AddText("Title", title.c_str());
  writer->AddText("Software", "espdiff");
  writer->AddText("Source", std::filesystem::path(vtp_path).filename().string().c_str());
  writer->AddText("Description", description.c_str());
  writer->Write();
  return writer->GetResult();
}

}  // namespace

void render_surface(const std::string& vtp_path, const std::string& png_path, const RenderOptions& options) {
  check(options);
  const SurfaceFile surface = read_surface_file(vtp_path, array_name(options.array));
  const ColourScale scale(options.array, surface.values, options.limit);
  const std::string unit = options.unit.empty() ? surface.potential_unit : options.unit;
  AtomicFile file(png_path);  // before the drawing: an output that cannot be written is better found early
  vtkNew<vtkImageData> image = draw(surface, scale, options, unit);
  const auto png = encode_png(image, vtp_path, describe(scale, options, unit), options.title);
  if (png == nullptr || png->GetNumberOfValues() == 0)
    throw IoError(png_path, "the picture could not be encoded as PNG");
  file.stream().write(reinterpret_cast<const char*>(png->GetPointer(0)), png->GetNumberOfValues());
  file.commit();
}

}  // namespace espdiff
