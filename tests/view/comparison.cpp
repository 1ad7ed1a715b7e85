// comparison.cpp: reading a comparison's files for pictures, also with some missing.
#include "base/units.h"
#include "scene/comparison_files.h"
#include "scene/map_pair.h"

#include <doctest/doctest.h>
#include <vtkCamera.h>
#include <vtkPropCollection.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkTextActor.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/error.h"
#include "io/vtk/write_vtp.h"
#include "view/comparison_scene.h"
#include "view/display_here.h"
#include "view/made_comparison.h"
#include "view/render_surface.h"
#include "view/render_window.h"
#include "view/window/pick.h"

using namespace espdiff;  // NOLINT: a test of these headers
using espdiff_test::can_draw;
using espdiff_test::compare_made_pair;
using espdiff_test::contains;
using espdiff_test::message_of;
using espdiff_test::Outcome;
using espdiff_test::run_espdiff;
using espdiff_test::ScratchFolder;

namespace {

/// A made pair, compared once for all tests of this file.
const ScratchFolder& made() {
  static const ScratchFolder scratch;
  static const std::string vtp = compare_made_pair(scratch);
  return scratch;
}

/// A copy in its own folder, to be damaged.
std::string copied(const ScratchFolder& to) {
  for (const char* name : {"pair.vtp", "pair.json", "source.dx", "target.dx", "source.pqr", "target.pqr"}) {
    std::filesystem::copy_file(made().file(name), to.file(name));
  }
  std::string json = espdiff_test::read_file(to.file("pair.json"));
  const std::string folder = made().file("");
  for (std::size_t at = json.find(folder); at != std::string::npos; at = json.find(folder))
    json.erase(at, folder.size());
  to.write("pair.json", json);
  return to.file("pair.vtp");
}

Scene small(Layout layout = Layout::kTurned) {
  Scene scene;
  scene.width = 480;
  scene.height = 400;
  scene.layout = layout;
  return scene;
}

/// All text in a window.
std::set<std::string> texts_of(vtkRenderWindow* window) {
  std::set<std::string> texts;
  vtkRendererCollection* renderers = window->GetRenderers();
  renderers->InitTraversal();
  while (vtkRenderer* renderer = renderers->GetNextItem()) {
    vtkPropCollection* props = renderer->GetViewProps();
    props->InitTraversal();
    while (vtkProp* prop = props->GetNextProp()) {
      if (auto* text = vtkTextActor::SafeDownCast(prop)) texts.insert(text->GetInput());
    }
  }
  return texts;
}

}  // namespace

TEST_CASE("a record gives inputs, superposition and verdict, also after the folder has moved") {
  const ScratchFolder moved;
  const RunRecord record = read_run_record(copied(moved));
  REQUIRE(record.found);
  CHECK(record.source_map.path == moved.file("source.dx"));
  CHECK(record.target.path == moved.file("target.pqr"));
  CHECK(record.source.sha256.size() == 64);
  CHECK(record.method == "morph");
  CHECK_FALSE(record.maps_computed);
  const Vec3d image = record.source_to_target.rotate({0, 0, 2});
  CHECK(norm(image) == doctest::Approx(2));
}

TEST_CASE("states of VMD are named by their file and frame, kept ones by what they were made of") {
  const ScratchFolder scratch;
  const std::string vtp = copied(scratch);
  auto json = nlohmann::json::parse(espdiff_test::read_file(scratch.file("pair.json")));
  for (auto& input : json.at("inputs")) {
    if (input.at("role") == "source") input["path"] = R"(mol 0 "in/adk.psf" frame 97 sel "name \"CA\"")";
    if (input.at("role") == "target") input["path"] = R"(mol 1 "open.pqr" frame 0 sel "protein")";
  }
  scratch.write("pair.json", json.dump());
  CHECK(read_run_record(vtp).source_name == "adk.psf frame 97");
  CHECK(read_run_record(vtp).target_name == "open.pqr");
  auto original = json.at("inputs").at(0);
  original["role"] = "source_file";
  original["path"] = "folder/1abc.pdb";
  json["inputs"].push_back(original);
  scratch.write("pair.json", json.dump());
  CHECK(read_run_record(vtp).source_name == "1abc.pdb");
  json["inputs"].back()["model"] = 3;
  scratch.write("pair.json", json.dump());
  CHECK(read_run_record(vtp).source_name == "1abc.pdb, model 3");
}

