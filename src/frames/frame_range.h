// frame_range.h: parses lists of frames; one grammar for the command line, Tcl and the window.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/message.h"

namespace espdiff {

/// Context of a list of frames.
struct FrameSet {
  int n_frames = 0;
  std::optional<int> now = std::nullopt;  ///< the frame that VMD shows; none for files
  Message what = option("frames");        ///< for messages: the option, or what it is
  std::string of = "";                    ///< for messages: a file, a molecule
  std::string incomplete = "";            ///< what is missing of it; its last frame is then named by number only
};

/// Frame numbers from 0, each once, in rising order. The grammar is that of VMD's PMEPot (`-frames`) and of
/// `mol drawframes`, whose lists it takes as well:
///
///     FRAMES  =  PART, or several with commas or blanks between them
///     PART    =  all  |  FRAME  |  BEGIN:END  |  BEGIN:STEP:END      both ends are included
///     FRAME   =  a number from 0  |  -1 (the last), -2, ...  |  first  |  now  |  last  |  end
///
/// A missing end (`0:10:`, an earlier form in Tcl) is refused; the message has the text to write.
/// @throws InputError with the option, the text, the fault, and what is accepted
std::vector<int> parse_frames(const std::string& text, const FrameSet& frames);

/// The shortest text that means these frames: `7`, `0:10:90`, or a list. @param frames in rising order
std::string frames_in_words(const std::vector<int>& frames);

}  // namespace espdiff
