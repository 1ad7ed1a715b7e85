// picture.cpp: `espdiff A B -o OUT.png`.
#include "cli/picture.h"

#include "base/error.h"
#if defined(ESPDIFF_HAVE_VTK)
#include <cstdio>

#include "base/text/printable.h"
#include "view/display.h"
#include "view/render_surface.h"
#endif

namespace espdiff::cli {

bool is_picture(const std::string& path) {
  const std::string ending = ".png";
  return path.size() > ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

#if defined(ESPDIFF_HAVE_VTK)

void require_drawing(const std::string& picture) {
  const std::string problem = drawing_problem();
  if (!problem.empty()) throw DeviceError(picture + ": " + problem);
}

void draw_result(const std::string& prefix, const std::string& picture, bool has_potential) {
  Scene scene;
  if (!has_potential) scene.array = RenderArray::kDisplacement;
  for (const std::string& note : render_surface(prefix + ".vtp", picture, scene))
    std::fprintf(stderr, "espdiff: note: %s\n", printable(note).c_str());
}

#else

void require_drawing(const std::string& picture) {
  throw InputError(picture +
                   ": this build has no renderer: VTK 9 was not found when it was configured (Debian: libvtk9-dev)");
}

void draw_result(const std::string&, const std::string& picture, bool) { require_drawing(picture); }

#endif

}  // namespace espdiff::cli