TEST_CASE("a file that is not a record is refused") {
  const ScratchFolder scratch;
  const std::string vtp = copied(scratch);
  scratch.write("pair.json", "{\"inputs\": []}");
  CHECK(contains(message_of([&] { read_run_record(vtp); }), "pair.json: not a record that `espdiff compare` wrote"));
  // A model that no int holds.
  std::string json = espdiff_test::read_file(made().file("pair.json"));
  const std::string model = "\"model\": 1";
  REQUIRE(contains(json, model));
  json.replace(json.find(model), model.size(), "\"model\": 1e30");
  scratch.write("pair.json", json);
  CHECK(contains(message_of([&] { read_run_record(vtp); }), "pair.json: not a record that `espdiff compare` wrote"));
  scratch.write("pair.json", "half a fi");
  CHECK_THROWS_AS(read_comparison(vtp, {}), FormatError);
}

TEST_CASE("maps are used only if they are those of the comparison") {
  const ScratchFolder scratch;
  const std::string vtp = copied(scratch);
  CHECK(read_comparison(vtp, {}).maps.complete());
  espdiff::write_dx(scratch.file("source.dx"), espdiff_test::map_of({{{5, 3, 1}, 1}}));
  MapPair maps = read_comparison(vtp, {}).maps;
  CHECK_FALSE(maps.complete());
  CHECK(contains(maps.why_not, "source.dx has changed since the comparison"));
  std::filesystem::remove(scratch.file("source.dx"));
  maps = read_comparison(vtp, {}).maps;
  CHECK(contains(maps.why_not, "source.dx no longer exists"));
  std::filesystem::remove(scratch.file("pair.json"));
  CHECK(contains(read_comparison(vtp, {}).maps.why_not, "pair.json is missing, which names the maps"));
}

TEST_CASE("maps in vacuum are used like others") {
  const ScratchFolder scratch;
  auto files = read_comparison(copied(scratch), {});
  files.surface.potential_unit = std::string("kT/e") + espdiff::kInVacuum;
  const MapPair maps = espdiff::read_map_pair(files.record, files.surface);
  CHECK_MESSAGE(maps.complete(), maps.why_not);
}

TEST_CASE("potentials computed in process have no map files: the picture's text says so, and no note") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  const std::string atoms = espdiff_test::bent_row(0), bent = espdiff_test::bent_row(0.6);
  const auto run =
      espdiff_test::run_espdiff("compare " + scratch.write("a.pqr", atoms) + " " + scratch.write("b.pqr", bent) +
                                " --quiet --potential pme -o " + scratch.file("pme"));
  REQUIRE(run.status == 0);
  for (const std::string& note : render_surface(scratch.file("pme.vtp"), scratch.file("pme.png"), small()))
    CHECK_FALSE(contains(note, "interpolated"));
  CHECK(contains(espdiff_test::read_file(scratch.file("pme.png")), "potentials interpolated between vertices"));
}

TEST_CASE("a picture contains its inputs, their SHA-256 and its scene") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  Scene scene = small(Layout::kLinked);
  scene.title = "made";
  CHECK(render_surface(made().file("pair.vtp"), scratch.file("linked.png"), scene).empty());
  const std::string png = espdiff_test::read_file(scratch.file("linked.png"));
  const RunRecord record = read_run_record(made().file("pair.vtp"));
  CHECK(contains(png, "source_map source.dx sha256 " + record.source_map.sha256));
  CHECK_FALSE(contains(png, record.source_map.path));
  CHECK(contains(png, "\"layout\": \"linked\""));
  CHECK(contains(png, "coloured by potential_source, scale"));
  CHECK(contains(png, "potentials of the maps at every pixel"));
}

