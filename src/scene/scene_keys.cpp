// scene_keys.cpp: one table of keys, their actions and their help.
#include "scene/scene_keys.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace espdiff {
namespace {

struct Key {
  std::vector<std::string> names;  ///< X's
  std::string shown, help;
  std::function<void(Scene&, double)> change;
};

Key colour_key(const char* digit, RenderArray array, const char* help) {
  return {{digit}, digit, help, [array](Scene& s, double) {
            s.array = array;
            s.range.limit = 0;
            s.range.given_ends = false;
          }};
}

template <typename Enum>
Enum next(Enum value, int n) {
  return static_cast<Enum>((static_cast<int>(value) + 1) % n);
}

void set_limit(Scene& scene, double limit) {
  scene.range.given_ends = false;
  scene.range.limit = limit;
}

const std::vector<Key>& keys() {
  static const std::vector<Key> all = {
      colour_key("1", RenderArray::kDifference, "colour: target - source"),
      colour_key("2", RenderArray::kMagnitude, "colour: |target - source|"),
      colour_key("3", RenderArray::kSign, "colour: change of sign"),
      colour_key("4", RenderArray::kSource, "colour: potential of the source"),
      colour_key("5", RenderArray::kTarget, "colour: potential of the target"),
      colour_key("6", RenderArray::kSlip, "colour: uncertainty (slip)"),
      colour_key("9", RenderArray::kDisplacement, "colour: displacement"),
      colour_key("y", RenderArray::kWhy, "colour: where it is trusted, and why not"),
      colour_key("7", RenderArray::kResidue, "colour: residues"),
      colour_key("8", RenderArray::kPlain, "colour: none"),
      {{"l"},
       "l",
       "layout: turned, linked, split",
       [](Scene& s, double) {
         s.layout = next(s.layout, 3);
         if (s.layout == Layout::kSplit) s.molecule = MoleculeStyle::kNone;
         s.offsets_A.clear();
       }},
      {{"v"}, "v", "number of turned views", [](Scene& s, double) { s.n_views = s.n_views % 4 + 1; }},
      {{"bracketleft"},
       "[",
       "morph toward the source",
       [](Scene& s, double) { s.morph = std::max(0.0, s.morph - 0.1); }},
      {{"bracketright"},
       "]",
       "morph toward the target",
       [](Scene& s, double) { s.morph = std::min(1.0, s.morph + 0.1); }},
      {{"m"},
       "m",
       "molecule: none, cartoon, sticks, lines",
       [](Scene& s, double) { s.molecule = next(s.molecule, 4); }},
      {{"o"},
       "o",
       "surface: solid or see-through",
       [](Scene& s, double) { s.opacity.greatest = s.opacity.greatest < 1 ? 1 : 0.55; }},
      {{"f"}, "f", "fade by uncertainty, or not", [](Scene& s, double) { s.fade = !s.fade; }},
      {{"s"}, "s", "surface on or off", [](Scene& s, double) { s.surface = !s.surface; }},
      {{"n"}, "n", "names of residues", [](Scene& s, double) { s.n_labels = s.n_labels > 0 ? 0 : 8; }},
      {{"a"}, "a", "ligands, ions and water within 5 A", [](Scene& s, double) { s.around_A = s.around_A > 0 ? 0 : 5; }},
      {{"e"}, "e", "field lines", [](Scene& s, double) { s.n_field_lines = s.n_field_lines > 0 ? 0 : 150; }},
      {{"i"},
       "i",
       "isopotential surfaces at half the scale",
       [](Scene& s, double limit) {
         if (s.isopotentials.empty())
           s.isopotentials = {-limit / 2, limit / 2};
         else
           s.isopotentials.clear();
       }},
      {{"x"},
       "x",
       "slice through the middle",
       [](Scene& s, double) { s.slice = s.slice ? std::nullopt : std::optional<double>(0.5); }},
      {{"plus", "equal", "KP_Add"}, "+", "wider scale", [](Scene& s, double limit) { set_limit(s, 1.25 * limit); }},
      {{"minus", "KP_Subtract"}, "-", "narrower scale", [](Scene& s, double limit) { set_limit(s, limit / 1.25); }},
      {{"0"}, "0", "automatic scale", [](Scene& s, double) { set_limit(s, 0); }},
      {{"c"},
       "c",
       "colours: red-blue, purple-orange",
       [](Scene& s, double) { s.colours = s.colours == "red-blue" ? "purple-orange" : "red-blue"; }},
      {{"t"}, "t", "axes of the target's file", [](Scene& s, double) { s.axes = !s.axes; }},
      {{"k"}, "k", "key and scales on or off", [](Scene& s, double) { s.legend = !s.legend; }}};
  return all;
}

}  // namespace

bool change_by_key(Scene& scene, const std::string& key, double limit) {
  for (const Key& k : keys()) {
    if (std::find(k.names.begin(), k.names.end(), key) == k.names.end()) continue;
    k.change(scene, limit);
    return true;
  }
  return false;
}

std::vector<ViewerKey> viewer_keys() {
  std::vector<ViewerKey> all;
  for (const Key& key : keys()) all.push_back({key.shown, key.help});
  for (const auto& [shown, help] :
       std::vector<std::pair<const char*, const char*>>{{"r", "automatic camera"},
                                                        {"p", "save the picture"},
                                                        {"w", "save the scene"},
                                                        {"h", "this help"},
                                                        {"q", "quit"},
                                                        {"left button", "turn; click: what is there"},
                                                        {"middle, Shift", "shift"},
                                                        {"right, wheel", "zoom"}}) {
    all.push_back({shown, help});
  }
  return all;
}

}  // namespace espdiff
