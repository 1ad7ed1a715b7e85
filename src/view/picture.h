// picture.h: what a window shows as a PNG file with its provenance.
#pragma once

#include <vtkNew.h>

#include <string>
#include <utility>
#include <vector>

class vtkImageData;
class vtkRenderWindow;

namespace espdiff {

class VtkMessages;

/// Reads a window that has just been drawn back.
/// @param shrink by the mean of squares of this many pixels a side
/// @throws DeviceError when drawing failed, or the display drew another size than the window was given
vtkNew<vtkImageData> grab_picture(vtkRenderWindow* window, int width, int height, int shrink,
                                  const VtkMessages& messages);

/// Keyword and text of a PNG's text fields.
using PictureTexts = std::vector<std::pair<std::string, std::string>>;

/// The file's bytes.
/// @throws IoError naming `path` when the picture cannot be encoded
std::string encode_png(vtkImageData* image, const PictureTexts& texts, const std::string& path);

}  // namespace espdiff
