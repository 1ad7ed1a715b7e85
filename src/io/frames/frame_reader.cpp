// frame_reader.cpp: the reader that the surrounding program has.
#include "io/frames/frame_reader.h"

#include <utility>

namespace espdiff {
namespace {

FrameReader& the_frame_reader() {
  static FrameReader reader;
  return reader;
}

}  // namespace

const FrameReader* frame_reader() { return the_frame_reader().open ? &the_frame_reader() : nullptr; }
const std::string& frame_reader_remedy() { return the_frame_reader().remedy; }
void set_frame_reader(FrameReader reader) { the_frame_reader() = std::move(reader); }

}  // namespace espdiff
