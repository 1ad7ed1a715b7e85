// frame_range.cpp: the grammar of frames: VMD's forms, what they mean, and what is refused with which words.
#include "frames/frame_range.h"

#include "base/error.h"
#include "support/test_data.h"

using espdiff::frames_in_words;
using espdiff::FrameSet;
using espdiff::parse_frames;
using espdiff_test::message_of;

namespace {

using Frames = std::vector<int>;

Frames frames(const std::string& text, int n_frames = 10) { return parse_frames(text, {n_frames}); }

std::string refusal(const std::string& text, const FrameSet& set = {6, std::nullopt, "-frames", "'a.pdb'"}) {
  return message_of([&] { parse_frames(text, set); });
}

}  // namespace

TEST_SUITE_BEGIN("trajectory");

TEST_CASE("frames: all, one, begin:end, begin:step:end, both ends included") {
  CHECK(frames("all", 3) == Frames{0, 1, 2});
  CHECK(frames("7") == Frames{7});
  CHECK(frames("-1") == Frames{9});
  CHECK(frames("first") == Frames{0});
  CHECK(frames("last") == Frames{9});
  CHECK(frames("end") == Frames{9});
  CHECK(frames("8:end") == Frames{8, 9});
  CHECK(frames("1:5") == Frames{1, 2, 3, 4, 5});
  CHECK(frames("0:4:9") == Frames{0, 4, 8});
  CHECK(frames("-3:2:last") == Frames{7, 9});
  CHECK(frames("first:first") == Frames{0});
}

TEST_CASE("frames: the one that VMD shows, and lists") {
  CHECK(parse_frames("now", {10, 4}) == Frames{4});
  CHECK(parse_frames("now:3:end", {10, 4}) == Frames{4, 7});
  CHECK(frames("0,3,9") == Frames{0, 3, 9});
  CHECK(frames(" 0:2:4 7  last ") == Frames{0, 2, 4, 7, 9});
}

TEST_CASE("frames: what is wrong is named, with what to write") {
  CHECK(refusal("0:1:6") == "-frames '0:1:6': frame 6 is not among the frames 0 to 5 of 'a.pdb'");
  CHECK(refusal("-7") == "-frames '-7': frame -7 is not among the frames 0 to 5 of 'a.pdb'");
  CHECK(refusal("3:2") == "-frames '3:2': '3:2' ends before it begins");
  CHECK(refusal("0:0:2") == "-frames '0:0:2': the step is 0; 1 or more is needed");
  CHECK(refusal("0:x:2") == "-frames '0:x:2': the step 'x' is no whole number");
  CHECK(refusal("a:5").find(
            "-frames 'a:5': 'a' is no frame; give all, first, now, last (or end), a number from 0 (-1 is the "
            "last), begin:end or begin:step:end") == 0);
  CHECK(refusal("0:1:2:3").find("more than two colons") != std::string::npos);
  CHECK(refusal("").find("no frame is named") != std::string::npos);
  CHECK(refusal("3,3").find("frame 3 does not come after frame 3") != std::string::npos);
  CHECK(refusal("4 0:2").find("frame 0 does not come after frame 4") != std::string::npos);
  CHECK(refusal("now").find("a file has none") != std::string::npos);
  CHECK(refusal("0", {0, std::nullopt, "-frames", "molecule 1"}) == "-frames '0': there are no frames of molecule 1");
  CHECK(refusal("99999999999999999999").find("is no frame") != std::string::npos);
  for (const char* wrong : {"1.5", "0x1", "1;2", "0:-1:2", ":"}) {
    CAPTURE(wrong);
    CHECK_FALSE(refusal(wrong).empty());
  }
}

TEST_CASE("frames: the open ends that Tcl took once are refused with the text to write") {
  CHECK(refusal("0:1:") == "-frames '0:1:': begin, step and end are all written: 0:1:end");
  CHECK(refusal(":2:5") == "-frames ':2:5': begin, step and end are all written: 0:2:5");
  CHECK(refusal("3:") == "-frames '3:': begin, step and end are all written: 3:end");
  for (const char* shown : {"0:1:end", "0:2:5", "3:end"}) CHECK_NOTHROW(frames(shown));
}

TEST_CASE("frames: in words and back") {
  CHECK(frames_in_words({0, 1, 2, 3}) == "0:1:3");
  CHECK(frames_in_words({7}) == "7");
  CHECK(frames_in_words({2, 4}) == "2,4");
  CHECK(frames_in_words({0, 1, 3}) == "0,1,3");
  for (const Frames& all : {Frames{0, 5, 9}, Frames{1, 4, 7}, Frames{0}, Frames{3, 4}})
    CHECK(frames(frames_in_words(all)) == all);
}

TEST_SUITE_END();
