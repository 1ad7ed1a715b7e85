// export_texts.h: the scripts of exports/, as the build embeds them.
#pragma once

#include <map>
#include <string>

namespace espdiff {

/// By file name: chimerax.cxc, pymol.py, blender.py, read_ply.py.
const std::map<std::string, std::string>& export_texts();

}  // namespace espdiff
