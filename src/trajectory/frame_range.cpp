// frame_range.cpp: reads `begin:step:end`.
#include "trajectory/frame_range.h"

#include "base/error.h"
#include "io/text_cursor.h"

namespace espdiff {
namespace {

/// The frame that a word names; false when it is none.
bool parse_frame(const std::string& word, int n_frames, long long& frame) {
  if (word == "end" || word == "last") {
    frame = n_frames - 1;
    return true;
  }
  if (!parse_integer(word, frame)) return false;
  if (frame < 0) frame += n_frames;
  return frame >= 0 && frame < n_frames;
}

std::vector<std::string> split_at_colons(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (c == ':') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

}  // namespace

std::vector<int> parse_frames(const std::string& text, int n_frames) {
  const std::vector<std::string> words = split_at_colons(text == "all" ? "0:end" : text);
  long long begin = 0, step = 1, end = 0;
  const bool is_good = words.size() <= 3 && parse_frame(words.front(), n_frames, begin) &&
                       parse_frame(words.back(), n_frames, end) &&
                       (words.size() < 3 || (parse_integer(words[1], step) && step > 0)) && begin <= end;
  if (!is_good)
    throw InputError("frames '" + text + "' are not among the " + std::to_string(n_frames) + " that there are, 0 to " +
                     std::to_string(n_frames - 1) + "; give all, last, a frame, begin:end or begin:step:end");
  std::vector<int> frames;
  for (long long frame = begin; frame <= end; frame += step) frames.push_back(static_cast<int>(frame));
  return frames;
}

}  // namespace espdiff