TEST_CASE("data that a scene needs and a file lacks are named") {
  const ScratchFolder scratch;
  const std::string vtp = copied(scratch);
  const auto message = [&](const Scene& scene) { return message_of([&] { read_comparison(vtp, scene); }); };
  Scene cartoon, sliced, linked = small(Layout::kLinked), half_way;
  cartoon.molecule = MoleculeStyle::kCartoon;
  sliced.slice = 0.5;
  half_way.morph = 0.5;
  CHECK_NOTHROW(read_comparison(vtp, cartoon));
  scratch.write("target.pqr", espdiff_test::bent_row(2));
  CHECK(contains(message(cartoon), "target.pqr has changed since the comparison"));
  std::filesystem::remove(scratch.file("target.pqr"));
  CHECK(contains(message(cartoon), "target.pqr no longer exists; compare again, or draw without the molecule"));
  std::filesystem::remove(scratch.file("target.dx"));
  CHECK(contains(message(sliced), "slices need the maps: "));
  CHECK_NOTHROW(read_comparison(vtp, linked));
  std::filesystem::remove(scratch.file("pair.json"));
  CHECK(contains(message(linked), "pair.json: no such file; the superposition in it is needed"));
  CHECK(contains(message(half_way), "morphs)"));
  CHECK(contains(message(cartoon), "it names the structures"));
}

TEST_CASE("the compared model is drawn; without a recorded model, another one is refused") {
  const ScratchFolder scratch;
  // The first model lies 100 A away.
  std::string models = "MODEL        1\n";
  for (int i = 0; i < 7; ++i) {
    char line[128];
    std::snprintf(line, sizeof line, "ATOM  %5d  CA  ALA A%4d    %8.3f%8.3f%8.3f %7.4f %6.4f\n", i + 1, i + 1,
                  100 + 1.4 * i, 0.0, 0.0, 0.1, 2.0);
    models += line;
  }
  models += "ENDMDL\nMODEL        2\n" + espdiff_test::bent_row(0) + "ENDMDL\n";
  const auto run = espdiff_test::run_espdiff("compare " + scratch.write("source.pqr", models) + " " +
                                             scratch.write("target.pqr", espdiff_test::bent_row(0.6)) +
                                             " --source-model 2 --quiet -o " + scratch.file("pair"));
  INFO(run.err);
  REQUIRE(run.status == 0);
  Scene scene;
  scene.array = RenderArray::kDisplacement;
  CHECK_NOTHROW(read_comparison(scratch.file("pair.vtp"), scene));
  scene.molecule = MoleculeStyle::kSticks;
  const ComparisonFiles files = read_comparison(scratch.file("pair.vtp"), scene);
  REQUIRE(files.source_molecule);
  CHECK(files.source_molecule->positions[0].x < 50);
  // As written by an earlier version.
  std::string json = espdiff_test::read_file(scratch.file("pair.json"));
  const std::size_t at = json.find("\"model\": 2");
  REQUIRE(at != std::string::npos);
  scratch.write("pair.json", json.replace(at, 10, "\"model\": 1"));
  CHECK(contains(message_of([&] { read_comparison(scratch.file("pair.vtp"), scene); }),
                 "source.pqr: its model is not the one that was compared"));
}

