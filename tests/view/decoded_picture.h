// decoded_picture.h: the pixels of a written PNG.
#pragma once

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <functional>
#include <string>

namespace espdiff_test {

/// A decoded picture; rows from the bottom.
class Picture {
 public:
  explicit Picture(const std::string& path) {
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    image_->ShallowCopy(reader->GetOutput());
  }

  int width() const { return image_->GetDimensions()[0]; }
  int height() const { return image_->GetDimensions()[1]; }
  const unsigned char* pixel(int x, int y) const {
    return static_cast<unsigned char*>(image_->GetScalarPointer(x, y, 0));
  }

  /// Number of pixels of a box (in fractions of the picture) that satisfy a condition on red, green and blue.
  int count(double left, double bottom, double right, double top,
            const std::function<bool(int, int, int)>& condition) const {
    int n = 0;
    for (int y = static_cast<int>(bottom * height()); y < static_cast<int>(top * height()); ++y) {
      for (int x = static_cast<int>(left * width()); x < static_cast<int>(right * width()); ++x) {
        const unsigned char* p = pixel(x, y);
        n += condition(p[0], p[1], p[2]) ? 1 : 0;
      }
    }
    return n;
  }

 private:
  vtkNew<vtkImageData> image_;
};

}  // namespace espdiff_test
