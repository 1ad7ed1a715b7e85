// graphics_draw.cpp: what a command `graphics` is called with, when it is made of C strings as VMD's, or a Tcl
// procedure.
#undef USE_TCL_STUBS  // this program is a whole Tcl, not a module of one
#include "vmdplugin/bridge/graphics_draw.h"

#include <doctest/doctest.h>

#include <limits>
#include <string>

#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;

namespace {

/// An interpreter whose `graphics` keeps its calls, with the module's stubs set up.
class Vmd {
 public:
  Vmd() : interp(Tcl_CreateInterp()) {
    REQUIRE((Tcl_InitStubs)(interp, "8.5", 0) != nullptr);  // in parentheses: the function, not the macro
  }
  ~Vmd() { Tcl_DeleteInterp(interp); }
  Vmd(const Vmd&) = delete;
  Vmd& operator=(const Vmd&) = delete;

  void draw_by_strings() { Tcl_CreateCommand(interp, "graphics", record, this, nullptr); }
  void draw_by_procedure() {
    REQUIRE(Tcl_Eval(interp, "proc graphics args {lappend ::calls $args; llength $::calls}") == TCL_OK);
  }

  Tcl_Interp* interp;
  std::vector<std::string> calls;

 private:
  static int record(ClientData self, Tcl_Interp* interp, int n, const char** arguments) {
    if (arguments[1] != std::string("3")) {
      Tcl_SetResult(interp, const_cast<char*>("graphics: invalid graphics molecule"), TCL_STATIC);
      return TCL_ERROR;
    }
    std::string call;
    for (int i = 1; i < n; ++i) call += (i > 1 ? "|" : "") + std::string(arguments[i]);
    static_cast<Vmd*>(self)->calls.push_back(call);
    Tcl_SetResult(interp, const_cast<char*>("17"), TCL_VOLATILE);
    return TCL_OK;
  }
};

struct ColouredSquare {
  std::vector<Vec3f> positions{{0, 0, 0}, {1.5F, -0.0004F, 0}, {-12.3456F, 1000, 0.25F}, {0, 1, -0.0307F}};
  std::vector<Vec3f> normals{{0, 0, 1}, {0.6F, 0, -0.8F}, {0, 1, 0}, {0, 0, 1}};
  std::vector<Triangle> triangles{{{0, 1, 2}}, {{2, 1, 3}}};
  TriangleSoup soup;

  ColouredSquare() {
    soup.positions = &positions;
    soup.normals = &normals;
    soup.triangles = &triangles;
    soup.colour = {33, 1056, 7, 0};
  }
};

}  // namespace

TEST_CASE("draw_triangles: one call of VMD's procedure for each triangle") {
  Vmd vmd;
  vmd.draw_by_strings();
  const ColouredSquare square;
  CHECK(draw_triangles(vmd.interp, 3, square.soup) == 2);
  CHECK(vmd.calls == std::vector<std::string>{"3|tricolor|0.000 0.000 0.000|1.500 0.000 0.000|-12.346 1000.000 0.250|"
                                              "0 0 1000|600 0 -800|0 1000 0|33|1056|7",
                                              "3|tricolor|-12.346 1000.000 0.250|1.500 0.000 0.000|0.000 1.000 -0.031|"
                                              "0 1000 0|600 0 -800|0 0 1000|7|1056|0"});
  CHECK(Tcl_GetStringResult(vmd.interp) == std::string());
}

TEST_CASE("draw_triangles: triangles that are not drawn are left out") {
  Vmd vmd;
  vmd.draw_by_strings();
  ColouredSquare square;
  square.soup.drawn = {0, 1};
  CHECK(draw_triangles(vmd.interp, 3, square.soup) == 1);
  REQUIRE(vmd.calls.size() == 1);
  CHECK(vmd.calls[0].find("3|tricolor|-12.346") == 0);
  square.soup.drawn = {0, 0};
  CHECK(draw_triangles(vmd.interp, 3, square.soup) == 0);
}

