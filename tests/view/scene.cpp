// scene.cpp: scene files: writing and reading, and refusals with their messages.
#include "scene/scene.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "base/error.h"
#include "scene/scene_keys.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff;  // NOLINT: a test of these headers
using espdiff_test::contains;
using espdiff_test::message_of;
using espdiff_test::ScratchFolder;

namespace {

Scene unusual_scene() {
  Scene s;
  s.array = RenderArray::kMagnitude;
  s.range.given_ends = true;
  s.range.low = -3;
  s.range.high = 2.5;
  s.range.percentile = 90;
  s.colours = "purple-orange";
  s.unit = "mV";
  s.per_vertex = true;
  s.fade = false;
  s.opacity = {0.25, 2, 0.125, 0.75};
  s.layout = Layout::kLinked;
  s.width = 800;
  s.height = 640;
  s.n_views = 3;
  s.title = "\xCE\xB1 and \xCE\xB2";
  s.legend = false;
  s.axes = true;
  s.morph = 0.5;
  s.split = 0.25;
  s.camera = CameraView{{1, 2, 3}, {0, 1, 0}, {0, 0, 1}, 17};
  s.turn_deg = 30;
  s.tilt_deg = -10;
  s.zoom = 2;
  s.surface = false;
  s.molecule = MoleculeStyle::kSticks;
  s.around_A = 4;
  s.n_labels = 5;
  s.isopotentials = {-1, 1};
  s.n_field_lines = 40;
  s.slice = 0.5;
  return s;
}

std::string message_for(const ScratchFolder& scratch, const std::string& json) {
  return message_of([&] { check(read_scene(scratch.write("scene.json", json), {})); });
}

}  // namespace

TEST_CASE("a scene survives writing and reading") {
  const ScratchFolder scratch;
  for (const Scene& scene : {Scene(), unusual_scene()}) {
    const std::string json = scene_json(scene);
    CHECK(scene_json(read_scene(scratch.write("scene.json", json), {})) == json);
  }
  CHECK(scene_json(unusual_scene()) != scene_json({}));
}

TEST_CASE("settings missing from a scene file keep their values") {
  const ScratchFolder scratch;
  const Scene scene = read_scene(scratch.write("scene.json", R"({"range": 4, "camera": null})"), unusual_scene());
  CHECK(scene.range.limit == 4);
  CHECK_FALSE(scene.range.given_ends);
  CHECK_FALSE(scene.camera);
  CHECK(scene.molecule == MoleculeStyle::kSticks);
}

TEST_CASE("invalid scene files are refused with the reason") {
  const ScratchFolder scratch;
  CHECK(contains(message_of([&] { read_scene(scratch.file("absent.json"), {}); }), "absent.json: no such scene file"));
  CHECK(contains(message_for(scratch, "{\"zoom\": "), "scene.json: not JSON"));
  CHECK(contains(message_for(scratch, "[1]"), "a scene is a JSON object"));
  CHECK(contains(message_for(scratch, R"({"colour": "sign"})"), "a scene has no setting 'colour'"));
  CHECK(contains(message_for(scratch, R"({"zoom": "big"})"), "the value of 'zoom' has the wrong type"));
  CHECK(contains(message_for(scratch, R"({"width": 1e30})"), "the value of 'width' is not a whole number"));
  CHECK(contains(message_for(scratch, R"({"width": 4294967297})"),
                 "the value of 'width' is a whole number out of range"));
  CHECK(contains(message_for(scratch, R"({"range": [1]})"), "the value of 'range' has the wrong type"));
  CHECK(contains(message_for(scratch, R"({"layout": "round"})"), "layout: 'round' is not turned, linked or split"));
  CHECK(contains(message_for(scratch, R"({"molecule": "balls"})"),
                 "molecule: 'balls' is not none, cartoon, sticks or lines"));
  CHECK(contains(message_for(scratch, R"({"colours": "rainbow"})"),
                 "colours: 'rainbow' is not red-blue, cool-warm or purple-orange"));
}

TEST_CASE("values out of range are refused with the range") {
  const ScratchFolder scratch;
  CHECK(contains(message_for(scratch, R"({"morph": 1.5})"), "morph: '1.5' is not a number from 0 to 1"));
  CHECK(contains(message_for(scratch, R"({"split": -1})"), "split: '-1' is not a number from 0 to 1"));
  CHECK(contains(message_for(scratch, R"({"zoom": 0})"), "zoom: '0' is not a number from 0.1 to 50"));
  CHECK(contains(message_for(scratch, R"({"labels": 99})"), "labels: '99' is not a whole number from 0 to 50"));
  CHECK(contains(message_for(scratch, R"({"offsets_A": [-1]})"),
                 "offsets: '-1' is not a number above 0, at most 10, or up to 3 of these"));
  CHECK(contains(message_for(scratch, R"({"offsets_A": [1], "layout": "linked"})"), "need the layout turned"));
  CHECK(contains(message_for(scratch, R"({"layout": "split", "molecule": "lines"})"), "draws no molecules"));
  CHECK(contains(message_for(scratch, R"({"opacity": 0.1})"), "opacity 0.1 is below least-opacity 0.25"));
  CHECK(contains(message_for(scratch, R"({"slice": 2})"), "slice: '2' is not a number from 0 to 1"));
  CHECK(contains(message_for(scratch, R"({"field_lines": -1})"),
                 "field-lines: '-1' is not a whole number from 0 to 2000"));
}

TEST_CASE(
    "an option of a scene takes the text of its value, which its file has too, and refuses what the file refuses") {
  for (const OptionRow<Scene>& option : scene_options()) {
    INFO(option.name);
    const std::string unusual = option.get(unusual_scene()), usual = option.get({});
    Scene scene;
    option.set(scene, unusual);
    CHECK(option.get(scene) == unusual);
    CHECK((scene_json(scene) != scene_json({})) == (unusual != usual));
    option.set(scene, usual);
    CHECK(option.get(scene) == usual);
    CHECK(scene_json(scene) == scene_json({}));
  }
  Scene scene;
  CHECK(contains(message_of([&] {
                   scene.zoom = 99;
                   check(scene);
                 }),
                 "zoom: '99' is not a number from 0.1 to 50"));
}

TEST_CASE("each key of the viewer changes something, and the help lists every key once") {
  std::vector<std::string> told;
  for (const ViewerKey& key : viewer_keys()) {
    CHECK_FALSE(key.help.empty());
    CHECK(std::find(told.begin(), told.end(), key.keys) == told.end());
    told.push_back(key.keys);
  }
  const Scene before = unusual_scene();
  for (const char* name :
       {"1", "3", "4", "5", "6",    "7",     "8", "l", "v", "bracketleft", "bracketright", "m", "o", "f", "s", "n",
        "a", "e", "i", "x", "plus", "minus", "0", "c", "k"}) {
    Scene after = before;
    CHECK(change_by_key(after, name, 2));
    INFO(name);
    CHECK(scene_json(after) != scene_json(before));
  }
  Scene scene;
  CHECK_FALSE(change_by_key(scene, "F12", 2));
  change_by_key(scene, "plus", 2);
  CHECK(scene.range.limit == doctest::Approx(2.5));
}
