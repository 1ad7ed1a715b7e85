// frame_range.h: which frames of a trajectory are meant: one grammar for the command line, Tcl and the window.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/message.h"

namespace espdiff {

/// What a text about frames is about.
struct FrameSet {
  int n_frames = 0;
  std::optional<int> now = std::nullopt;  ///< the frame that VMD shows; files have none
  Message what = option("frames");        ///< for messages: the option, or what it is
  std::string of = "";                    ///< for messages: a file, a molecule
};

/// Frames by number, from 0 on, each once and in rising order. The grammar is that of VMD's PMEPot (`-frames`) and of
/// `mol drawframes`, whose lists it takes as well:
///
///     FRAMES  =  PART, or several with commas or blanks between them
///     PART    =  all  |  FRAME  |  BEGIN:END  |  BEGIN:STEP:END      both ends are included
///     FRAME   =  a number from 0  |  -1 (the last), -2, ...  |  first  |  now  |  last  |  end
///
/// An end that is left out (`0:10:`, an earlier form of Tcl) is refused with the text to write.
/// @throws InputError that names the option, the text, what is wrong with it, and what is accepted
std::vector<int> parse_frames(const std::string& text, const FrameSet& frames);

/// The shortest text that means these frames: `7`, `0:10:90`, or a list. @param frames in rising order
std::string frames_in_words(const std::vector<int>& frames);

}  // namespace espdiff
