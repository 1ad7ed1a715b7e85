// picture.cpp: reads back the pixels, averages them, and encodes them.
#include "view/picture.h"

#include <vtkImageData.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include "base/error.h"
#include "view/vtk_messages.h"

namespace espdiff {
namespace {

/// Mean of each square of `shrink`^2 pixels.
vtkNew<vtkImageData> reduce(vtkImageData* large, int width, int height, int shrink) {
  const auto n_samples = static_cast<unsigned int>(shrink * shrink);
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
        for (int dy = 0; dy < shrink; ++dy) {
          for (int dx = 0; dx < shrink; ++dx) {
            sum += from[static_cast<std::size_t>(y * shrink + dy) * row +
                        static_cast<std::size_t>(x * shrink + dx) * 3 + channel];
          }
        }
        *to++ = static_cast<unsigned char>((sum + n_samples / 2) / n_samples);
      }
    }
  }
  return small;
}

}  // namespace

vtkNew<vtkImageData> grab_picture(vtkRenderWindow* window, int width, int height, int shrink,
                                  const VtkMessages& messages) {
  vtkNew<vtkWindowToImageFilter> grabber;
  grabber->SetInput(window);
  grabber->SetInputBufferTypeToRGB();
  grabber->ReadFrontBufferOff();
  grabber->ShouldRerenderOff();
  grabber->Update();
  if (messages.has_error()) {
    throw DeviceError("drawing failed: " + messages.first_error() +
                      "; OpenGL 3.2 is needed, which `xvfb-run -a` provides");
  }
  vtkImageData* image = grabber->GetOutput();
  const int drawn_width = image->GetDimensions()[0], drawn_height = image->GetDimensions()[1];
  if (drawn_width != width * shrink || drawn_height != height * shrink) {
    throw DeviceError("the display drew " + std::to_string(drawn_width) + " x " + std::to_string(drawn_height) +
                      " pixels, " + std::to_string(width * shrink) + " x " + std::to_string(height * shrink) +
                      " were asked for; use a smaller size");
  }
  return reduce(image, width, height, shrink);
}

std::string encode_png(vtkImageData* image, const PictureTexts& texts, const std::string& path) {
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->SetCompressionLevel(9);
  for (const auto& [keyword, text] : texts) {
    if (!text.empty()) writer->AddText(keyword.c_str(), text.c_str());
  }
  writer->Write();
  const vtkSmartPointer<vtkUnsignedCharArray> bytes = writer->GetResult();
  if (bytes == nullptr || bytes->GetNumberOfValues() == 0)
    throw IoError(path, "the picture could not be encoded as PNG");
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)), static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

}  // namespace espdiff
