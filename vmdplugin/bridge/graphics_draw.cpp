// graphics_draw.cpp: the arguments of `graphics MOL tricolor`, each vertex written once, and the calls.
#include "graphics_draw.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "base/formatted.h"

namespace espdiff {
namespace {

constexpr std::size_t kFirstVertex = 3;  // of "graphics MOL tricolor P P P N N N C C C"
constexpr std::size_t kNumArguments = 12;

/// Writes value / 10^n_decimals as a decimal number.
char* write_fixed(char* out, long long value, int n_decimals) {
  std::array<char, 24> digits{};
  int n = 0;
  auto rest = static_cast<unsigned long long>(std::llabs(value));
  if (value < 0) *out++ = '-';
  do {
    digits[static_cast<std::size_t>(n++)] = static_cast<char>('0' + rest % 10);
    rest /= 10;
  } while (rest > 0 || n <= n_decimals);
  while (n > 0) {
    *out++ = digits[static_cast<std::size_t>(--n)];
    if (n == n_decimals && n_decimals > 0) *out++ = '.';
  }
  return out;
}

/// Three numbers as a Tcl list.
using VectorText = std::array<char, 40>;

void write_vector(VectorText& text, Vec3f v, int n_decimals) {
  char* end = text.data();
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) *end++ = ' ';
    end = write_fixed(end, std::llround(1000.0 * static_cast<double>(v[axis])), n_decimals);
  }
  *end = '\0';
}

/// Arguments for a command made by Tcl_CreateCommand, as VMD's is: text.
class TextArguments {
 public:
  using Argument = const char*;

  TextArguments(const TriangleSoup& soup, int mol)
      : soup_(soup), mol_(std::to_string(mol)), vertices_(soup.positions->size()), colours_(kMostColourId + 1) {
    arguments = {"graphics", mol_.c_str(), "tricolor"};
  }

  void set_corner(std::size_t corner, std::size_t vertex) {
    Vertex& v = vertices_[vertex];
    if (v.position[0] == '\0') {  // first use
      write_vector(v.position, (*soup_.positions)[vertex], 3);
      write_vector(v.normal, (*soup_.normals)[vertex], 0);  // VMD divides by its length
    }
    std::string& colour = colours_[static_cast<std::size_t>(soup_.colour[vertex])];
    if (colour.empty()) colour = std::to_string(soup_.colour[vertex]);
    arguments[kFirstVertex + corner] = v.position.data();
    arguments[kFirstVertex + 3 + corner] = v.normal.data();
    arguments[kFirstVertex + 6 + corner] = colour.c_str();
  }

  std::array<Argument, kNumArguments> arguments{};

 private:
  struct Vertex {
    VectorText position{}, normal{};
  };
  const TriangleSoup& soup_;
  std::string mol_;
  std::vector<Vertex> vertices_;
  std::vector<std::string> colours_;
};

/// Arguments for a command made by Tcl_CreateObjCommand: a wrapper in Tcl, or another version of VMD.
class ObjectArguments {
 public:
  using Argument = Tcl_Obj*;

  ObjectArguments(const TriangleSoup& soup, int mol) : soup_(soup), vertices_(soup.positions->size()) {
    arguments = {keep(Tcl_NewStringObj("graphics", -1)), keep(Tcl_NewIntObj(mol)),
                 keep(Tcl_NewStringObj("tricolor", -1))};
  }
  ~ObjectArguments() {
    for (Tcl_Obj* object : kept_) Tcl_DecrRefCount(object);
  }
  ObjectArguments(const ObjectArguments&) = delete;
  ObjectArguments& operator=(const ObjectArguments&) = delete;

  void set_corner(std::size_t corner, std::size_t vertex) {
    Vertex& v = vertices_[vertex];
    if (v.position == nullptr) {
      v.position = vector_object((*soup_.positions)[vertex]);
      v.normal = vector_object((*soup_.normals)[vertex]);
      v.colour = keep(Tcl_NewIntObj(soup_.colour[vertex]));
    }
    arguments[kFirstVertex + corner] = v.position;
    arguments[kFirstVertex + 3 + corner] = v.normal;
    arguments[kFirstVertex + 6 + corner] = v.colour;
  }

  std::array<Argument, kNumArguments> arguments{};

 private:
  struct Vertex {
    Tcl_Obj *position = nullptr, *normal = nullptr, *colour = nullptr;
  };

  Tcl_Obj* keep(Tcl_Obj* object) {
    Tcl_IncrRefCount(object);
    kept_.push_back(object);
    return object;
  }

  Tcl_Obj* vector_object(Vec3f v) {
    std::array<Tcl_Obj*, 3> numbers{};
    for (int axis = 0; axis < 3; ++axis) {
      numbers[static_cast<std::size_t>(axis)] = Tcl_NewDoubleObj(static_cast<double>(v[axis]));
    }
    return keep(Tcl_NewListObj(3, numbers.data()));
  }

