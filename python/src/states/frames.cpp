// frames.cpp: the frames of trajectories, read by VMD's plugins as on the command line, one at a time.
#include "frames.h"

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "frames/frame_files.h"
#include "io/frames/open_structure.h"
#include "python/src/boundary/run.h"
#include "state.h"

namespace espdiff::python {
namespace {

namespace nb = nanobind;

class PyFrames {
 public:
  PyFrames(const std::string& topology, std::vector<std::string> files, const std::string& plugins)
      : opener_(topology, plugins, progress_) {
    run(nb::none(), [&](const Progress&) {
      frames_.emplace(std::move(files), [this](const std::string& path) { return opener_.open(path); });
    });
  }

  int size() const { return frames_->n_frames(); }

  const std::string& incomplete() const { return frames_->incomplete(); }

  StatePtr frame(int number) {
    const int n = size();
    if (number < -n || number >= n)
      throw nb::index_error(
          ("there is no frame " + std::to_string(number) + "; there are " + std::to_string(n)).c_str());
    auto state = std::make_shared<State>();
    const int chosen = number < 0 ? number + n : number;
    run(nb::none(), [&](const Progress&) {
      const std::lock_guard<std::mutex> lock(one_at_a_time_);
      state->molecule = frames_->read(chosen, {1, true, true, {}});
      state->cell = frames_->cell(chosen);
    });
    note_input(*state);
    return state;
  }

 private:
  Progress progress_;
  TrajectoryOpener opener_;
  std::optional<FrameFiles> frames_;
  std::mutex one_at_a_time_;
};

}  // namespace

void add_frames(nb::module_& module) {
  nb::class_<PyFrames>(module, "Frames",
                       "The frames of trajectories, as States, in the order of the files: for state in frames, "
                       "frames[10], frames[-1]. One is in memory.")
      .def(nb::init<const std::string&, std::vector<std::string>, const std::string&>(), nb::arg("topology"),
           nb::arg("files"), nb::arg("plugins"))
      .def("__len__", &PyFrames::size)
      .def_prop_ro("incomplete", &PyFrames::incomplete, "What is missing of a DCD; empty where the files are whole.")
      .def("__getitem__", &PyFrames::frame, nb::arg("frame"), "A frame with all its atoms, as a State.");
}

}  // namespace espdiff::python