TEST_CASE("each layout, style and drawing of maps makes a different picture") {
  if (!can_draw()) return;
  const ScratchFolder scratch;
  std::vector<std::string> pictures;
  const auto draw = [&](const std::string& what, const std::function<void(Scene&)>& change) {
    Scene scene = small();
    scene.opacity.greatest = 0.6;
    change(scene);
    render_surface(made().file("pair.vtp"), scratch.file("one.png"), scene);
    const std::string png = espdiff_test::read_file(scratch.file("one.png"));
    // The scene in the PNG's text differs anyway; the pixels must differ too.
    const std::string pixels = png.substr(png.find("IDAT"));
    INFO(what);
    CHECK(std::find(pictures.begin(), pictures.end(), pixels) == pictures.end());
    pictures.push_back(pixels);
  };
  draw("plain", [](Scene&) {});
  draw("linked", [](Scene& s) { s.layout = Layout::kLinked; });
  draw("split", [](Scene& s) { s.layout = Layout::kSplit; });
  draw("moved split", [](Scene& s) {
    s.layout = Layout::kSplit;
    s.split = 0.4;
  });
  draw("morph", [](Scene& s) { s.morph = 0.4; });
  draw("sticks", [](Scene& s) { s.molecule = MoleculeStyle::kSticks; });
  draw("lines", [](Scene& s) { s.molecule = MoleculeStyle::kLines; });
  draw("cartoon", [](Scene& s) { s.molecule = MoleculeStyle::kCartoon; });
  draw("labels", [](Scene& s) { s.n_labels = 3; });
  draw("isopotential", [](Scene& s) { s.isopotentials = {-8, 8}; });
  draw("slice", [](Scene& s) { s.slice = 0.4; });
  draw("field lines", [](Scene& s) { s.n_field_lines = 20; });
  draw("offsets", [](Scene& s) { s.offsets_A = {1, 2}; });
  draw("residues", [](Scene& s) { s.array = RenderArray::kResidue; });
  draw("shape", [](Scene& s) { s.array = RenderArray::kPlain; });
  draw("magnitude", [](Scene& s) { s.array = RenderArray::kMagnitude; });
  draw("purple", [](Scene& s) { s.colours = "purple-orange"; });
  draw("turned", [](Scene& s) { s.turn_deg = 40; });
  draw("tilted", [](Scene& s) { s.tilt_deg = 40; });
  draw("zoomed", [](Scene& s) { s.zoom = 2; });
}

TEST_CASE("a picked point has the engine's values") {
  const ComparisonFiles files = read_comparison(made().file("pair.vtp"), {});
  const SurfaceFile& surface = files.surface;
  const StartSurface start = superposed_start(surface, files.record);
  SurfacePicker picker(files, start);
  std::size_t n_picked = 0;
  for (std::size_t v = 0; v < surface.positions.size(); v += 37) {
    const Vec3d p = surface.positions[v], n = static_cast<Vec3d>(surface.normals[v]);
    // From just outside to just inside, so that nothing is in between.
    const auto picked = picker.pick(p + 0.2 * n, p - 0.2 * n, 1);
    if (!picked) continue;
    ++n_picked;
    CHECK(norm(picker.place(*picked, 1) - p) < 0.02);
    CHECK(picked->weights[0] + picked->weights[1] + picked->weights[2] == doctest::Approx(1));
    CHECK(picked->target - picked->source == doctest::Approx(surface.potential_difference[v]).epsilon(0.02));
    CHECK(picked->displacement_A == doctest::Approx(surface.displacement[v]).epsilon(0.05));
    // The same point on the superposed source.
    const Vec3d there = static_cast<Vec3d>(start.positions[v]);
    CHECK(norm(picker.place(*picked, 0) - there) < 0.03);
  }
  CHECK(n_picked > surface.positions.size() / 37 * 9 / 10);
  CHECK_FALSE(picker.pick({500, 500, 500}, {500, 500, 400}, 1));
}

TEST_CASE("the superposed source is lit by its own surface's normals, by its triangles' in files without them") {
  ComparisonFiles files = read_comparison(made().file("pair.vtp"), {});
  SurfaceFile& surface = files.surface;
  REQUIRE(surface.source_normals.size() == surface.positions.size());
  const StartSurface analytic = superposed_start(surface, files.record);
  for (std::size_t v = 0; v < surface.positions.size(); v += 7) {
    const Vec3d turned = files.record.source_to_target.rotate(static_cast<Vec3d>(surface.source_normals[v]));
    CHECK(norm(static_cast<Vec3d>(analytic.normals[v]) - turned) < 1e-6);
  }
  surface.source_normals.clear();
  const StartSurface of_triangles = superposed_start(surface, files.record);
  double mean_cosine = 0;
  for (std::size_t v = 0; v < surface.positions.size(); ++v)
    mean_cosine += static_cast<double>(dot(analytic.normals[v], of_triangles.normals[v])) /
                   static_cast<double>(surface.positions.size());
  CHECK(mean_cosine > 0.98);
  CHECK(mean_cosine < 1 - 1e-6);
}

