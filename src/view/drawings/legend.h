// legend.h: annotations around the surfaces: title, colour bar, length bar, opacity key, in pixels from the lower left
// corner.
#pragma once

#include <string>
#include <vector>

#include "base/vector.h"
#include "plot/colour_map.h"
#include "scene/colour_scale.h"

class vtkRenderer;

namespace espdiff {

struct PixelBox {
  double left = 0, bottom = 0, right = 0, top = 0;

  double width() const { return right - left; }
  double height() const { return top - bottom; }
};

enum class Align { kLeft, kCentre, kRight };

/// Draws two-dimensional shapes and text into a renderer that covers the whole picture.
class Legend {
 public:
  /// @param text_height font size in pixels; everything else scales with it
  Legend(vtkRenderer* renderer, double text_height);

  /// @param y      middle of the line of text
  /// @param factor of the text height
  void text(double x, double y, const std::string& words, Align align, double factor = 1.0);

  /// The scale with its title above and its numbers below; pointed ends where values exceed it. For two classes, two
  /// squares with labels.
  void colours(const PixelBox& bar, const ColourScale& scale, const std::string& title);

  /// A bar of a round length that takes at most `max_pixels`.
  void length(double x, double y, double max_pixels, double pixels_per_A);

  /// Key of opacity against displacement, in the surface's neutral colour.
  void opacity(const PixelBox& bar, const OpacityScale& scale);

  /// Approximate width of a key, pixels.
  double key_width(const std::string& meaning) const { return 1.5 * text_height_ + text_width(meaning); }
  /// A square of a colour with its label to the right. @return key_width()
  double key(double x, double y, Rgb colour, double opacity, const std::string& meaning);
  /// The same for a hatched square.
  double hatched_key(double x, double y, const std::string& meaning);

  /// Three axes with their letters, from their origin. Axes that point away from the viewer are paler.
  /// @param right, up, toward_viewer unit vectors of the picture in the frame of the axes
  void axes(double x, double y, double length, Vec3d right, Vec3d up, Vec3d toward_viewer);

  /// A vertical line.
  void rule(double x, double bottom, double top);
  void rectangle(const PixelBox& box, Rgb colour, double opacity = 1.0);

 private:
  /// Steps of a bar from left to right, as one shape.
  void strip(const PixelBox& bar, const std::vector<Rgb>& colours, const std::vector<double>& opacities);
  void line(double x0, double y0, double x1, double y1, Rgb colour);
  void triangle(double x0, double y0, double x1, double y1, double x2, double y2, Rgb colour);
  void frame(const PixelBox& box);
  double text_width(const std::string& words) const;

  vtkRenderer* renderer_;
  double text_height_;
};

/// A number as a reader writes it: "0.5", "-12", without trailing zeros, with a true minus sign.
std::string readable_number(double value);

/// The largest of 1, 2, 5 times a power of ten that is not above `value`; `value` > 0.
double round_down_to_length(double value);

}  // namespace espdiff
