// render_surface.h: a picture (PNG) of a comparison, drawn without a window on the screen.
#pragma once

#include <string>
#include <vector>

#include "io/atomic_file.h"
#include "view/scene.h"

namespace espdiff {

/// Draws what `espdiff compare` wrote: the surface of OUT.vtp coloured by one array, fainter where the counterpart is
/// farther away, corrupt triangles and places without a value in grey, with colour bar, length bar and keys, on white.
/// Potentials are looked up at every pixel in the maps that OUT.json names; where those are missing or have changed,
/// between the vertices' values. The view is parallel, so that the length bar holds everywhere; the side with more
/// colour is the front. The PNG carries its provenance as text (Title, Software, Source, Description, Inputs, Scene),
/// and replaces `png_path` only when complete.
/// @returns notes for the user: why values are not looked up, that the result is not trustworthy
/// @throws InputError (the picture would replace a file of the comparison; scene out of range; array missing or without
/// a value; OUT.json missing where it is needed),
///         IoError (file missing, output unwritable), FormatError (a file is damaged or another), DeviceError (no X
///         display to draw on; says how to get one)
/// Cost: about 2 s at the default size by software OpenGL. Same machine and OpenGL driver: same pixels.
/// `beside`, where given, is complete and gets its name together with the picture.
std::vector<std::string> render_surface(const std::string& vtp_path, const std::string& png_path, const Scene& scene,
                                        AtomicFile* beside = nullptr);

struct ComparisonFiles;

/// The same of files that were read already.
std::vector<std::string> render_comparison(const ComparisonFiles& files, const std::string& png_path,
                                           const Scene& scene, AtomicFile* beside = nullptr);

}  // namespace espdiff