TEST_CASE("a picked point is described in text") {
  Scene scene;
  scene.n_labels = 1;
  const ComparisonFiles files = read_comparison(made().file("pair.vtp"), scene);
  PickedPoint point;
  point.source = -1.25F;
  point.target = 0.5F;
  point.displacement_A = 0.4F;
  point.residue = 2;
  const auto text = [&] {
    std::string all;
    for (const std::string& line : picked_in_words(point, files, "kT/e")) all += line + "\n";
    return all;
  };
  CHECK(contains(text(), "ALA 3 of the source"));
  CHECK(contains(text(), "1.750 kT/e, the sign changes"));
  CHECK(contains(text(), "0.400 A to its counterpart"));
  CHECK(contains(text(), "trusted here"));
  point.is_untrusted = true;
  CHECK(contains(text(), "not trusted here"));
  point.is_matched = false;
  point.target = std::nanf("");
  CHECK(contains(text(), "unmatched: no place on the target"));
  CHECK(contains(text(), "target            no value"));
}

TEST_CASE("the command line reports errors and leaves no file") {
  using espdiff_test::run_espdiff;
  const ScratchFolder scratch;
  const std::string vtp = made().file("pair.vtp"), png = " -o " + scratch.file("out.png");
  const auto refused = [&](const std::string& arguments, int status, const std::string& part,
                           const std::string& before = "") {
    const auto run = run_espdiff(arguments, before);
    INFO(run.err);
    CHECK(run.status == status);
    CHECK(contains(run.err, part));
    CHECK(espdiff_test::n_lines(run.err) <= 2);
  };
  refused("view " + scratch.file("absent.vtp"), 1, "DISPLAY is not set; put `xvfb-run -a` before", "env -u DISPLAY");
  refused("view " + vtp, 1, "the X display ':9876' (DISPLAY) cannot be opened", "env DISPLAY=:9876");
  refused("render " + vtp + png, 1, "DISPLAY is not set", "env -u DISPLAY");
  refused("render " + scratch.file("absent.vtp") + png, 2, "absent.vtp: no such file");
  refused("render " + vtp + png + " --scene " + scratch.file("no.json"), 2, "no.json: no such scene file");
  refused("render " + vtp + png + " --range wide", 2,
          "--range: 'wide' is not one number, such as 5 for -5 to 5, or two");
  refused("render " + vtp + png + " --range 3:x", 2, "--range: '3:x' is not one number");
  refused("render " + vtp + png + " --range 1x:2", 2, "--range: '1x:2' is not one number");
  refused("render " + vtp + png + " --range 1:2x", 2, "--range: '1:2x' is not one number");
  refused("render " + vtp + png + " --layout round", 2, "round");
  refused("render " + vtp + png + " --morph 2", 2, "--morph: '2' is not a number from 0 to 1");
  CHECK(scratch.n_files() == 0);
}

TEST_CASE("a saved scene draws the same picture again, and options change it") {
  if (!can_draw()) return;
  using espdiff_test::run_espdiff;
  const ScratchFolder scratch;
  const std::string size = " --width 420 --height 400";
  REQUIRE(run_espdiff("render " + made().file("pair.vtp") + " -o " + scratch.file("a.png") + size +
                      " --range=-3:9 --layout split --split 0.3 --save-scene " + scratch.file("s.json"))
              .status == 0);
  REQUIRE(run_espdiff("render " + made().file("pair.vtp") + " -o " + scratch.file("b.png") + " --scene " +
                      scratch.file("s.json"))
              .status == 0);
  CHECK(espdiff_test::read_file(scratch.file("a.png")) == espdiff_test::read_file(scratch.file("b.png")));
  REQUIRE(run_espdiff("render " + made().file("pair.vtp") + " -o " + scratch.file("c.png") + " --scene " +
                      scratch.file("s.json") + " --split 0.6")
              .status == 0);
  CHECK(espdiff_test::read_file(scratch.file("a.png")) != espdiff_test::read_file(scratch.file("c.png")));
}