TEST_CASE("draw_triangles: a command made of objects gets lists of numbers") {
  Vmd vmd;
  vmd.draw_by_procedure();
  const ColouredSquare square;
  CHECK(draw_triangles(vmd.interp, 3, square.soup) == 2);
  CHECK(Tcl_GetStringResult(vmd.interp) == std::string());
  REQUIRE(Tcl_Eval(vmd.interp, "set sum 0; foreach c $calls {incr sum [llength $c]}; set sum") == TCL_OK);
  CHECK(Tcl_GetStringResult(vmd.interp) == std::string("22"));
  REQUIRE(Tcl_Eval(vmd.interp, "list [lindex $calls 1 3] [lrange [lindex $calls 1] 8 end]") == TCL_OK);
  CHECK(Tcl_GetStringResult(vmd.interp) == std::string("{1.5 -0.00039999998989515007 0.0} {7 1056 0}"));
}

TEST_CASE("draw_triangles: what cannot be drawn is refused before the first triangle") {
  Vmd vmd;
  const auto refusal = [&](auto change, int mol = 3) {
    ColouredSquare square;
    change(square);
    return message_of([&] { draw_triangles(vmd.interp, mol, square.soup); });
  };
  CHECK(refusal([](ColouredSquare&) {}) == "there is no command 'graphics', by which VMD draws; run this inside VMD");
  vmd.draw_by_strings();
  CHECK(refusal([](ColouredSquare&) {}, 4) ==
        "VMD refused triangle 0 in molecule 4: graphics: invalid graphics molecule");
  CHECK(refusal([](ColouredSquare& s) { s.soup.colour.pop_back(); }) ==
        "a surface of 4 vertices has 4 normals and 3 colours; the numbers must be equal");
  CHECK(refusal([](ColouredSquare& s) { s.soup.colour[2] = 1057; }) == "colour id 1057; 0 to 1056 were expected");
  CHECK(refusal([](ColouredSquare& s) { s.soup.colour[0] = -1; }) == "colour id -1; 0 to 1056 were expected");
  CHECK(refusal([](ColouredSquare& s) { s.soup.drawn = {1}; }) ==
        "'drawn' has 1 entries for 2 triangles; the numbers must be equal");
  CHECK(refusal([](ColouredSquare& s) { s.triangles[1][2] = 4; }) ==
        "a triangle has vertex 4, but there are 4 vertices");
  CHECK(refusal([](ColouredSquare& s) { s.positions[1].y = std::numeric_limits<float>::quiet_NaN(); }) ==
        "the position of vertex 1 is 1.5 nan 0; numbers within 1e7 were expected");
  CHECK(refusal([](ColouredSquare& s) { s.positions[3].z = -2e7F; }).find("the position of vertex 3 is ") == 0);
  CHECK(refusal([](ColouredSquare& s) { s.normals[0].x = std::numeric_limits<float>::infinity(); }) ==
        "the normal of vertex 0 is inf 0 1; numbers within 1e7 were expected");
  CHECK(vmd.calls.empty());
}

TEST_CASE("add_pick_points: one call for each point, by strings and by a procedure") {
  Vmd vmd;
  const std::vector<Vec3f> points{{1, 2, 3}, {-0.5F, 0, 1000}};
  CHECK(message_of([&] { add_pick_points(vmd.interp, 3, points); }) ==
        "there is no command 'graphics', by which VMD draws; run this inside VMD");
  vmd.draw_by_strings();
  add_pick_points(vmd.interp, 3, points);
  CHECK(vmd.calls == std::vector<std::string>{"3|pickpoint|1.000 2.000 3.000", "3|pickpoint|-0.500 0.000 1000.000"});
  CHECK(Tcl_GetStringResult(vmd.interp) == std::string());
  CHECK(message_of([&] { add_pick_points(vmd.interp, 4, points); }) ==
        "VMD refused a pick point in molecule 4: graphics: invalid graphics molecule");
  CHECK(message_of([&] { add_pick_points(vmd.interp, 3, {{0, 2e7F, 0}}); }).find("the position of vertex 0 is ") == 0);
  vmd.draw_by_procedure();
  add_pick_points(vmd.interp, 3, points);
  REQUIRE(Tcl_Eval(vmd.interp, "lindex $calls 1") == TCL_OK);
  CHECK(Tcl_GetStringResult(vmd.interp) == std::string("3 pickpoint {-0.500 0.000 1000.000}"));
}
