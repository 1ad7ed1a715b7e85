// picture.h: writes a window's content as a PNG file with its provenance.
#pragma once

#include <vtkNew.h>

#include <string>
#include <utility>
#include <vector>

class vtkImageData;
class vtkRenderWindow;

namespace espdiff {

class VtkMessages;

/// Reads back a window that has just been drawn.
/// @param shrink averages squares of this many pixels a side
/// @throws DeviceError if drawing failed, or the display drew a size other than the window's
vtkNew<vtkImageData> grab_picture(vtkRenderWindow* window, int width, int height, int shrink,
                                  const VtkMessages& messages);

/// Keyword and text of a PNG's text fields.
using PictureTexts = std::vector<std::pair<std::string, std::string>>;

/// Encodes an image as PNG.
/// @throws IoError naming `path` if the picture cannot be encoded
std::string encode_png(vtkImageData* image, const PictureTexts& texts, const std::string& path);

}  // namespace espdiff