TEST_CASE("the length bar follows the camera, and axes show the target's x, y and z") {
  if (!can_draw()) return;
  Scene scene = small();
  const ComparisonFiles files = read_comparison(made().file("pair.vtp"), scene);
  ComparisonScene drawn(files, scene);
  const auto window = make_hidden_window();
  window->SetSize(scene.width, scene.height);
  drawn.add_to(window, 1);
  const auto length_of_bar = [&] {
    for (const std::string& text : texts_of(window)) {
      // The opacity key also has lengths, of 0.5 and 3 A.
      if (contains(text, " \xC3\x85") && text != "0.5 \xC3\x85" && text != "3 \xC3\x85") return std::stod(text);
    }
    return 0.0;
  };
  const double before = length_of_bar();
  CHECK(before > 0);
  drawn.panels().front().renderer->GetActiveCamera()->Zoom(10);
  drawn.camera_moved();
  CHECK(length_of_bar() < before / 4);
  CHECK(texts_of(window).count("x") == 0);
  scene.axes = true;
  drawn.change_to(scene);
  for (const char* letter : {"x", "y", "z"}) CHECK(texts_of(window).count(letter) == 1);
}

TEST_CASE("a picture is named as what it is, and a focus is a part of the result") {
  const ScratchFolder folder;
  const std::string vtp = compare_made_pair(folder, " --region //A/3-4 --patch end=//A/6");
  for (const char* ending : {"svg", "pdf", "jpg"}) {
    const Outcome outcome = run_espdiff("render " + vtp + " -o " + folder.file(std::string("x.") + ending));
    CHECK(outcome.status == 2);
    CHECK(contains(outcome.err, std::string("x.") + ending + ": surfaces are drawn as PNG; name it .png"));
  }
  const Outcome none = run_espdiff("render " + vtp + " --focus nose -o " + folder.file("x.png"));
  CHECK(none.status == 2);
  CHECK(contains(none.err, "--focus nose is no part of the result, which has end, region"));
}

TEST_CASE("the only field of an ensemble's file is drawn without being named, and two have to be") {
  const ScratchFolder folder;
  const std::vector<Vec3d> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  const std::vector<float> source = {1, 2, 3}, target = {2, 4, 6}, difference = {1, 2, 3}, p = {0.01F, 0.2F, 1};
  const auto write = [&](const char* name, const std::vector<std::string>& fields) {
    VtpSurface surface;
    surface.points = VtpArray("points", points);
    surface.triangles = &triangles;
    surface.point_arrays.emplace_back("p_family_wise", p);
    for (const std::string& field : fields) {
      surface.point_arrays.emplace_back(field + "_source", source);
      surface.point_arrays.emplace_back(field + "_target", target);
      surface.point_arrays.emplace_back(field + "_difference", difference);
      surface.texts.emplace_back(field + "_label", "Label of " + field);
      surface.texts.emplace_back(field + "_unit", "e");
    }
    std::ostringstream text;
    write_vtp(text, surface);
    return folder.write(name, text.str());
  };
  const SurfaceFile one = read_surface_file(write("one.vtp", {"charge"}));
  CHECK(one.field == "charge");
  CHECK(one.quantity == "Label of charge");
  CHECK(one.values(RenderArray::kDifference) == difference);
  const std::string both = write("both.vtp", {"charge", "donor"});
  const SurfaceFile two = read_surface_file(both);
  CHECK(contains(message_of([&] { two.values(RenderArray::kDifference); }),
                 "draw one of its fields, field charge of charge, donor, or colour by another array"));
  CHECK(read_surface_file(both, "donor").quantity == "Label of donor");
}
