// frame_range.cpp: reads `begin:step:end`.
#include "frames/frame_range.h"

#include "base/error.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

std::vector<std::string> split_at(const std::string& text, const std::string& separators) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (separators.find(c) == std::string::npos) {
      words.back() += c;
    } else {
      words.emplace_back();
    }
  }
  return words;
}

class FrameParser {
 public:
  FrameParser(const std::string& text, const FrameSet& frames) : text_(text), frames_(frames) {}

  std::vector<int> parse() {
    if (frames_.n_frames <= 0) refuse("there are no frames" + of());
    for (const std::string& part : split_at(text_, ", \t")) {
      if (!part.empty()) add(part);
    }
    if (found_.empty()) refuse(std::string("no frame is named; ") + kAccepted);
    return found_;
  }

 private:
  static constexpr const char* kAccepted =
      "give all, first, now, last (or end), a number from 0 (-1 is the last), begin:end or begin:step:end";

  [[noreturn]] void refuse(const std::string& reason) const {
    throw InputError(frames_.what + " '" + text_ + "': " + reason);
  }
  std::string of() const { return frames_.of.empty() ? "" : " of " + frames_.of; }

  void add(const std::string& part) {
    const std::vector<std::string> words = split_at(part == "all" ? "first:last" : part, ":");
    if (words.size() > 3) refuse("'" + part + "' has more than two colons; " + kAccepted);
    check_complete(words);
    const int begin = frame(words.front()), end = frame(words.back());
    const long long step = words.size() == 3 ? step_of(words[1]) : 1;
    if (begin > end) refuse("'" + part + "' ends before it begins");
    if (!found_.empty() && begin <= found_.back())
      refuse("frame " + std::to_string(begin) + " does not come after frame " + std::to_string(found_.back()) +
             "; frames are compared in rising order, each once");
    for (long long i = begin; i <= end; i += step) found_.push_back(static_cast<int>(i));
  }

  /// The text to write for an earlier form in Tcl: missing parts meant the first frame, step 1, the last frame.
  void check_complete(std::vector<std::string> words) const {
    if (words.size() == 1) return;
    const char* const usual[] = {"0", words.size() == 3 ? "1" : "end", "end"};
    std::string complete;
    bool is_complete = true;
    for (std::size_t i = 0; i < words.size(); ++i) {
      is_complete = is_complete && !words[i].empty();
      complete += (i == 0 ? "" : ":") + (words[i].empty() ? std::string(usual[i]) : words[i]);
    }
    if (!is_complete) refuse("begin, step and end are all written: " + complete);
  }

  long long step_of(const std::string& word) const {
    long long step = 0;
    if (!parse_integer(word, step)) refuse("the step '" + word + "' is no whole number");
    if (step < 1) refuse("the step is " + word + "; 1 or more is needed");
    return step;
  }

  int last() const {
    const std::string number = std::to_string(frames_.n_frames - 1);
    if (!frames_.incomplete.empty())
      refuse(frames_.incomplete + "; to take the whole frames, name the last one by its number, as in 0:" + number);
    return frames_.n_frames - 1;
  }

  int frame(const std::string& word) const {
    if (word == "first") return 0;
    if (word == "last" || word == "end") return last();
    if (word == "now" && frames_.now) return *frames_.now;
    if (word == "now") refuse("`now` is the frame that a molecule in VMD shows; a file has none, give a number");
    long long number = 0;
    if (!parse_integer(word, number)) refuse("'" + word + "' is no frame; " + kAccepted);
    const long long from_start = number < 0 ? number + last() + 1 : number;
    if (from_start < 0 || from_start >= frames_.n_frames)
      refuse("frame " + word + " is not among the frames 0 to " + std::to_string(frames_.n_frames - 1) + of());
    return static_cast<int>(from_start);
  }

  const std::string& text_;
  const FrameSet& frames_;
  std::vector<int> found_;
};

}  // namespace

std::vector<int> parse_frames(const std::string& text, const FrameSet& frames) {
  return FrameParser(text, frames).parse();
}

std::string frames_in_words(const std::vector<int>& frames) {
  if (frames.empty()) return {};
  const int step = frames.size() > 1 ? frames[1] - frames[0] : 1;
  bool is_even = true;
  std::string list;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    is_even = is_even && (i == 0 || frames[i] - frames[i - 1] == step);
    list += (i == 0 ? "" : ",") + std::to_string(frames[i]);
  }
  if (!is_even || frames.size() < 3) return list;
  return std::to_string(frames.front()) + ":" + std::to_string(step) + ":" + std::to_string(frames.back());
}

}  // namespace espdiff
