// command_line.cpp: the command line in this process, whose trajectories MDAnalysis reads where VMD's plugins are
// absent.
#include "command_line.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "cli/command_line.h"
#include "io/files/read_input.h"
#include "io/frames/frame_reader.h"
#include "io/structures/coordinate_file.h"
#include "python/src/boundary/held.h"
#include "python/src/states/state.h"

namespace espdiff::python {
namespace {

namespace nb = nanobind;

using Positions = nb::ndarray<const float, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

/// Calls Python, holding its lock. What it raises is an error of the file.
template <typename Function>
auto in_python(const std::string& path, const Function& function) {
  const nb::gil_scoped_acquire locked;
  try {
    return function(nb::module_::import_("espdiff._frames"));
  } catch (nb::python_error& error) {
    const std::string text = nb::cast<std::string>(nb::str(error.value()));
    throw FormatError(path, 0, "MDAnalysis cannot read it: " + text.substr(0, text.find('\n')));
  }
}

/// The frames of a trajectory, read by MDAnalysis.
class PythonFrames : public CoordinateFile {
 public:
  PythonFrames(std::string path, std::size_t n_atoms) : path_(std::move(path)), n_atoms_(n_atoms) {
    require_regular_file(path_);
    const std::size_t n_there = in_python(path_, [&](const nb::module_& python) {
      frames_.object = python.attr("Frames")(path_, n_atoms_);
      n_frames_ = nb::cast<int>(frames_.object.attr("n_frames"));
      return nb::cast<std::size_t>(frames_.object.attr("n_atoms"));
    });
    if (n_there != n_atoms_)
      throw InputError(path_ + ": has " + std::to_string(n_there) + " atoms in each frame, and the structure has " +
                       std::to_string(n_atoms_) + "; give the structure or topology that it was made with");
    if (n_frames_ == 0) throw FormatError(path_, 0, "there are no frames");
  }

  const std::string& path() const override { return path_; }
  int n_frames() const override { return n_frames_; }

  const CoordinateFrame& frame(int number) override {
    if (number == held_) return frame_;
    held_ = -1;
    in_python(path_, [&](const nb::module_&) {
      const nb::object read = frames_.object.attr("read")(number);
      const auto positions = nb::cast<Positions>(read[0]);
      if (positions.shape(0) != n_atoms_)
        throw FormatError(path_, 0, "frame " + std::to_string(number) + " has another number of atoms");
      const auto* const first = reinterpret_cast<const Vec3f*>(positions.data());
      frame_.positions.assign(first, first + n_atoms_);
      const auto cell = nb::cast<std::vector<double>>(read[1]);
      frame_.cell.reset();
      if (cell.size() == 6 && cell[0] > 1 && cell[1] > 1 && cell[2] > 1)
        frame_.cell = UnitCell{{cell[0], cell[1], cell[2]}, {cell[3], cell[4], cell[5]}};
      return 0;
    });
    held_ = number;
    return frame_;
  }

 private:
  std::string path_;
  std::size_t n_atoms_ = 0;
  Held frames_;
  int n_frames_ = 0, held_ = -1;  // held_: the frame in frame_, -1 for none
  CoordinateFrame frame_;
};

Molecule read_atoms(const std::string& path) {
  require_regular_file(path);
  return in_python(
      path, [&](const nb::module_& python) { return nb::cast<const State&>(python.attr("atoms")(path)).molecule; });
}

/// @param reader MDAnalysis' name and version; empty where it is not installed
int command_line(std::vector<std::string> arguments, const std::string& reader) {
  FrameReader frames{reader, ", or `pip install MDAnalysis`, which reads them as well"};
  if (!reader.empty()) {
    frames.read_atoms = read_atoms;
    frames.open = [](const std::string& path, std::size_t n_atoms) {
      return std::make_unique<PythonFrames>(path, n_atoms);
    };
  }
  set_frame_reader(std::move(frames));
  arguments.insert(arguments.begin(), "espdiff");
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  const nb::gil_scoped_release unlocked;
  const int status = cli::run_command_line(static_cast<int>(arguments.size()), words.data());
  std::cout.flush();
  std::fflush(nullptr);
  return status;
}

}  // namespace

void add_command_line(nb::module_& module) {
  module.def("command_line", &command_line, nb::arg("arguments"), nb::arg("reader"),
             "Runs `espdiff ARGUMENTS...` in this process; returns its exit status.");
}

}  // namespace espdiff::python
