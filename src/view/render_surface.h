// render_surface.h: draws a picture (PNG) of a comparison off screen.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace espdiff {

class AtomicFile;

/// Draws the output of `espdiff compare`: the surface of OUT.vtp coloured by one array, fainter where the slip is
/// larger, corrupt triangles and points without a value in grey, with colour bar, length bar and keys, on white.
/// Potentials are looked up at every pixel in the maps that OUT.json names; if those are missing or changed, the
/// vertices' values are interpolated. The projection is parallel, so the length bar holds everywhere; the more coloured
/// side is in front. The PNG contains its provenance as text (Title, Software, Source, Description, Inputs, Scene) and
/// replaces `png_path` only when complete.
/// @returns notes for the user: why values are not looked up, or that the result is not trustworthy
/// @throws InputError (the picture would replace a file of the comparison; scene out of range; array missing or without
/// a value; OUT.json missing although needed), IoError (file missing, output unwritable), FormatError (a file is
/// damaged or of another kind), DeviceError (no X display; says how to get one), Cancelled (nothing is written)
///
/// Cost: about 2 s at the default size by software OpenGL. Same machine and OpenGL driver: same pixels. `beside`, where
/// given, is complete and gets its name together with the picture.
std::vector<std::string> render_surface(const std::string& vtp_path, const std::string& png_path, const Scene& scene,
                                        AtomicFile* beside = nullptr);

struct ComparisonFiles;

/// The same for files already read.
std::vector<std::string> render_comparison(const ComparisonFiles& files, const std::string& png_path,
                                           const Scene& scene, AtomicFile* beside = nullptr);

}  // namespace espdiff