  const TriangleSoup& soup_;
  std::vector<Vertex> vertices_;
  std::vector<Tcl_Obj*> kept_;
};

void check_vector(Vec3f v, const char* what, std::size_t vertex) {
  constexpr float kMost = 1e7F;  // fits VectorText
  if (std::fabs(v.x) < kMost && std::fabs(v.y) < kMost && std::fabs(v.z) < kMost) return;
  throw InputError("the " + std::string(what) + " of vertex " + std::to_string(vertex) + " is " +
                   formatted("%g %g %g", double{v.x}, double{v.y}, double{v.z}) + "; numbers within 1e7 were expected");
}

/// Checked before the first triangle, so that no surface is half drawn.
void check_soup(const TriangleSoup& soup) {
  const std::size_t n = soup.positions->size();
  if (soup.normals->size() != n || soup.colour.size() != n) {
    throw InputError("a surface of " + std::to_string(n) + " vertices has " + std::to_string(soup.normals->size()) +
                     " normals and " + std::to_string(soup.colour.size()) + " colours; the numbers must be equal");
  }
  if (!soup.drawn.empty() && soup.drawn.size() != soup.triangles->size()) {
    throw InputError("'drawn' has " + std::to_string(soup.drawn.size()) + " entries for " +
                     std::to_string(soup.triangles->size()) + " triangles; the numbers must be equal");
  }
  for (const int id : soup.colour) {
    if (id >= 0 && id <= kMostColourId) continue;
    throw InputError("colour id " + std::to_string(id) + "; 0 to " + std::to_string(kMostColourId) + " were expected");
  }
  for (std::size_t i = 0; i < n; ++i) {
    check_vector((*soup.positions)[i], "position", i);
    check_vector((*soup.normals)[i], "normal", i);
  }
  for (const Triangle& triangle : *soup.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex < n) continue;
      throw InputError("a triangle has vertex " + std::to_string(vertex) + ", but there are " + std::to_string(n) +
                       " vertices");
    }
  }
}

/// `call(arguments)` runs the command and returns Tcl's code.
template <typename Arguments, typename Call>
std::size_t draw_with(Tcl_Interp* interp, int mol, const TriangleSoup& soup, const Call& call) {
  Arguments arguments(soup, mol);
  std::size_t n_drawn = 0;
  Tcl_ResetResult(interp);  // not for each triangle: it takes half as long as VMD's procedure
  for (std::size_t t = 0; t < soup.triangles->size(); ++t) {
    if (!soup.drawn.empty() && soup.drawn[t] == 0) continue;
    for (std::size_t corner = 0; corner < 3; ++corner) arguments.set_corner(corner, (*soup.triangles)[t][corner]);
    if (call(arguments.arguments.data()) != TCL_OK) {
      throw InputError("VMD refused triangle " + std::to_string(t) + " in molecule " + std::to_string(mol) + ": " +
                       Tcl_GetStringResult(interp));
    }
    ++n_drawn;
  }
  Tcl_ResetResult(interp);
  return n_drawn;
}

constexpr const char* kNoGraphics = "there is no command 'graphics', by which VMD draws; run this inside VMD";

}  // namespace

std::size_t draw_triangles(Tcl_Interp* interp, int mol, const TriangleSoup& soup) {
  check_soup(soup);
  Tcl_CmdInfo command;
  if (Tcl_GetCommandInfo(interp, "::graphics", &command) == 0) {
    throw InputError(kNoGraphics);
  }
  // Calls the command's procedure directly: looking it up for each triangle would take longer.
  constexpr int kCount = static_cast<int>(kNumArguments);
  if (command.isNativeObjectProc != 0) {
    return draw_with<ObjectArguments>(interp, mol, soup, [&](Tcl_Obj* const* arguments) {
      return command.objProc(command.objClientData, interp, kCount, arguments);
    });
  }
  return draw_with<TextArguments>(interp, mol, soup, [&](const char** arguments) {
    return command.proc(command.clientData, interp, kCount, arguments);
  });
}

void add_pick_points(Tcl_Interp* interp, int mol, const std::vector<Vec3f>& positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) check_vector(positions[i], "position", i);
  Tcl_CmdInfo command;
  if (Tcl_GetCommandInfo(interp, "::graphics", &command) == 0) throw InputError(kNoGraphics);
  const std::string molecule = std::to_string(mol);
  VectorText place{};
  std::array<const char*, 4> arguments{"graphics", molecule.c_str(), "pickpoint", place.data()};
  constexpr int kCount = static_cast<int>(arguments.size());
  for (const Vec3f position : positions) {
    write_vector(place, position, 3);
    // The interpreter has a `proc` for commands of both kinds; that of objects makes objects of the texts.
    if (command.proc(command.clientData, interp, kCount, arguments.data()) != TCL_OK)
      throw InputError("VMD refused a pick point in molecule " + molecule + ": " + Tcl_GetStringResult(interp));
  }
  Tcl_ResetResult(interp);
}

}  // namespace espdiff
